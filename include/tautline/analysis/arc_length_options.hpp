#pragma once

#include <optional>

namespace tautline::analysis {

/// What the length of a step along the path is measured in: motions alone (of free unknowns and of prescribed
/// ones), or motions and load.
enum class ArcConstraint { cylindrical, spherical };

/// A path followed by its length, round limit points and back.
struct ArcLengthOptions {
  ArcConstraint constraint = ArcConstraint::cylindrical;
  double first_step = 0.05;     ///< part of the load that the first step would take on a straight path [-]
  double largest_step = 20;     ///< longest step over the first [-]
  double smallest_step = 1e-4;  ///< shortest step over the first before giving up [-]
  double rotation_weight = 1;   ///< square of a rotation [rad] beside that of a motion over the size [-]
  int target_iterations = 5;    ///< steps grow while they take fewer, shrink when they take more
  int max_points = 200;
  int branch = 0;             ///< leave the path at its n-th bifurcation along the critical mode; 0: stay
  double branch_step = 0.01;  ///< largest motion in the first step on the branch over the size [-]
  int stop_at_critical = 0;   ///< the path ends at its n-th critical point; 0: it goes on
  double load_factor = 1;     ///< the path ends where lambda passes this, above or below
  double least_load_factor = -1e300;
  std::optional<double> displacement;  ///< the path ends where the watched motion passes this [m]
};

}  // namespace tautline::analysis
