#pragma once

namespace tautline::assembly {

/// Mass matrices: with the shape functions of the stiffness, or gathered at the nodes.
enum class MassKind { consistent, lumped };

}  // namespace tautline::assembly
