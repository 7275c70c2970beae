#pragma once
/// @file
/// Which block of three unknowns belongs to which node, and which rank owns what.

#include <vector>

#include <tautline/la/symmetric_matrix.hpp>
#include <tautline/la/vector.hpp>
#include <tautline/model/model.hpp>

namespace tautline::assembly {

/// A node has one block for its displacement and, where a beam is attached, a second for its rotation.
struct DofMap {
  std::vector<int> displacement_block;  ///< of each node
  std::vector<int> rotation_block;      ///< of each node; -1 if it has none
  std::vector<int> node_rank;           ///< owner of each node and so of its blocks
  la::BlockLayout layout;
  la::BlockPattern pattern;
};

/// Deals the nodes out by METIS and numbers the blocks rank by rank. Collective; the same everywhere.
DofMap make_dof_map(const model::Model& model);

/// Blocks of each kind of element, in the order of its element matrix.
std::array<int, 2> blocks_of(const DofMap& map, const model::Cable& cable);
std::array<int, 4> blocks_of(const DofMap& map, const model::Beam& beam);
std::array<int, 3> blocks_of(const DofMap& map, const model::Membrane& membrane);

}  // namespace tautline::assembly
