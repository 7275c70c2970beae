#pragma once
/// @file
/// Which block of three unknowns belongs to which node, and which rank owns what.

#include <vector>

#include <tautline/la/symmetric_matrix.hpp>
#include <tautline/la/vector.hpp>
#include <tautline/model/model.hpp>

namespace tautline::assembly {

/// A node has one block for its displacement and, where a beam or shell is attached, a second for its
/// rotation. A follower of a link has no displacement of its own; its rotation block, if its rotation is
/// free, holds that, or the angles about its hinge.
struct DofMap {
  std::vector<int> displacement_block;  ///< of each node; -1 if it follows
  std::vector<int> rotation_block;      ///< of each node; -1 if it has none
  std::vector<bool> rotational;         ///< whether the node turns, by itself or with its leader
  std::vector<int> node_rank;           ///< owner of each node and so of its blocks
  /// Unknown blocks that a node's displacement and rotation depend on.
  std::vector<std::vector<int>> displacement_unknowns, rotation_unknowns;
  la::BlockLayout layout;
  la::BlockPattern pattern;

  bool owns(int block) const { return block >= layout.first && block < layout.first + layout.local; }
};

/// Deals the nodes out by METIS and numbers the blocks rank by rank. Collective; the same everywhere.
DofMap make_dof_map(const model::Model& model);

/// Whether an element moves the rotations of its nodes.
template <class Element>
bool uses_rotations(const model::Model&, const Element&) {
  return false;
}
inline bool uses_rotations(const model::Model&, const model::Beam&) {
  return true;
}
inline bool uses_rotations(const model::Model&, const model::Shell&) {
  return true;
}
inline bool uses_rotations(const model::Model& model, const model::Spring& spring) {
  return !model.groups[spring.group].spring.rotational_stiffness.isZero(0);
}
inline bool uses_rotations(const model::Model& model, const model::MassElement& mass) {
  return !model.groups[mass.group].mass.inertia.isZero(0);
}

/// Unknown blocks that an element depends on, sorted, each once.
template <class Element>
std::vector<int> unknowns_of(const model::Model& model, const DofMap& map, const Element& element) {
  std::vector<int> blocks;
  const auto add = [&](const std::vector<int>& more) {
    blocks.insert(blocks.end(), more.begin(), more.end());
  };
  const bool rotations = uses_rotations(model, element);
  for (const int node : element.nodes) {
    add(map.displacement_unknowns[static_cast<std::size_t>(node)]);
    if (rotations) add(map.rotation_unknowns[static_cast<std::size_t>(node)]);
  }
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  return blocks;
}

}  // namespace tautline::assembly
