#pragma once
/// @file
/// Result structs as JSON; the surface of a reflector.

#include <nlohmann/json.hpp>

#include <tautline/model/response.hpp>
#include <tautline/reflector/surface_error.hpp>

#include "steps/context.hpp"

namespace tautline::steps {

/// A residual as results report it: what lies below `floor`, the level of rounding, reads as `floor`, so that
/// figures do not depend on the number of ranks.
double above_rounding(double value, double floor);

/// Without the digits that are rounding, where those are more than a few.
double without_rounding(double value, double rounding);
/// A figure of which only the size matters, to three digits.
double rounded(double value);
/// A figure to `digits` digits: what an iteration or a difference leaves certain.
double to_digits(double value, int digits);
/// Value to ten digits of `size`: what lies below is rounding.
double on_grid(double value, double size);

/// @param rounding what the rounding of the stiffest elements may leave in an axial force, see
/// assembly::System::rounding_force [N]
Json groups_json(const std::map<std::string, model::GroupSummary>& groups, double rounding = 0);
/// Warns of what is not certain in it.
Json surface_json(Context& context, const reflector::SurfaceError& error);
/// Of all rods: one beam for each link, one cable between neighbours at each node.
Json umbrella_json(const rod::Umbrella& umbrella);
Json model_json(const model::Model& model, int dofs);

/// The cloth and the net nodes of a reflector in the system's present state.
reflector::SurfaceSample surface_sample(Context& context);
reflector::SurfaceError measure(Context& context);

}  // namespace tautline::steps
