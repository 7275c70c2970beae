#pragma once
/// @file
/// Least squares with inequalities, by Lawson and Hanson (1974): NNLS and least distance programming.

#include <optional>

#include <tautline/core/types.hpp>

namespace tautline::formfinding {

/// x >= 0 of the smallest |A x - b|.
VecX nonnegative_least_squares(const MatX& a, const VecX& b);

/// y of the smallest |F y - g| with G y >= h; none if no y meets that. F has full column rank.
std::optional<VecX> constrained_least_squares(const MatX& f, const VecX& g, const MatX& constraint,
                                              const VecX& h);

}  // namespace tautline::formfinding
