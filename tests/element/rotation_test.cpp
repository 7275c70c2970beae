#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <element/detail/rotation.hpp>

namespace tautline::element::detail {

namespace {

Mat3 exponential(const Vec3& theta) {
  const double angle = theta.norm();
  return angle == 0 ? Mat3(Mat3::Identity()) : Eigen::AngleAxisd(angle, theta / angle).toRotationMatrix();
}

const Vec3 axis = Vec3(2, -1, 2) / 3;
const double angles[] = {0, 1e-9, 1e-3, 0.3, 0.499, 0.501, 1.5, 3};  // 0.5: where the series ends

/// d f(rotation vector after a spin) / d spin by central differences; truncation h^2 = 1e-8, rounding 1e-12.
template <class F>
Mat3 by_spin(const Vec3& theta, const F& f) {
  const double h = 1e-4;
  Mat3 derivative;
  for (int i = 0; i < 3; ++i) {
    const Vec3 spin = h * Vec3::Unit(i);
    const Vec3 forward = f(rotation_vector(exponential(spin) * exponential(theta)));
    const Vec3 backward = f(rotation_vector(exponential(-spin) * exponential(theta)));
    derivative.col(i) = (forward - backward) / (2 * h);
  }
  return derivative;
}

}  // namespace

TEST(RotationVector, InvertsTheExponentialMap) {
  for (const double angle : angles) {
    const Vec3 theta = angle * axis;
    EXPECT_LT((rotation_vector(exponential(theta)) - theta).norm(), 1e-15 + 1e-15 * angle) << angle;
    EXPECT_LT((rotation_vector(exponential(-theta)) + theta).norm(), 1e-15 + 1e-15 * angle) << angle;
  }
}

TEST(RotationVector, KeepsTheDigitsOfSmallRotations) {
  const Vec3 theta = 1e-12 * axis;
  EXPECT_LT((rotation_vector(Mat3::Identity() + skew(theta)) - theta).norm(), 1e-15 * 1e-12);
}

TEST(RotationVector, DifferentialIsItsDerivativeBySpin) {
  for (const double angle : angles) {
    const Vec3 theta = angle * axis;
    const Mat3 difference = by_spin(theta, [](const Vec3& t) { return t; });
    EXPECT_LT((SpinToRotationVector(theta).matrix() - difference).norm(), 1e-7) << angle;
  }
}

TEST(RotationVector, SecondDifferentialIsTheDerivativeOfTheFirst) {
  const Vec3 m(0.4, 0.7, -0.3);
  for (const double angle : angles) {
    const Vec3 theta = angle * axis;
    const Mat3 difference = by_spin(
        theta, [&](const Vec3& t) -> Vec3 { return SpinToRotationVector(t).matrix().transpose() * m; });
    EXPECT_LT((SpinToRotationVector(theta).derivative_of_transpose_times(m) - difference).norm(), 1e-7)
        << angle;
  }
}

}  // namespace tautline::element::detail
