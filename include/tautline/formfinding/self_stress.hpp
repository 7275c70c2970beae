#pragma once
/// @file
/// Self-stress states and mechanisms of a pin-jointed net in the shape drawn. Theory:
/// docs/theory/self_stress.md

#include <vector>

#include <tautline/formfinding/net.hpp>

namespace tautline::formfinding {

struct SelfStressOptions {
  /// Singular values of the equilibrium matrix below this part of the largest count as zero.
  double tolerance = 1e-6;
  int dense_limit = 400;  ///< up to so many equations or members by singular values, beyond by sparse QR
};

/// What is asked of the state that is chosen.
struct SelfStressWish {
  std::vector<bool> pulls_only;         ///< of each branch: a cable, which cannot push
  std::vector<std::vector<int>> group;  ///< branches of each group that states a tension ...
  std::vector<double> tension;          ///< ... and what it states, the mean over the group [N]
};

struct SelfStressResult {
  int states = 0;       ///< independent states of self-stress
  int mechanisms = 0;   ///< independent infinitesimal ones, without rigid motions
  int rigid = 0;        ///< rigid motions that the supports leave
  int equations = 0;    ///< free coordinates
  double smallest = 0;  ///< singular value that counts, over the largest
  double dropped = 0;   ///< largest singular value that counts as zero, over the largest
  bool found = false;   ///< whether there is a state in which cables pull
  bool scaled = true;   ///< whether a tension asked for sets the size of the state; else their mean is 1 N
  VecX tension;         ///< of each branch, of the state chosen or the nearest to one [N]
  double out_of_balance = 0;    ///< largest force on a free node in that state [N]
  std::vector<int> wrong;       ///< branches that would push, most first
  std::vector<int> unstressed;  ///< branches that carry nothing in any state
  bool stable = false;          ///< whether the state stiffens every mechanism
  double least_stiffness = 0;   ///< of a mechanism of unit length by the state's force densities [N/m]
  Points softest;               ///< of each node, that mechanism
};

/// @brief Rank-revealing decomposition of the equilibrium matrix of the net as drawn, choice of the most even
/// state of self-stress with the signs and tensions asked for, and its test on the mechanisms.
///
/// Loads and surfaces play no part.
SelfStressResult find_self_stress(const Net& net, const SelfStressWish& wish,
                                  const SelfStressOptions& options = {});

}  // namespace tautline::formfinding
