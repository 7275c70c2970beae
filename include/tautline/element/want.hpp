#pragma once

namespace tautline::element {

/// What a kernel is asked for; energy, force and state label come always.
enum class Want { force, tangent };

}  // namespace tautline::element
