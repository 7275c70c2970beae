#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <tautline/core/rotation.hpp>

namespace tautline {
namespace {

using std::numbers::pi;

const Vec3 axis = Vec3(2, -1, 2) / 3, moment(0.7, -1.1, 0.4), step(0.3, 0.8, -0.5);
const double angles[] = {0, 1e-4, 0.4, 0.99, 1.01, 2.5, 4, 6};  // 1: where the series end

/// By differences of h^4 truncation, 1e-12, and 1e-13 rounding.
TEST(Rotation, SpinIsTheDerivativeOfTheRotationByItsVector) {
  const double h = 1e-3;
  for (const double angle : angles) {
    const Vec3 theta = angle * axis;
    const auto at = [&](double t) {
      return rotation_vector(rotation_of(theta + t * step) * rotation_of(theta).transpose());
    };
    const Vec3 spin = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
    EXPECT_LT((spin_of_rotation_vector(theta) * step - spin).norm(), 1e-11) << angle;
  }
}

/// The second difference of the moment's work along a straight line of rotation vectors; h^4 truncation, 1e-8
/// with h = 1e-2, 1e-12 rounding.
TEST(Rotation, CurvatureIsTheSecondDerivativeInTheExponentialChart) {
  const double h = 1e-2;
  for (const double angle : angles) {
    const Vec3 theta = angle * axis;
    const auto at = [&](double t) {
      return moment.dot(rotation_vector(rotation_of(theta + t * step) * rotation_of(theta).transpose()));
    };
    const double second = (16 * (at(h) + at(-h)) - (at(2 * h) + at(-2 * h))) / (12 * h * h);
    EXPECT_NEAR(step.dot(spin_curvature(theta, moment) * step), second, 1e-8) << angle;
  }
}

TEST(Rotation, KeepsCountOfTurns) {
  for (const double angle : {0.0, 0.3, 3.0, 2 * pi, 4 * pi, 4 * pi + 1, -7.0}) {
    const Vec3 theta = angle * axis;
    const Vec3 found = nearest_rotation_vector(rotation_of(theta), theta + 0.1 * axis);
    EXPECT_LT((found - theta).norm(), 1e-14 + 1e-14 * std::abs(angle)) << angle;
  }
}

TEST(Rotation, TwistIsWhatATiltLeaves) {
  const Vec3 across = Vec3(1, 2, 0) / std::sqrt(5.0);  // normal to the axis
  for (const double twist : {-3.0, 0.0, 0.5, 2.0})
    for (const double tilt : {0.0, 1.0, 3.0})
      EXPECT_NEAR(
          std::remainder(twist_about(rotation_of(tilt * across) * rotation_of(twist * axis), axis) - twist,
                         2 * pi),
          0, 1e-13);
}

}  // namespace
}  // namespace tautline
