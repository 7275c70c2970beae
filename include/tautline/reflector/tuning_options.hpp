#pragma once
#include <limits>
#include <string>
#include <vector>

namespace tautline::reflector {

enum class TuningMethod {
  rule,        ///< Belov eq. 3.11: each tie shortened by the deviation of its front node
  sensitivity  ///< least squares with the influence matrix of the converged tangent
};

enum class TuningObjective {
  nodes,  ///< eq. 3.13, unweighted over cloth nodes inside the radius
  area    ///< area-weighted, eq. 3.1
};

struct TuningOptions {
  TuningMethod method = TuningMethod::rule;
  TuningObjective objective = TuningObjective::area;  ///< sensitivity only
  std::vector<std::string> ties{"ties"};              ///< cable groups to be tuned
  int max_passes = 12;
  double tolerance = 0.002;  ///< stop when the RMS changes by less than this part of itself [-]
  /// Sensitivity: lower bound on tie tension [N]; NaN: half of the least tie tension when the tuning begins.
  double tension_min = std::numeric_limits<double>::quiet_NaN();
  double tension_max = std::numeric_limits<double>::infinity();  ///< sensitivity: upper bound [N]
  /// Sensitivity: weight of the squares of tie-tension changes beside the surface error, relative to the mean
  /// influence of a tie on it [-]. Less reaches a smaller error by larger and less even tensions.
  double regularisation = 0.01;
  double max_change =
      std::numeric_limits<double>::infinity();  ///< largest change of an unstressed length in one pass [m]
};

}  // namespace tautline::reflector
