#pragma once
/// @file
/// The bent rod, whichever model found it.

#include <vector>

#include <tautline/rod/umbrella.hpp>

namespace tautline::rod {

inline constexpr int intervals_per_link = 32;  ///< even; of RodShape::curve

/// A point of a bent rod.
struct RodPoint {
  double s = 0;         ///< length from the root [m]
  double x = 0, y = 0;  ///< [m]
  double angle = 0;     ///< [rad]
  double moment = 0;    ///< EI dtheta/ds [N m]
};

/// A rod in equilibrium with forces R_k along -X at its nodes.
struct RodShape {
  Rod rod;               ///< with the lengths it has
  VecX x, y, angle;      ///< of nodes 1..m [m], [rad]
  VecX reaction;         ///< R_k [N]
  VecX moment;           ///< of nodes 0..m, by equilibrium of the part beyond: sum of R_i (Y_i - Y_k) [N m]
  VecX moment_of_links;  ///< of nodes 0..m: mean of EI dtheta/ds on both sides [N m]
  std::vector<RodPoint> curve;  ///< each link's end and the next one's beginning are one point
  VecX axial_force() const;     ///< N_k = R_k + ... + R_m, of each link along -X [N]
};

}  // namespace tautline::rod
