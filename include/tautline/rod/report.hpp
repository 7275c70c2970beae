#pragma once
/// @file
/// What a designer asks of a bent rod: cables, distances from the surface, warnings. Theory:
/// docs/theory/rod.md

#include <string>
#include <vector>

#include <tautline/rod/shape.hpp>

namespace tautline::rod {

/// Distances of the rod from the meridian, positive towards +Y.
struct RodError {
  double rms = 0;        ///< of the normal distance over the rod's length [m]
  double max = 0;        ///< largest normal distance, with its sign [m]
  double max_at = 0;     ///< where, by length from the root [m]
  double rms_axial = 0;  ///< of Y - F(X) over the rod's length [m]
};

struct RodReport {
  VecX strain;          ///< eps_k of the cables, eq. (3.4) [-]
  VecX stiffness;       ///< E_T F_k that gives the reactions, eq. (3.5); NaN where no cable can [N]
  VecX miss_x, miss_y;  ///< of nodes 1..m from the target's nodes [m]
  VecX node_error;      ///< Y_k - F(X_k) [m]
  RodError along;
  std::vector<std::string> warnings;
};

/// Measures a shape found by any model of this module.
RodReport make_report(const Umbrella& umbrella, const RodShape& shape);

}  // namespace tautline::rod
