#include <tautline/assembly/dof_map.hpp>

#include <algorithm>

#include <tautline/assembly/kinematics.hpp>
#include <tautline/la/session.hpp>
#include <tautline/mesh/partition.hpp>

namespace tautline::assembly {

namespace {

/// Nodes that move together: of elements, links, and linear constraints.
std::vector<std::vector<int>> neighbourhoods(const model::Model& model) {
  std::vector<std::vector<int>> lists;
  model::for_each_kind(model, [&](const auto& elements) {
    for (const auto& e : elements) lists.emplace_back(e.nodes.begin(), e.nodes.end());
  });
  for (const auto& link : model.links) lists.push_back({link.leader, link.follower});
  for (const auto& pair : model.cyclic_pairs) lists.push_back({pair.leader, pair.follower});
  for (const auto& constraint : model.constraints) {
    lists.emplace_back();
    for (const auto& term : constraint.terms) lists.back().push_back(term.node);
  }
  for (auto& list : lists) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return lists;
}

/// Whether a node's displacement and its rotation are unknowns of their own.
struct Freedom {
  std::vector<bool> displacement, rotation;
};

Freedom freedom(const model::Model& model, const std::vector<bool>& rotational) {
  Freedom free{std::vector<bool>(model.nodes.size(), true), rotational};
  for (const auto& link : model.links) {
    free.displacement[link.follower] = false;
    free.rotation[link.follower] = rotational[link.follower] && (link.rotation_free || !link.hinge.empty());
  }
  for (const auto& pair : model.cyclic_pairs)
    free.displacement[pair.follower] = free.rotation[pair.follower] = false;
  return free;
}

void number_blocks(const Freedom& free, DofMap& map) {
  const int n_nodes = static_cast<int>(free.displacement.size());
  map.displacement_block.assign(n_nodes, -1);
  map.rotation_block.assign(n_nodes, -1);
  int next = 0;
  for (int rank = 0; rank < la::size(); ++rank) {
    if (rank == la::rank()) map.layout.first = next;
    for (int i = 0; i < n_nodes; ++i) {
      if (map.node_rank[i] != rank) continue;
      if (free.displacement[i]) map.displacement_block[i] = next++;
      if (free.rotation[i]) map.rotation_block[i] = next++;
    }
    if (rank == la::rank()) map.layout.local = next - map.layout.first;
  }
  map.layout.total = next;
}

/// Unknown blocks of each node, from the very dependences that assembly multiplies by.
void find_unknowns(const model::Model& model, DofMap& map) {
  const Kinematics kinematics(model, map);
  const auto blocks_of = [](const std::vector<Dependence>& list) {
    std::vector<int> blocks;
    for (const auto& dependence : list) blocks.push_back(dependence.block);
    return blocks;
  };
  for (int i = 0; i < static_cast<int>(model.nodes.size()); ++i) {
    map.displacement_unknowns.push_back(blocks_of(kinematics.displacement(i)));
    map.rotation_unknowns.push_back(blocks_of(kinematics.rotation(i)));
  }
}

/// Blocks that share an element, or a dead load on a follower, with each block of the rank's range, later
/// ones only (upper triangle).
la::BlockPattern upper_pattern(const model::Model& model, const DofMap& map) {
  const int first = map.layout.first, last = first + map.layout.local;
  std::vector<std::vector<int>> columns(map.layout.local);
  const auto add = [&](const std::vector<int>& blocks) {
    for (const int row : blocks)
      if (map.owns(row))
        for (const int column : blocks)
          if (column > row) columns[row - first].push_back(column);
  };
  model::for_each_kind(model, [&](const auto& elements) {
    for (const auto& element : elements) add(unknowns_of(model, map, element));
  });
  for (const auto& link : model.links) {
    std::vector<int> blocks = map.displacement_unknowns[link.follower];
    const auto& turns = map.rotation_unknowns[link.follower];
    blocks.insert(blocks.end(), turns.begin(), turns.end());
    add(blocks);
  }
  la::BlockPattern pattern;
  for (auto& row : columns) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    const auto own = static_cast<int>(std::lower_bound(row.begin(), row.end(), last) - row.begin());
    pattern.diagonal.push_back(own + 1);
    pattern.off_diagonal.push_back(static_cast<int>(row.size()) - own);
  }
  return pattern;
}

}  // namespace

DofMap make_dof_map(const model::Model& model) {
  const int n_nodes = static_cast<int>(model.nodes.size());
  DofMap map;
  map.rotational = model.rotational_nodes();
  auto graph = mesh::node_graph(n_nodes, neighbourhoods(model));
  for (int i = 0; i < n_nodes; ++i)
    if (map.rotational[i]) graph.weight[i] *= 2;
  map.node_rank = mesh::partition(graph, la::size());
  number_blocks(freedom(model, map.rotational), map);
  find_unknowns(model, map);
  map.pattern = upper_pattern(model, map);
  return map;
}

}  // namespace tautline::assembly
