#include <fmt/format.h>

#include <cmath>
#include <tautline/core/error.hpp>
#include <tautline/reflector/paraboloid.hpp>

namespace tautline::reflector {

Paraboloid::Paraboloid(double aperture, double focal_length, double clearance, double raised)
    : aperture_(aperture), focal_length_(focal_length), offset_(clearance + aperture / 2), raised_(raised) {
  if (!(std::isfinite(aperture) && aperture > 0))
    throw ModelError(fmt::format("the aperture must be positive, not {} m", aperture));
  if (!(std::isfinite(focal_length) && focal_length > 0))
    throw ModelError(fmt::format("the focal length must be positive, not {} m", focal_length));
  if (!(std::isfinite(clearance) && offset_ >= 0))
    throw ModelError(fmt::format(
        "the clearance must be at least minus half the aperture, {} m (the axisymmetric dish), not {} m",
        -aperture / 2, clearance));
  tilt_ = std::atan2(offset_, 2 * focal_length);
  shift_ = aperture * aperture * std::sin(tilt_) / (16 * focal_length);
}

Vec3 Paraboloid::height_and_slope(double x, double y) const {
  // A z^2 + B z + C = 0 with eq. (3.8). In C the linear terms 2 X_0 cos(phi) - 4 F sin(phi) vanish by
  // tan(phi) = X_0/2F.
  const double s = std::sin(tilt_), c = std::cos(tilt_);
  const double along = (x + shift_) * c;
  const double A = s * s;
  const double B = -(4 * focal_length_ * c + 2 * s * (offset_ + along));
  const double C = y * y + along * along;
  const double discriminant = B * B - 4 * A * C;
  if (!(discriminant > 0 && B < 0))
    throw ModelError(fmt::format(
        "the line x = {:.6g} m, y = {:.6g} m along the aperture's normal misses the paraboloid", x, y));
  const double root = std::sqrt(discriminant);
  const double z = 2 * C / (root - B);
  return {z + raised_, (2 * along * c - 2 * s * c * z) / root, 2 * y / root};
}

double Paraboloid::height(double x, double y) const {
  return height_and_slope(x, y)[0];
}

Vec3 Paraboloid::axis() const {
  return {std::sin(tilt_), 0, std::cos(tilt_)};
}

Vec3 Paraboloid::to_parent(const Vec3& point) const {
  const double s = std::sin(tilt_), c = std::cos(tilt_);
  const double along = point.x() + shift_, z = point.z() - raised_;
  return {offset_ + along * c - z * s, point.y(),
          offset_ * offset_ / (4 * focal_length_) + along * s + z * c};
}

Paraboloid make_paraboloid(const DishOptions& options) {
  const double clearance = std::isnan(options.clearance) ? -options.aperture / 2 : options.clearance;
  return {options.aperture, options.focal_length, clearance, options.surface_height};
}

}  // namespace tautline::reflector
