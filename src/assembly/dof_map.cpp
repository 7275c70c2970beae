#include <tautline/assembly/dof_map.hpp>

#include <algorithm>
#include <numeric>

#include <tautline/la/session.hpp>
#include <tautline/mesh/partition.hpp>

namespace tautline::assembly {

namespace {

std::vector<std::vector<int>> element_nodes(const model::Model& model) {
  std::vector<std::vector<int>> elements;
  elements.reserve(model.cables.size() + model.beams.size() + model.membranes.size());
  for (const auto& e : model.cables) elements.emplace_back(e.nodes.begin(), e.nodes.end());
  for (const auto& e : model.beams) elements.emplace_back(e.nodes.begin(), e.nodes.end());
  for (const auto& e : model.membranes) elements.emplace_back(e.nodes.begin(), e.nodes.end());
  return elements;
}

/// Blocks that share an element with each block of `layout`'s range, later ones only (upper triangle).
la::BlockPattern upper_pattern(const model::Model& model, const DofMap& map) {
  const int first = map.layout.first, last = first + map.layout.local;
  std::vector<std::vector<int>> columns(map.layout.local);
  const auto note = [&](const auto& blocks) {
    for (const int row : blocks)
      if (row >= first && row < last)
        for (const int column : blocks)
          if (column > row) columns[row - first].push_back(column);
  };
  for (const auto& e : model.cables) note(blocks_of(map, e));
  for (const auto& e : model.beams) note(blocks_of(map, e));
  for (const auto& e : model.membranes) note(blocks_of(map, e));
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
  const auto rotational = model.rotational_nodes();
  auto graph = mesh::node_graph(n_nodes, element_nodes(model));
  for (int i = 0; i < n_nodes; ++i)
    if (rotational[i]) graph.weight[i] *= 2;
  DofMap map;
  map.node_rank = mesh::partition(graph, la::size());
  map.displacement_block.assign(n_nodes, -1);
  map.rotation_block.assign(n_nodes, -1);
  int next = 0;
  for (int rank = 0; rank < la::size(); ++rank) {
    if (rank == la::rank()) map.layout.first = next;
    for (int i = 0; i < n_nodes; ++i)
      if (map.node_rank[i] == rank) {
        map.displacement_block[i] = next++;
        if (rotational[i]) map.rotation_block[i] = next++;
      }
    if (rank == la::rank()) map.layout.local = next - map.layout.first;
  }
  map.layout.total = next;
  map.pattern = upper_pattern(model, map);
  return map;
}

std::array<int, 2> blocks_of(const DofMap& map, const model::Cable& cable) {
  return {map.displacement_block[cable.nodes[0]], map.displacement_block[cable.nodes[1]]};
}

std::array<int, 4> blocks_of(const DofMap& map, const model::Beam& beam) {
  return {map.displacement_block[beam.nodes[0]], map.rotation_block[beam.nodes[0]],
          map.displacement_block[beam.nodes[1]], map.rotation_block[beam.nodes[1]]};
}

std::array<int, 3> blocks_of(const DofMap& map, const model::Membrane& membrane) {
  return {map.displacement_block[membrane.nodes[0]], map.displacement_block[membrane.nodes[1]],
          map.displacement_block[membrane.nodes[2]]};
}

}  // namespace tautline::assembly
