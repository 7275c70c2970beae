#pragma once
/// @file
/// Dealing the nodes of a graph out to ranks with few edges cut (METIS).

#include <vector>

namespace tautline::mesh {

/// Compressed adjacency: neighbours of vertex i are neighbour[start[i]] ... neighbour[start[i + 1] - 1];
/// symmetric, no loops.
struct Graph {
  std::vector<int> start, neighbour;
  std::vector<int> weight;  ///< work of each vertex
};

/// Graph of nodes that share an element; `elements` lists each element's nodes.
Graph node_graph(int n_nodes, const std::vector<std::vector<int>>& elements);

/// Part (0 ... parts - 1) of each vertex. Deterministic. @throws LibraryError if METIS fails
std::vector<int> partition(const Graph& graph, int parts);

}  // namespace tautline::mesh
