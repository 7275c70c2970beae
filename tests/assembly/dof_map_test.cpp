#include <algorithm>
#include <numeric>
#include <tautline/assembly/dof_map.hpp>
#include <tautline/la/session.hpp>

#include "model/models.hpp"

namespace tautline::assembly {
namespace {

using model::testing_models::two_facets;

TEST(DofMap, GivesEveryNodeADisplacementBlockAndBeamNodesARotationBlock) {
  const auto model = two_facets();
  const auto map = make_dof_map(model);
  std::vector<int> blocks = map.displacement_block;
  const auto rotational = model.rotational_nodes();
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    EXPECT_EQ(map.rotation_block[i] >= 0, rotational[i]) << "node " << i;
    if (rotational[i]) blocks.push_back(map.rotation_block[i]);
  }
  std::sort(blocks.begin(), blocks.end());
  std::vector<int> each(9);
  std::iota(each.begin(), each.end(), 0);
  EXPECT_EQ(blocks, each) << "five for displacements and four for rotations, each once";
  EXPECT_EQ(map.layout.total, 9);
}

TEST(DofMap, KeepsTheBlocksOfANodeOnItsRankInOneRange) {
  const auto map = make_dof_map(two_facets());
  EXPECT_EQ(la::sum_over_ranks(map.layout.local), map.layout.total);
  for (std::size_t i = 0; i < map.node_rank.size(); ++i) {
    const auto mine = [&](int block) {
      return block >= map.layout.first && block < map.layout.first + map.layout.local;
    };
    EXPECT_EQ(mine(map.displacement_block[i]), map.node_rank[i] == la::rank());
    if (map.rotation_block[i] < 0) continue;
    EXPECT_EQ(mine(map.rotation_block[i]), map.node_rank[i] == la::rank());
  }
}

TEST(DofMap, CountsTheBlocksOfTheUpperTriangle) {
  const auto map = make_dof_map(two_facets());
  double blocks = 0;
  for (const int count : map.pattern.diagonal) blocks += count;
  for (const int count : map.pattern.off_diagonal) blocks += count;
  // 9 on the diagonal; 5 sides of the cloth, one of them also the ridge and one a strut; the tie; for each of
  // the two beams its 6 pairs of blocks, of which the strut's displacement pair is a side already: 9 + 5 + 1
  // + 6 + 6 - 1.
  EXPECT_EQ(la::sum_over_ranks(blocks), 26);
}

}  // namespace
}  // namespace tautline::assembly
