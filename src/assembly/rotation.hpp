#pragma once
/// @file
/// The exponential map of rotations.

#include <tautline/core/types.hpp>

namespace tautline::assembly {

/// Rotation matrix of a rotation vector [rad] (Rodrigues).
inline Mat3 rotation_of(const Vec3& vector) {
  const double angle = vector.norm();
  if (angle == 0) return Mat3::Identity();
  return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

}  // namespace tautline::assembly
