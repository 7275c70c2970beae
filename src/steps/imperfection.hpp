#pragma once
/// @file
/// Structures made a little different from what they should be.

#include <tautline/core/types.hpp>
#include <tautline/model/model.hpp>

namespace tautline::steps {

/// @brief The same structure with its nodes elsewhere before it is loaded: an imperfection free of stress.
///
/// Local axes of beams turn with their chords by the smallest rotation, normals of shells with their facets;
/// initial strains and stresses stay, so that the cables are cut for their new places.
/// @param shape displacement of each node [m]
model::Model made_imperfect(model::Model structure, const Points& shape);

}  // namespace tautline::steps
