#pragma once
/// @file
/// Force densities that keep near a drawn shape. Theory: docs/theory/force_density.md, "A drawn shape in
/// balance"

#include <tautline/core/types.hpp>
#include <tautline/formfinding/net.hpp>
#include <vector>

namespace tautline::formfinding {

struct BalancedOptions {
  /// Weight of a force out of balance, over the tensions that meet at its node, beside a deviation of a
  /// tension, over what is wanted [-].
  double balance_weight = 3;
  double height_weight = 1;  ///< of balance along z beside that along x and y [-]
  int rounds = 8;            ///< each from where the last one left the nodes
  double least_part = 0.05;  ///< a branch carries at least this part of what is wanted of it [-]
};

/// @brief Force densities with which a net is in balance near where it is drawn, its tensions close to those
/// wanted.
///
/// In each round linear least squares over the branches of (T - wanted)/wanted and, with `balance_weight`,
/// over the free nodes of the force out of balance along the directions that must balance (x and y where a
/// node is bound to the surface); the linear net with what is found is where the next round begins. That of
/// the last balances exactly.
/// @param[in] wanted  tension of each branch [N], positive
/// @param[in] held    branches that keep wanted/length; empty: none
/// @return one force density for each branch, positive [N/m]
/// @throws ModelError if a wanted tension is not positive, a branch has no length, or a node is guided
VecX balancing_force_densities(const Net& net, const VecX& wanted, const std::vector<bool>& held = {},
                               const Surface* surface = nullptr, const BalancedOptions& options = {});

}  // namespace tautline::formfinding
