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

/// Loads, reactions and what constraints carry summed up: force, moment about the origin over the farthest
/// node's distance, and what rounding may leave of both, all three over `size`, the sum of the magnitudes.
/// Collective.
Json balance_json(const assembly::System& system);

/// Why a balance is none, with both sides of the inequality; empty if it is one.
std::string imbalance(const Json& balance);

}  // namespace tautline::steps
