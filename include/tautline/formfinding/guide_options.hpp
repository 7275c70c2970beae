#pragma once

namespace tautline::formfinding {

/// What a node slides along without friction.
enum class GuideKind { line, plane };

}  // namespace tautline::formfinding
