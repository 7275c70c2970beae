// Supports that move: how far in a stage. Theory: docs/theory/constraints.md#prescribed-motion
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include <fmt/format.h>

#include <tautline/assembly/system.hpp>
#include <tautline/core/error.hpp>
#include <tautline/core/rotation.hpp>
#include <tautline/model/names.hpp>

namespace tautline::assembly {

namespace {

struct Target {
  Vec3 value = Vec3::Zero();
  std::string load;
};
using Targets = std::map<int, Target>;  // by node; several loads add up

/// Where the loads of a boundary want nodes to be by `motion`, a member of model::Load.
Targets targets(const model::Model& model, const Boundary& boundary,
                std::optional<Vec3> model::Load::*motion) {
  Targets result;
  for (const auto& load : boundary.loads) {
    if (!(load.*motion)) continue;
    auto nodes = model.nodes_of(load.on);  // of the mesh: whole edges move
    nodes.insert(nodes.end(), load.nodes.begin(), load.nodes.end());
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    for (const int node : nodes) {
      result[node].value += *(load.*motion);
      result[node].load = load.name;
    }
  }
  return result;
}

}  // namespace

std::set<int> System::turned_nodes(const Boundary& boundary) const {
  std::set<int> nodes;
  for (const auto& [node, target] : targets(model_, boundary, &model::Load::rotation)) nodes.insert(node);
  return nodes;
}

/// The rotation vector about one axis in space that leads from where a node is to its target: of all, with
/// full turns more or less, the one nearest to the difference of the rotation vectors.
Vec3 System::spin_to(int node, const Vec3& target) const {
  const auto at = static_cast<std::size_t>(node);
  const Vec3& now = state_.turn[at];
  return nearest_rotation_vector(rotation_of(target) * state_.rotation[at].transpose(), target - now);
}

void System::find_drives(const Boundary& boundary) {
  drives_.clear();
  const auto drive = [&](int node, int block, const Target& target, const Vec3& way) {
    const Vec3 wish = block < 0 ? target.value : kinematics_.in_axes(block, target.value);
    Drive found{block, block < 0 ? way : kinematics_.in_axes(block, way)};
    for (int c = 0; c < 3; ++c) {
      if (block >= 0 && held()[static_cast<std::size_t>(3 * block + c)]) continue;
      found.way[c] = 0;
      if (std::abs(wish[c]) > 1e-12 * target.value.norm())
        throw ModelError(fmt::format(
            "load \"{}\" moves {} in a direction that no support holds: only a support can be moved, so "
            "add that direction to a support of the node",
            target.load, model::node_in_group(model_, node)));
    }
    if (!found.way.isZero(0)) drives_.push_back(found);
  };
  for (const auto& [node, target] : targets(model_, boundary, &model::Load::displacement))
    drive(node, map_.displacement_block[node], target, target.value - state_.displacement[node]);
  for (const auto& [node, target] : targets(model_, boundary, &model::Load::rotation)) {
    const bool whole = kinematics_.held_rotations(node) == 3;
    drive(node, map_.rotation_block[node], target,
          whole ? spin_to(node, target.value) : Vec3(target.value - state_.turn[node]));
  }
}

}  // namespace tautline::assembly
