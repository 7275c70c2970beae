#pragma once
/// @file
/// What to change on the ties to bring the cloth nearer to the paraboloid. Theory: docs/theory/tuning.md

#include <vector>

#include <tautline/core/types.hpp>
#include <tautline/reflector/surface_error.hpp>
#include <tautline/reflector/tuning_options.hpp>

namespace tautline::reflector {

/// @brief The rule of Belov (2021), eq. 3.11: each unstressed length is reduced by the deviation of the tie's
/// front node.
/// @param[in] front_positions  current position of each tie's front node [m]
/// @return changes of unstressed length [m]
VecX rule_change(const Paraboloid& surface, const Points& front_positions);

/// First-order model of the tuned structure.
struct TieInfluence {
  std::vector<int> nodes;  ///< nodes the rows of `displacement` stand for
  MatX displacement;     ///< (3 nodes, ties): displacement for a unit change of each unstressed length [m/m]
  MatX tension;          ///< (ties, ties): tie tensions for the same [N/m]
  VecX present_tension;  ///< [N]
};

/// @brief Changes of unstressed length that minimise the surface error of the linearised structure.
///
/// The unknowns are the tie tensions, for which the bounds are a box; changes of length follow through the
/// inverse of `tension`.
/// @return changes [m], scaled down as a whole to TuningOptions::max_change
VecX sensitivity_change(const Paraboloid& surface, const SurfaceSample& sample, const TieInfluence& influence,
                        const TuningOptions& options);

/// @brief Minimises x^T H x / 2 + g^T x within lower <= x <= upper by projected Newton steps; H symmetric
/// positive definite. Source: Bertsekas (1982).
VecX minimise_in_box(const MatX& h, const VecX& g, const VecX& lower, const VecX& upper);

}  // namespace tautline::reflector
