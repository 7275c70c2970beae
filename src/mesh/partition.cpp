#include <tautline/mesh/partition.hpp>

#include <algorithm>

#include <fmt/format.h>
#include <metis.h>

#include <tautline/core/error.hpp>

namespace tautline::mesh {

Graph node_graph(int n_nodes, const std::vector<std::vector<int>>& elements) {
  std::vector<std::vector<int>> neighbours(n_nodes);
  for (const auto& element : elements)
    for (const int a : element)
      for (const int b : element)
        if (a != b) neighbours[a].push_back(b);
  Graph graph;
  graph.start.push_back(0);
  for (auto& list : neighbours) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    graph.neighbour.insert(graph.neighbour.end(), list.begin(), list.end());
    graph.start.push_back(static_cast<int>(graph.neighbour.size()));
    graph.weight.push_back(1 + static_cast<int>(list.size()));
  }
  return graph;
}

std::vector<int> partition(const Graph& graph, int parts) {
  auto vertices = static_cast<idx_t>(graph.start.size()) - 1;
  std::vector<idx_t> result(static_cast<std::size_t>(vertices), 0);
  if (parts == 1 || vertices == 0) return result;
  static_assert(sizeof(idx_t) == sizeof(int), "METIS with 32-bit indices");
  idx_t constraints = 1, wanted = parts, cut = 0;
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  Graph copy = graph;
  const int code = METIS_PartGraphKway(&vertices, &constraints, copy.start.data(), copy.neighbour.data(),
                                       copy.weight.data(), nullptr, nullptr, &wanted, nullptr, nullptr,
                                       options, &cut, result.data());
  if (code != METIS_OK)
    throw LibraryError(
        fmt::format("METIS could not partition the mesh into {} parts (code {})", parts, code));
  return result;
}

}  // namespace tautline::mesh
