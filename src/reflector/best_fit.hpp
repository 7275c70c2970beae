#pragma once
/// @file
/// The paraboloid of revolution nearest to a surface. Theory: docs/theory/surface_error.md

#include <tautline/reflector/paraboloid.hpp>
#include <vector>

namespace tautline::reflector {

struct WeightedPoint {
  Vec3 point;
  double weight;
};

struct BestFit {
  double rms = 0;           ///< weighted, along the aperture's normal [m]
  double focal_length = 0;  ///< [m]; infinite for a plane, negative for a surface that bulges
  bool converged = false;   ///< to where no motion takes away more than 1e-9 of the deviation
};

/// @brief Least squares over six rigid motions and the focal length (Levenberg and Marquardt).
///
/// Begins where the shift along the normal has taken the mean deviation away, and never gets worse.
/// Directions in which the surface slides in itself (rotation of a dish about its own axis) are left alone.
BestFit fit_paraboloid(const Paraboloid& surface, const std::vector<WeightedPoint>& points);

}  // namespace tautline::reflector
