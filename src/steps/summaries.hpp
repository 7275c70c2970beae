#pragma once
/// @file
/// Result structs as JSON; the surface of a reflector.

#include <nlohmann/json.hpp>

#include <tautline/model/response.hpp>
#include <tautline/reflector/surface_error.hpp>

#include "steps/context.hpp"

namespace tautline::steps {

/// Figures of each group, and beside them the level below which they mean nothing.
Json groups_json(const std::map<std::string, model::GroupSummary>& groups);
/// Warns of what is not certain in it.
Json surface_json(Context& context, const reflector::SurfaceError& error);
/// Of all rods: one beam for each link, one cable between neighbours at each node.
Json umbrella_json(const rod::Umbrella& umbrella);
Json model_json(const model::Model& model, int dofs);

/// The cloth and the net nodes of a reflector in the system's present state.
reflector::SurfaceSample surface_sample(Context& context);
reflector::SurfaceError measure(Context& context);

}  // namespace tautline::steps
