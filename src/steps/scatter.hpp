#pragma once
/// @file
/// Random displacements at the start of an equilibrium.

#include "steps/context.hpp"

namespace tautline::steps {

/// @brief Moves every free node of the structure by random amounts from where it is, and the mesh with it.
///
/// Nodes of beams and shells, which turn as well, stay: displaced without their rotations they would be bent
/// far beyond anything that is built. Unstressed lengths and what is wanted at the end stay as they are, so
/// that a structure with one equilibrium returns to it. The same seed gives the same places on any number of
/// ranks.
void scatter(Context& context, const ScatterOptions& options);

}  // namespace tautline::steps
