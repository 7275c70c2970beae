#pragma once
/// @file
/// What a net misses of what is asked of it, in words and in order.

#include <formfinding/constraint.hpp>
#include <tautline/formfinding/constraints.hpp>

namespace tautline::formfinding {

bool is_reaction(ConstraintKind kind);
/// "length of ridge"
std::string describe(const Constraint& constraint);

/// Sum of weight x scaled deviation^2.
double weighted_squares(const ConstraintRows& rows, const VecX& missing);

/// Fills `worst` and `misses` of the result.
/// @param[in] rows  of all constraints in their order
void list_deviations(const std::vector<Constraint>& constraints, const ConstraintRows& rows,
                     const VecX& missing, const ConstrainedOptions& options, ConstrainedResult& result);

std::optional<ShortPath> find_short_path(const ConstrainedNet& problem);

}  // namespace tautline::formfinding
