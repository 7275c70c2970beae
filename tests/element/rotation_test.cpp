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

/// c and (dc/dt)/t by their closed forms; eleven bits more than double outweigh the cancellation for t > 0.4.
struct ClosedForm {
  explicit ClosedForm(long double t) {
    const long double sine = std::sin(t / 2), cot = std::cos(t / 2) / sine;
    const long double rest = 1 - t / 2 * cot;
    c = static_cast<double>(rest / (t * t));
    c_over_t =
        static_cast<double>(((t / (4 * sine * sine) - cot / 2) / (t * t) - 2 * rest / (t * t * t)) / t);
  }
  double c, c_over_t;
};

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

// Where the series ends its last terms weigh most; what they leave in double precision are a few roundings
// of 1.
TEST(RotationVector, SeriesAndFormulaOfTheDifferentialsAreTheClosedForm) {
  const Vec3 m(0.4, 0.7, -0.3);
  for (const double angle : {0.45, 0.4999, 0.5001, 0.6}) {
    const Vec3 theta = angle * axis;
    const ClosedForm exact(angle);
    const Mat3 matrix = Mat3::Identity() - skew(theta) / 2 + exact.c * skew(theta) * skew(theta);
    EXPECT_LT((SpinToRotationVector(theta).matrix() - matrix).norm(), 2e-15) << angle;
    // of theta x (theta x m) by theta: (theta.m) I + theta m^T - 2 m theta^T, its size changes with c
    const Vec3 twice = theta.cross(theta.cross(m));
    const Mat3 by_theta =
        -skew(m) / 2 + exact.c_over_t * twice * theta.transpose() +
        exact.c * (theta.dot(m) * Mat3::Identity() + theta * m.transpose() - 2 * m * theta.transpose());
    EXPECT_LT((SpinToRotationVector(theta).derivative_of_transpose_times(m) - by_theta * matrix).norm(),
              2e-15)
        << angle;
  }
}

}  // namespace tautline::element::detail
