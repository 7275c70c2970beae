#include <tautline/rod/elastica.hpp>

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <tautline/core/error.hpp>

namespace tautline::rod {

namespace {

/// Jacobi's sn(u, k) by descending to arithmetic-geometric means (Abramowitz & Stegun, 16.4).
double jacobi_sn(double u, double k) {
  double a[12], c[12], b = std::sqrt((1 - k) * (1 + k));
  a[0] = 1;
  c[0] = k;
  int n = 0;
  while (n < 11 && std::abs(c[n]) > 1e-16) {
    a[n + 1] = (a[n] + b) / 2;
    c[n + 1] = (a[n] - b) / 2;
    b = std::sqrt(a[n] * b);
    ++n;
  }
  double phase = std::ldexp(a[n] * u, n);
  for (; n > 0; --n) phase = (phase + std::asin(c[n] / a[n] * std::sin(phase))) / 2;
  return std::sin(phase);
}

/// k with K(k) = quarter_period, by bisection.
double modulus_of(double quarter_period) {
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (std::comp_ellint_1(middle) < quarter_period ? low : high) = middle;
  }
  return low;
}

}  // namespace

Elastica::Elastica(double nu, int mode) : root_nu_(std::sqrt(nu)) {
  const double critical = std::pow((2 * mode - 1) * std::numbers::pi / 2, 2);
  if (mode < 1 || !(nu > critical))
    throw ModelError(fmt::format("an elastica of mode {} needs nu > {:.6g}, not {:.6g}", mode, critical, nu));
  modulus_ = modulus_of(root_nu_ / (2 * mode - 1));
}

double Elastica::angle(double s) const {
  return 2 * std::asin(modulus_ * jacobi_sn(root_nu_ * s, modulus_));
}

// E((2 mode - 1) K) = (2 mode - 1) E(k), and (2 mode - 1) = sqrt(nu) / K.
double Elastica::end_x() const {
  return 2 * std::comp_ellint_2(modulus_) / std::comp_ellint_1(modulus_) - 1;
}

double Elastica::end_y() const {
  return 2 * modulus_ / root_nu_;
}

}  // namespace tautline::rod
