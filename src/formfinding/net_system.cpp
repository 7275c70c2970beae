#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <formfinding/net_system.hpp>
#include <tautline/core/error.hpp>

namespace tautline::formfinding {

void check(const Net& net) {
  const int n_nodes = static_cast<int>(net.nodes.size());
  if (net.fixed.size() != net.nodes.size())
    throw ModelError(
        fmt::format("the net has {} nodes, but {} are marked free or fixed", n_nodes, net.fixed.size()));
  if (!net.load.empty() && net.load.size() != net.nodes.size())
    throw ModelError(fmt::format("the net has {} nodes, but {} nodal loads", n_nodes, net.load.size()));
  for (std::size_t b = 0; b < net.branches.size(); ++b) {
    const auto [first, second] = net.branches[b];
    if (std::min(first, second) < 0 || std::max(first, second) >= n_nodes)
      throw ModelError(fmt::format("branch {} joins nodes {} and {}, but the net has {} nodes", b, first,
                                   second, n_nodes));
    if (first == second) throw ModelError(fmt::format("branch {} joins node {} with itself", b, first));
  }
}

NetSystem::NetSystem(const Net& net) : net_(net), free_index_(net.nodes.size(), -1) {
  for (std::size_t node = 0; node < net.nodes.size(); ++node) {
    if (net.fixed[node]) continue;
    free_index_[node] = n_free();
    free_nodes_.push_back(static_cast<int>(node));
  }
}

void NetSystem::factorise(const VecX& force_density) {
  check_hung(force_density);
  if (n_free() == 0) return;
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(3 * net_.branches.size());
  for (int b = 0; b < n_branches(); ++b) {
    const int i = free_index_[net_.branches[b][0]], j = free_index_[net_.branches[b][1]];
    if (i >= 0) entries.emplace_back(i, i, force_density[b]);
    if (j >= 0) entries.emplace_back(j, j, force_density[b]);
    if (i >= 0 && j >= 0) entries.emplace_back(std::max(i, j), std::min(i, j), -force_density[b]);
  }
  D_.resize(n_free(), n_free());
  D_.setFromTriplets(entries.begin(), entries.end());
  if (!analysed_) solver_.analyzePattern(D_);
  analysed_ = true;
  solver_.factorize(D_);
  check_pivots();
}

void NetSystem::check_hung(const VecX& force_density) const {
  std::vector<std::vector<int>> neighbours(net_.nodes.size());
  for (int b = 0; b < n_branches(); ++b) {
    if (force_density[b] == 0) continue;
    const auto [i, j] = net_.branches[b];
    neighbours[i].push_back(j);
    neighbours[j].push_back(i);
  }
  std::vector<bool> hung = net_.fixed;
  std::vector<int> front;
  for (std::size_t node = 0; node < hung.size(); ++node)
    if (hung[node]) front.push_back(static_cast<int>(node));
  while (!front.empty()) {
    const int node = front.back();
    front.pop_back();
    for (const int next : neighbours[node]) {
      if (hung[next]) continue;
      hung[next] = true;
      front.push_back(next);
    }
  }
  for (const int node : free_nodes_)
    if (!hung[node]) throw ModelError(fmt::format("node {} hangs on no fixed node", node));
}

void NetSystem::check_pivots() const {
  // A pivot is what elimination leaves of a diagonal entry; below rounding of that entry it is noise. In
  // order of elimination, as the solver stops at the first zero.
  const VecX pivots = solver_.vectorD();
  for (int k = 0; k < n_free(); ++k) {
    const int i = solver_.permutationPinv().indices()[k];
    if (!(std::abs(pivots[k]) > 1e-14 * std::abs(D_.coeff(i, i))))
      throw ModelError(fmt::format(
          "the force densities around node {} cancel out: its place is not determined", free_nodes_[i]));
  }
}

MatX NetSystem::solve(const MatX& right) const {
  if (n_free() == 0) return right;
  return solver_.solve(right);
}

Coordinates NetSystem::equilibrium(const VecX& force_density) const {
  // Right-hand side f - D_f x_f: the pull of the net on its free nodes when all of them lie at the origin.
  Coordinates nodes(net_.nodes.size(), 3);
  for (std::size_t node = 0; node < net_.nodes.size(); ++node)
    nodes.row(node) = net_.fixed[node] ? Vec3(net_.nodes[node]) : Vec3::Zero();
  const Coordinates pull = nodal_forces(net_, force_density, branch_vectors(net_, nodes));
  const MatX x = solve(pull(free_nodes_, Eigen::all));
  for (int i = 0; i < n_free(); ++i) nodes.row(free_nodes_[i]) = x.row(i);
  return nodes;
}

MatX NetSystem::along_branches(const MatX& free_values) const {
  MatX difference = MatX::Zero(n_branches(), free_values.cols());
  for (Eigen::Index column = 0; column < free_values.cols(); ++column) {
    for (int b = 0; b < n_branches(); ++b) {
      const int i = free_index_[net_.branches[b][0]], j = free_index_[net_.branches[b][1]];
      if (j >= 0) difference(b, column) += free_values(j, column);
      if (i >= 0) difference(b, column) -= free_values(i, column);
    }
  }
  return difference;
}

MatX NetSystem::at_free_nodes(const MatX& branch_values) const {
  MatX sum = MatX::Zero(n_free(), branch_values.cols());
  for (Eigen::Index column = 0; column < branch_values.cols(); ++column) {
    for (int b = 0; b < n_branches(); ++b) {
      const int i = free_index_[net_.branches[b][0]], j = free_index_[net_.branches[b][1]];
      if (j >= 0) sum(j, column) += branch_values(b, column);
      if (i >= 0) sum(i, column) -= branch_values(b, column);
    }
  }
  return sum;
}

Coordinates branch_vectors(const Net& net, const Coordinates& nodes) {
  Coordinates vectors(net.branches.size(), 3);
  for (std::size_t b = 0; b < net.branches.size(); ++b)
    vectors.row(b) = nodes.row(net.branches[b][1]) - nodes.row(net.branches[b][0]);
  return vectors;
}

Coordinates nodal_forces(const Net& net, const VecX& force_density, const Coordinates& vectors) {
  Coordinates force = Coordinates::Zero(net.nodes.size(), 3);
  for (std::size_t node = 0; node < net.load.size(); ++node) force.row(node) = net.load[node];
  for (std::size_t b = 0; b < net.branches.size(); ++b) {
    force.row(net.branches[b][0]) += force_density[b] * vectors.row(b);
    force.row(net.branches[b][1]) -= force_density[b] * vectors.row(b);
  }
  return force;
}

}  // namespace tautline::formfinding
