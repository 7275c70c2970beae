#pragma once
/// @file
/// Bilinear shape functions on the square (xi, eta) in [-1, 1]^2, nodes counter-clockwise from (-1, -1).

#include <array>

#include <tautline/core/types.hpp>

namespace tautline::element::detail {

inline Vec<4> bilinear(double xi, double eta) {
  return Vec<4>((1 - xi) * (1 - eta), (1 + xi) * (1 - eta), (1 + xi) * (1 + eta), (1 - xi) * (1 + eta)) / 4;
}

/// Rows: derivatives by xi and eta.
inline Mat<2, 4> bilinear_derivatives(double xi, double eta) {
  Mat<2, 4> d;
  d << -(1 - eta), 1 - eta, 1 + eta, -(1 + eta), -(1 - xi), -(1 + xi), 1 + xi, 1 - xi;
  return d / 4;
}

constexpr double gauss_abscissa = 0.57735026918962576451;  ///< 1 / sqrt(3)

/// The 2 x 2 Gauss points; each has the weight 1.
constexpr std::array<std::array<double, 2>, 4> gauss_points{{{-gauss_abscissa, -gauss_abscissa},
                                                             {gauss_abscissa, -gauss_abscissa},
                                                             {gauss_abscissa, gauss_abscissa},
                                                             {-gauss_abscissa, gauss_abscissa}}};

}  // namespace tautline::element::detail
