#pragma once
/// @file
/// Random displacements at the start of an equilibrium.

#include "steps/context.hpp"

namespace tautline::steps {

/// @brief Moves every free node of the structure by random amounts from where it is, and the mesh with it,
/// and starts every cable with another initial strain.
///
/// Rotations stay, so that beams whose nodes are displaced are bent and stretched far beyond anything that is
/// built. What is wanted at the end stays as it is: the initial strains are those of the deck again at the
/// end of the first stage, so that a structure with one equilibrium returns to it. The same seed gives the
/// same start on any number of ranks.
void scatter(Context& context, const ScatterOptions& options);

}  // namespace tautline::steps
