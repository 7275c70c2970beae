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
  double focal_length = 0;  ///< [m]
};

/// @brief Least squares over six rigid motions and the focal length (Gauss-Newton).
///
/// Directions in which the surface slides in itself (rotation of a dish about its own axis) are left alone.
BestFit fit_paraboloid(const Paraboloid& surface, const std::vector<WeightedPoint>& points);

}  // namespace tautline::reflector
