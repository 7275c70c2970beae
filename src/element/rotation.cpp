#include "detail/rotation.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <tuple>
#include <utility>

namespace tautline::element::detail {

namespace {

/// c(t) = (1 - (t/2) cot(t/2)) / t^2 and (dc/dt)/t, with x = t^2.
std::pair<double, double> spin_coefficients(double x) {
  if (x < 0.25) {  // Bernoulli series; the dropped terms are below 3e-16 of c and 4e-13 of its derivative
    const double c =
        1. / 12 +
        x * (1. / 720 +
             x * (1. / 30240 +
                  x * (1. / 1209600 + x * (1. / 47900160 + x * (691. / 1307674368000. + x / 74724249600.)))));
    const double c_over_t =
        2 * (1. / 720 +
             x * (2. / 30240 + x * (3. / 1209600 + x * (4. / 47900160 + x * (5 * 691. / 1307674368000. +
                                                                             x * 6 / 74724249600.)))));
    return {c, c_over_t};
  }
  const double t = std::sqrt(x);
  const double s = std::sin(t / 2);
  const double c = (1 - t / 2 * std::cos(t / 2) / s) / x;
  return {c, (t * (t + std::sin(t)) - 8 * s * s) / (4 * x * x * s * s)};
}

}  // namespace

SpinToRotationVector::SpinToRotationVector(const Vec3& theta) : theta_(theta) {
  const double x = theta.squaredNorm();
  std::tie(c_, c_over_t_) = spin_coefficients(x);
  matrix_ = (1 - c_ * x) * Mat3::Identity() - skew(theta) / 2 + c_ * theta * theta.transpose();
}

Mat3 SpinToRotationVector::derivative_of_transpose_times(const Vec3& m) const {
  // matrix()^T m = m + theta x m / 2 + c theta x (theta x m), and theta x (theta x m) = theta (theta.m) - x m
  const Vec3 twice = theta_ * theta_.dot(m) - theta_.squaredNorm() * m;
  const Mat3 by_theta =
      -skew(m) / 2 + c_over_t_ * twice * theta_.transpose() +
      c_ * (theta_.dot(m) * Mat3::Identity() + theta_ * m.transpose() - 2 * m * theta_.transpose());
  return by_theta * matrix_;
}

}  // namespace tautline::element::detail
