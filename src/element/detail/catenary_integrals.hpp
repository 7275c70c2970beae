#pragma once
/// @file
/// Integrals along a cable under its own weight, in the plane of chord and weight. Theory:
/// docs/theory/catenary.md#integrals

#include <tautline/core/types.hpp>

namespace tautline::element::detail {

/// @brief Weight of a cable in the axes of its plane: n along the chord, p across, so that the weight has no
/// negative part along p.
struct PlaneWeight {
  double size;  ///< |w|, per unstressed length [N/m]
  Vec<2> part;  ///< along n and p [N/m]
};

/// @brief Integrals over a piece of cable of given unstressed length, along which the tension vector is
/// t = F - w sigma; sigma from the middle of the piece, T = |t|.
struct CatenaryIntegrals {
  double inverse;         ///< of 1/T [m/N]
  double inverse_moment;  ///< of sigma/T [m^2/N]
  double excess;          ///< of T - t_n [N m]
  Vec<2> deficit;         ///< of n - t/T [m]
  Mat<2> flexibility;     ///< of (1 - t t^T/T^2)/T: change of the direction by F [m/N]
};

/// @brief The integrals, each with the digits of its own size, not of its parts.
///
/// @param[in] force  F, tension vector in the middle of the piece, along n and p [N]; not zero together with
/// the weight
CatenaryIntegrals catenary_integrals(const PlaneWeight& weight, const Vec<2>& force, double length);

}  // namespace tautline::element::detail
