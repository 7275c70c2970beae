#pragma once
/// @file
/// What an equilibrium reports of its supports and of chosen nodes.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <tautline/assembly/system.hpp>

namespace tautline::steps {

using Json = nlohmann::ordered_json;

/// Mean displacement and rotation vector of the nodes of each name.
Json monitors_json(const assembly::System& system, const std::vector<std::string>& names);

/// Force of each support, and its moment about the mean place of its nodes. A direction of a node that two
/// supports hold counts for the first. Grounded springs are told by group. Collective.
Json reactions_json(const assembly::System& system, const assembly::Boundary& boundary,
                    const assembly::System::NodalForces& reactions);

/// Loads and reactions together, over the sum of their magnitudes: zero in equilibrium, as is what the
/// rounding of the stiffest elements leaves. Null where linear constraints or cyclic pairs carry forces of
/// their own.
Json balance_json(const assembly::System& system, const assembly::System::NodalForces& reactions);

}  // namespace tautline::steps
