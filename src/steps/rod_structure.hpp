#pragma once
/// @file
/// The umbrella of rods as a structure of beams and cables in space, for the steps that solve by finite
/// elements. Theory: docs/theory/rod.md

#include <tautline/model/response.hpp>
#include <tautline/rod/rod_options.hpp>
#include <tautline/rod/umbrella.hpp>

#include "steps/context.hpp"

namespace tautline::steps {

/// @brief All rods straight at the angle beta_0, the cables between them just taut.
///
/// Groups `link_1`..`link_m` of beams and `parallel_1`..`parallel_m` of cables; selections `roots`, `tips`,
/// `rod_0`..; the load `turn` takes the roots to the stop. The axis of the umbrella is z, rod 0 is above x.
/// Nodes of the structure as described go rod by rod, root to tip.
/// @param lengths of the links [m]
/// @param stiffness E_T F of the cables of each parallel [N]; those of zero are left out
/// @throws ModelError for a cable that cannot be built, and for a law of the cables that is not linear
model::Model make_rod_structure(const rod::Umbrella& umbrella, const rod::UmbrellaOptions& options,
                                const VecX& lengths, const VecX& stiffness);

/// The rods as they stand: the mean over all of X, Y, theta of the nodes, reactions, strains and stiffnesses
/// of the cables, moments; how unequal the rods are; distances from the meridian along all of them.
Json rods_json(Context& context, const model::Response& response);

}  // namespace tautline::steps
