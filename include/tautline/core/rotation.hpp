#pragma once
/// @file
/// Rotations: matrices, rotation vectors, spins. Spins are spatial: R -> exp(skew(w)) R. Theory:
/// docs/theory/conventions.md

#include <tautline/core/types.hpp>

namespace tautline {

inline Mat3 skew(const Vec3& v) {
  Mat3 matrix;
  matrix << 0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0;
  return matrix;
}

/// Rotation matrix of a rotation vector [rad] (Rodrigues).
Mat3 rotation_of(const Vec3& vector);

/// Rotation vector of an orthogonal matrix, |theta| <= pi; small rotations keep their digits.
Vec3 rotation_vector(const Mat3& rotation);

/// Of all vectors (|theta| + 2 pi k) theta / |theta| of a rotation the one nearest to `near`; about the
/// direction of `near` where the rotation is none.
Vec3 nearest_rotation_vector(const Mat3& rotation, const Vec3& near);

/// Angle by which a rotation turns about a unit axis when what is left turns about an axis normal to it:
/// R = exp(tilt) exp(twist axis), tilt normal to axis. In [-2 pi, 2 pi]; undefined for tilts of pi.
double twist_about(const Mat3& rotation, const Vec3& axis);

/// Spin of a change of the rotation vector: w = T(theta) d theta.
/// Equation: T = I + (1 - cos t)/t^2 skew(theta) + (t - sin t)/t^3 skew(theta)^2, t = |theta|.
Mat3 spin_of_rotation_vector(const Vec3& theta);

/// Symmetric part of the derivative of T(theta)^T m with respect to theta, at fixed m: the second derivative
/// of a rotation in the exponential chart, contracted with a moment.
Mat3 spin_curvature(const Vec3& theta, const Vec3& m);

}  // namespace tautline
