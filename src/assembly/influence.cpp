#include <tautline/assembly/influence.hpp>

#include <algorithm>

#include <tautline/core/error.hpp>
#include <tautline/element/cable.hpp>
#include <tautline/la/session.hpp>
#include <tautline/model/element_data.hpp>

#include "assembly/expansion.hpp"

namespace tautline::assembly {

namespace {

constexpr int block_of_columns = 64;  // right-hand sides solved at once

/// This rank's rows of -df/dL0 for cables[begin, end).
MatX right_hand_sides(const System& system, const std::vector<int>& cables, int begin, int end) {
  const auto& layout = system.layout();
  MatX b = MatX::Zero(3 * layout.local, end - begin);
  std::vector<double> all(static_cast<std::size_t>(system.n_dofs()));
  for (int k = begin; k < end; ++k) {
    const auto& cable = system.model().cables[cables[k]];
    const auto data = model::cable_data(system.model(), cable);
    const Vec<6> derivative = element::cable_force_by_unstressed_length(
        data.properties, data.x_ref, model::displacements<2>(system.state(), cable.nodes));
    std::fill(all.begin(), all.end(), 0.0);
    Expansion(system.kinematics(), system.dof_map(), cable.nodes, false).add(derivative, all);
    for (const int block : unknowns_of(system.model(), system.dof_map(), cable))
      for (int c = 0; c < 3; ++c) {
        const int unknown = 3 * block + c, row = unknown - 3 * layout.first;
        if (row >= 0 && row < b.rows() && !system.held()[unknown])
          b(row, k - begin) = -all[static_cast<std::size_t>(unknown)];
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
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (const auto& [block, matrix] : system.kinematics().displacement(nodes[i]))
        if (system.dof_map().owns(block))
          influence.block(static_cast<Eigen::Index>(3 * i), begin, 3, end - begin) +=
              matrix * x.middleRows(3 * (block - layout.first), 3);
  }
  la::sum_over_ranks(all);
  return influence;
}

}  // namespace tautline::assembly
