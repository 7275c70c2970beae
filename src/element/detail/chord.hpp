#pragma once
/// @file
/// The straight line between the two ends of an element, before and after displacement.

#include <tautline/core/types.hpp>

namespace tautline::element::detail {

struct Chord {
  double length_ref = 0;  ///< l0 [m]
  double length = 0;      ///< l [m]
  double elongation = 0;  ///< l - l0, without cancellation [m]
  Vec3 direction;         ///< unit vector from the first to the second end in the current configuration
};

/// @brief Chord of two displaced ends.
///
/// The elongation is formed from the difference of displacements, l - l0 = (2 d0.du + du.du) / (l + l0), so
/// that its error is relative to the displacements and not to the length.
inline Chord chord(const Mat<3, 2>& x_ref, const Vec3& u1, const Vec3& u2) {
  const Vec3 d0 = x_ref.col(1) - x_ref.col(0);
  const Vec3 du = u2 - u1;
  const Vec3 d = d0 + du;
  const double l0 = d0.norm();
  const double l = d.norm();
  return {l0, l, (2 * d0.dot(du) + du.squaredNorm()) / (l + l0), d / l};
}

}  // namespace tautline::element::detail
