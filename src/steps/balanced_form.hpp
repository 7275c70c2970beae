#pragma once
/// @file
/// Method `balanced` of form-finding: from the groups of a deck to force densities.

#include <tautline/formfinding/balanced.hpp>

#include "steps/form_net.hpp"

namespace tautline::steps {

/// @brief Force densities that balance the net near where its nodes are, tensions close to those of the
/// groups.
///
/// A group that states a force density keeps it; any other initial state counts as the tension wished for.
/// @return [N/m]
VecX balancing(const Context& context, const FormNet& form, const formfinding::BalancedOptions& options = {});

}  // namespace tautline::steps
