#include <algorithm>
#include <numeric>
#include <tautline/mesh/partition.hpp>

namespace tautline::mesh {
namespace {

/// Graph of n x n nodes in square cells.
Graph square_grid(int n) {
  std::vector<std::vector<int>> cells;
  for (int j = 0; j + 1 < n; ++j)
    for (int i = 0; i + 1 < n; ++i)
      cells.push_back({j * n + i, j * n + i + 1, (j + 1) * n + i + 1, (j + 1) * n + i});
  return node_graph(n * n, cells);
}

int edges_cut(const Graph& graph, const std::vector<int>& part) {
  int cut = 0;
  for (std::size_t i = 0; i < part.size(); ++i)
    for (int k = graph.start[i]; k < graph.start[i + 1]; ++k)
      cut += part[i] != part[graph.neighbour[k]] ? 1 : 0;
  return cut / 2;
}

TEST(NodeGraph, OfTwoTrianglesAndACableHasTheirSidesOnceAndNoLoops) {
  const Graph graph = node_graph(6, {{0, 1, 2}, {2, 1, 3}, {3, 4}});
  EXPECT_EQ(graph.start, (std::vector<int>{0, 2, 5, 8, 11, 12, 12}));
  EXPECT_EQ(graph.neighbour, (std::vector<int>{1, 2, 0, 2, 3, 0, 1, 3, 1, 2, 4, 3}));
}

TEST(NodeGraph, WeighsANodeByItsNeighbours) {
  const Graph graph = node_graph(4, {{0, 1, 2}, {2, 3}});
  EXPECT_EQ(graph.weight, (std::vector<int>{3, 3, 4, 2}));
}

TEST(Partition, GivesEveryVertexAPartAndEveryPartItsShareOfTheWork) {
  const Graph graph = square_grid(30);
  const auto part = partition(graph, 4);
  ASSERT_EQ(part.size(), 900u);
  std::vector<int> work(4, 0);
  for (std::size_t i = 0; i < part.size(); ++i) {
    ASSERT_GE(part[i], 0);
    ASSERT_LT(part[i], 4);
    work[part[i]] += graph.weight[i];
  }
  const double fair = std::accumulate(work.begin(), work.end(), 0.0) / 4;
  // METIS allows an imbalance of 3 %; a few vertices more or less come on top on so small a graph.
  for (const int share : work) EXPECT_NEAR(share, fair, 0.06 * fair);
}

TEST(Partition, CutsFewEdges) {
  const Graph graph = square_grid(30);
  // A straight cut through the middle parts 30 + 2 * 29 edges.
  EXPECT_LE(edges_cut(graph, partition(graph, 2)), 1.5 * 88);
}

TEST(Partition, IsTheSameEveryTime) {
  const Graph graph = square_grid(30);
  const auto first = partition(graph, 3);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(partition(graph, 3), first);
}

TEST(Partition, OfOnePartIsAllZero) {
  const auto part = partition(square_grid(3), 1);
  EXPECT_EQ(part, std::vector<int>(9, 0));
}

}  // namespace
}  // namespace tautline::mesh
