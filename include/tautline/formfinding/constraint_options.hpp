#pragma once

namespace tautline::formfinding {

/// What may be asked of branches and supports (Belov 2021, eqs 2.62-2.72).
enum class ConstraintKind {
  tension,            ///< q L [N] (2.62)
  length,             ///< stressed length L [m] (2.65)
  unstressed_length,  ///< L0 = L EA / (EA + q L) [m] (2.67)
  force_density,      ///< q [N/m]
  equal_tension,      ///< the members carry one tension, whatever it is
  reaction_x,         ///< force of the support on the net [N] (2.69); for a node on the surface: of the tie
  reaction_y,
  reaction_z
};

}  // namespace tautline::formfinding
