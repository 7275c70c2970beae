#pragma once

#include <tautline/formfinding/force_density_options.hpp>

namespace tautline::formfinding {

/// How the step of smallest norm is found.
enum class StepSolver {
  automatic,       ///< position_newton where it applies to a large net, dense up to 300 rows, else lsqr
  dense,           ///< complete orthogonal decomposition: the reference, n^3
  lsqr,            ///< products with the sparse factors only
  position_newton  ///< positions are the unknowns, q = T/L; every branch needs a tension or is held
};

struct ConstrainedOptions {
  SurfaceJacobian jacobian = SurfaceJacobian::consistent;
  StepSolver step_solver = StepSolver::automatic;
  double initial_force_density = 10.0;  ///< of branches without one of their own [N/m], positive
  double tolerance = 1e-10;             ///< largest scaled residual [-]
  int max_iterations = 100;
  bool estimate_condition = false;  ///< rank and condition from the dense matrix: up to 2000 rows
  int n_worst = 20;                 ///< rows listed when the constraints are not met
};

}  // namespace tautline::formfinding
