#pragma once

namespace tautline::formfinding {

/// Which derivative of z the constraint's Jacobian uses when nodes are bound to a surface.
enum class SurfaceJacobian {
  consistent,   ///< slope of the surface: quadratic
  as_published  ///< vertical equilibrium, Belov eqs 2.61, 2.64: linear
};

struct ForceDensityOptions {
  SurfaceJacobian jacobian = SurfaceJacobian::consistent;
  double initial_force_density = 10.0;  ///< q0 of every branch [N/m], positive
  double tolerance = 1e-10;             ///< max |T - T_target| relative to the largest target tension [-]
  int max_iterations = 50;
  bool estimate_condition = false;  ///< condition number of G^T G, dense: up to 2000 prescribed tensions
};

}  // namespace tautline::formfinding
