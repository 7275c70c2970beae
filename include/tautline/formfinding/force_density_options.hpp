#pragma once

namespace tautline::formfinding {

/// Which derivative of z the constraint's Jacobian uses when nodes are bound to a surface.
enum class SurfaceJacobian {
  consistent,   ///< slope of the surface: quadratic
  as_published  ///< vertical equilibrium, Belov eqs 2.61, 2.64: linear
};

/// How prescribed tensions are found.
enum class TensionMethod {
  automatic,  ///< position_newton where all branches have a target, in space or on a surface from 2000
              ///< branches on; else step_of_smallest_norm
  step_of_smallest_norm,  ///< Newton on the force densities, as published
  position_newton,        ///< Newton on the positions with q = T/L eliminated
  fixed_point  ///< q <- T/L, accelerated: shortest nets, also where nodes may slide along their cables
};

struct ForceDensityOptions {
  SurfaceJacobian jacobian = SurfaceJacobian::consistent;
  double initial_force_density = 10.0;  ///< q0 of every branch [N/m], positive
  double tolerance = 1e-10;             ///< max |T - T_target| relative to the largest target tension [-]
  int max_iterations = 50;
  bool estimate_condition = false;  ///< condition number of G^T G, dense: up to 2000 prescribed tensions
  TensionMethod method = TensionMethod::automatic;
};

}  // namespace tautline::formfinding
