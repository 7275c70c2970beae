#pragma once
/// @file
/// Differentials of rotation vectors. Spins are spatial: R -> exp(skew(w)) R. Theory:
/// docs/theory/beam.md

#include <tautline/core/rotation.hpp>

namespace tautline::element::detail {

using tautline::rotation_vector;
using tautline::skew;

/// @brief Differential of the rotation vector with respect to the spin, d theta = T^-1(theta) w.
///
/// T^-1 = I - skew(theta) / 2 + c skew(theta)^2. Range: |theta| < 2 pi.
class SpinToRotationVector {
 public:
  explicit SpinToRotationVector(const Vec3& theta);

  Mat3 matrix() const { return matrix_; }

  /// Derivative of matrix()^T m with respect to the spin, at fixed m.
  Mat3 derivative_of_transpose_times(const Vec3& m) const;

 private:
  Vec3 theta_;
  double c_;         ///< (1 - (t/2) cot(t/2)) / t^2 with t = |theta|
  double c_over_t_;  ///< (dc/dt) / t
  Mat3 matrix_;
};

}  // namespace tautline::element::detail
