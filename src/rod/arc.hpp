#pragma once
/// @file
/// A piece of an inextensible rod with a constant axial force.

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>

namespace tautline::rod {

/// Where a piece ends, from its beginning at the origin.
template <class T>
struct Arc {
  T x = 0, y = 0;      ///< [m]
  T angle, curvature;  ///< theta [rad], theta' [1/m]
};

/// One step by the Taylor series of theta' = kappa, kappa' = -mu sin theta, x' = cos theta, y' = sin theta;
/// coefficients of sine and cosine by recurrence, times powers of h.
template <class T>
Arc<T> taylor_step(const Arc<T>& from, const T& mu, const T& h) {
  using std::cos, std::sin;
  constexpr int order = 18;
  std::array<T, order + 1> angle, curvature, sine, cosine;
  angle[0] = from.angle;
  curvature[0] = from.curvature;
  sine[0] = sin(from.angle);
  cosine[0] = cos(from.angle);
  Arc<T> to{from.x, from.y, angle[0], curvature[0]};
  for (int j = 1; j <= order; ++j) {
    const T part = h / static_cast<double>(j);
    angle[j] = curvature[j - 1] * part;
    curvature[j] = -mu * sine[j - 1] * part;
    to.angle += angle[j];
    to.curvature += curvature[j];
    to.x += cosine[j - 1] * part;
    to.y += sine[j - 1] * part;
    sine[j] = cosine[j] = 0;
    for (int i = 1; i <= j; ++i) {
      const T rate = angle[i] * (static_cast<double>(i) / j);
      sine[j] += rate * cosine[j - i];
      cosine[j] -= rate * sine[j - i];
    }
  }
  return to;
}

/// The rod from its angle and curvature over a length, with mu = N / EI [1/m2]. Exact to rounding: a step is
/// a quarter of the shortest length in which the motion may change. No number where that is too short for a
/// rod that has not been wound up many times.
template <class T>
Arc<T> propagate(const T& angle, const T& curvature, const T& mu, const T& length) {
  constexpr double most_steps = 1000;
  const double root_mu = std::sqrt(std::abs(mu));
  const double rate =
      std::hypot(std::abs(curvature), 2 * root_mu) + root_mu;  // largest curvature, and sqrt mu
  const double steps = std::max(1.0, std::ceil(4 * rate * std::abs(length)));
  Arc<T> arc{T(0), T(0), angle, curvature};
  if (!(steps <= most_steps)) arc.x = std::numeric_limits<double>::quiet_NaN();
  for (double i = 0; i < steps && steps <= most_steps; ++i) arc = taylor_step<T>(arc, mu, length / steps);
  return arc;
}

}  // namespace tautline::rod
