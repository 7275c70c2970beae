#pragma once
/// @file
/// Pictures of the system's present state.

#include <tautline/model/response.hpp>

#include "steps/context.hpp"

namespace tautline::steps {

/// All cables coloured by tension; of a reflector the front net, too.
void draw_tensions(Context& context, const model::Response& response);

/// Deviation of the cloth, tensions of the nets; without a surface the displacements.
void draw_state(Context& context, const model::Response& response);

/// Facets of membranes or shells as triangles of a layer.
template <class Facets>
void add_triangles(const Facets& facets, output::ViewLayer& layer) {
  for (const auto& facet : facets)
    for (const auto& triangle : facet.nodes.triangles()) layer.triangles.push_back(triangle);
}

}  // namespace tautline::steps
