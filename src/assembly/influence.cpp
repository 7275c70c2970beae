#include <tautline/assembly/influence.hpp>

#include <algorithm>

#include <tautline/core/error.hpp>
#include <tautline/element/cable.hpp>
#include <tautline/la/session.hpp>
#include <tautline/model/element_data.hpp>

namespace tautline::assembly {

namespace {

constexpr int block_of_columns = 64;  // right-hand sides solved at once

/// This rank's rows of -df/dL0 for cables[begin, end).
MatX right_hand_sides(const System& system, const std::vector<int>& cables, int begin, int end) {
  const auto& layout = system.layout();
  MatX b = MatX::Zero(3 * layout.local, end - begin);
  for (int k = begin; k < end; ++k) {
    const auto& cable = system.model().cables[cables[k]];
    const auto data = model::cable_data(system.model(), cable);
    const Vec<6> derivative = element::cable_force_by_unstressed_length(data.properties, data.x_ref,
                                                                        gather(system.state(), cable.nodes));
    const auto blocks = blocks_of(system.dof_map(), cable);
    for (int i = 0; i < 6; ++i) {
      const int unknown = 3 * blocks[i / 3] + i % 3, row = unknown - 3 * layout.first;
      if (row >= 0 && row < b.rows() && !system.held()[unknown]) b(row, k - begin) = -derivative[i];
    }
  }
  return b;
}

}  // namespace

MatX length_influence(System& system, analysis::Workspace& workspace, const std::vector<int>& cables,
                      const std::vector<int>& nodes) {
  system.tangent(workspace.tangent);
  if (!workspace.solver.factor(workspace.tangent)) throw LibraryError(workspace.solver.failure());
  const auto& layout = system.layout();
  const int n = static_cast<int>(cables.size());
  std::vector<double> all(3 * nodes.size() * cables.size(), 0.0);
  Eigen::Map<MatX> influence(all.data(), static_cast<Eigen::Index>(3 * nodes.size()), n);
  for (int begin = 0; begin < n; begin += block_of_columns) {
    const int end = std::min(n, begin + block_of_columns);
    const MatX x = workspace.solver.solve_many(right_hand_sides(system, cables, begin, end));
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const int row = 3 * (system.dof_map().displacement_block[nodes[i]] - layout.first);
      if (row < 0 || row >= x.rows()) continue;
      influence.block(static_cast<Eigen::Index>(3 * i), begin, 3, end - begin) = x.middleRows(row, 3);
    }
  }
  la::sum_over_ranks(all);
  return influence;
}

}  // namespace tautline::assembly
