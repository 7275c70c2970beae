#pragma once

namespace tautline::analysis {

/// Newton's method and the driver of stages.
struct NewtonOptions {
  double force_tolerance = 1e-9;  ///< residual force over reference force [-]
  double increment_tolerance =
      1e-6;  ///< displacement increment over structure size, looked at together with the force [-]
  int max_iterations = 40;  ///< in one load step
  double min_step = 1e-3;   ///< smallest step in lambda before giving up [-]
  int increments = 1;       ///< the path stops at lambda = 1/n, 2/n, ... at least
};

}  // namespace tautline::analysis
