#include <tautline/core/rotation.hpp>

#include <cmath>
#include <numbers>

namespace tautline {

namespace {

using std::numbers::pi;

/// a = (1 - cos t)/t^2, b = (t - sin t)/t^3 and their derivatives by t over t, with x = t^2.
struct SpinCoefficients {
  double a = 0, b = 0, a_over_t = 0, b_over_t = 0;
};

SpinCoefficients spin_coefficients(double x) {
  SpinCoefficients c;
  if (x < 1) {  // a = sum (-x)^k/(2k+2)!, b = sum (-x)^k/(2k+3)!; the dropped terms are below 1e-17
    double power = 1, derivative = 0, factorial = 2;
    for (int k = 0; k < 9; ++k) {
      c.a += power / factorial;
      c.b += power / (factorial * (2 * k + 3));
      c.a_over_t += 2 * derivative / factorial;
      c.b_over_t += 2 * derivative / (factorial * (2 * k + 3));
      derivative = -(k + 1) * power;
      power *= -x;
      factorial *= (2 * k + 3) * (2 * k + 4);
    }
    return c;
  }
  const double t = std::sqrt(x);
  c.a = (1 - std::cos(t)) / x;
  c.b = (t - std::sin(t)) / (x * t);
  c.a_over_t = (std::sin(t) / t - 2 * c.a) / x;
  c.b_over_t = (c.a - 3 * c.b) / x;
  return c;
}

}  // namespace

Mat3 rotation_of(const Vec3& vector) {
  const double angle = vector.norm();
  if (angle == 0) return Mat3::Identity();
  return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

Vec3 rotation_vector(const Mat3& rotation) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(rotation).normalized();
  const double s = q.vec().norm();
  const double w = std::abs(q.w());
  const double sign = q.w() < 0 ? -1 : 1;
  const double ratio = s < 1e-12 ? 2 : 2 * std::atan2(s, w) / s;
  return sign * ratio * q.vec();
}

Vec3 nearest_rotation_vector(const Mat3& rotation, const Vec3& near) {
  constexpr double none = 1e-9;
  const Vec3 theta = rotation_vector(rotation);
  const double angle = theta.norm();
  if (angle <= none) {
    const double distance = near.norm();
    const double turns = std::round(distance / (2 * pi));
    return turns == 0 ? theta : Vec3(2 * pi * turns / distance * near + theta);
  }
  const Vec3 axis = theta / angle;
  return (angle + 2 * pi * std::round((near.dot(axis) - angle) / (2 * pi))) * axis;
}

double twist_about(const Mat3& rotation, const Vec3& axis) {
  const Eigen::Quaterniond q(rotation);
  return 2 * std::atan2(q.vec().dot(axis), q.w());
}

Mat3 spin_of_rotation_vector(const Vec3& theta) {
  const auto c = spin_coefficients(theta.squaredNorm());
  const Mat3 cross = skew(theta);
  return Mat3::Identity() + c.a * cross + c.b * cross * cross;
}

Mat3 spin_curvature(const Vec3& theta, const Vec3& m) {
  // T^T m = m - a theta x m + b (theta (theta.m) - t^2 m)
  const auto c = spin_coefficients(theta.squaredNorm());
  const Vec3 once = theta.cross(m), twice = theta * theta.dot(m) - theta.squaredNorm() * m;
  const Mat3 by_theta =
      (c.b_over_t * twice - c.a_over_t * once) * theta.transpose() +
      c.b * (theta.dot(m) * Mat3::Identity() + theta * m.transpose() - 2 * m * theta.transpose());
  return (by_theta + by_theta.transpose()) / 2;
}

}  // namespace tautline
