#include <formfinding/net_system.hpp>

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <tautline/formfinding/node_error.hpp>
#include <utility>

namespace tautline::formfinding {

namespace {

void check_branches(const Net& net) {
  const int n_nodes = static_cast<int>(net.nodes.size());
  for (std::size_t b = 0; b < net.branches.size(); ++b) {
    const auto [first, second] = net.branches[b];
    if (std::min(first, second) < 0 || std::max(first, second) >= n_nodes)
      throw ModelError(fmt::format("branch {} joins nodes {} and {}, but the net has {} nodes", b + 1,
                                   first + 1, second + 1, n_nodes));
    if (first == second) throw NodeError(fmt::format("branch {} joins ", b + 1), {first}, " with itself");
  }
}

void check_guides(const Net& net, const Surface* surface) {
  if (!net.guides.empty() && surface)
    throw ModelError(
        "a net on a surface cannot have guides: lay its guided nodes on the surface or fix them");
  std::vector<bool> guided(net.nodes.size(), false);
  for (const Guide& guide : net.guides) {
    if (guide.node < 0 || guide.node >= static_cast<int>(net.nodes.size()))
      throw ModelError(
          fmt::format("a guide leads node {}, but the net has {} nodes", guide.node + 1, net.nodes.size()));
    if (net.fixed[guide.node]) throw NodeError("", {guide.node}, " is fixed and has a guide");
    if (guided[guide.node]) throw NodeError("", {guide.node}, " has two guides");
    if (!(guide.direction.norm() > 0)) throw NodeError("the guide of ", {guide.node}, " has no direction");
    guided[guide.node] = true;
  }
}

/// Columns: the directions in which the node may move.
Mat3 free_directions(const Guide& guide) {
  const Vec3 along = guide.direction.normalized(), across = along.unitOrthogonal();
  Mat3 basis = Mat3::Zero();
  if (guide.kind == Guide::Kind::line) {
    basis.col(0) = along;
  } else {
    basis.col(0) = across;
    basis.col(1) = along.cross(across);
  }
  return basis;
}

}  // namespace

void check(const Net& net, const Surface* surface) {
  const std::size_t n_nodes = net.nodes.size();
  if (net.fixed.size() != n_nodes)
    throw ModelError(
        fmt::format("the net has {} nodes, but {} are marked free or fixed", n_nodes, net.fixed.size()));
  if (!net.load.empty() && net.load.size() != n_nodes)
    throw ModelError(fmt::format("the net has {} nodes, but {} nodal loads", n_nodes, net.load.size()));
  if (!net.on_surface.empty() && net.on_surface.size() != n_nodes)
    throw ModelError(fmt::format("the net has {} nodes, but {} are marked on or off the surface", n_nodes,
                                 net.on_surface.size()));
  check_branches(net);
  check_guides(net, surface);
}

NetSystem::NetSystem(const Net& net, const Surface* surface)
    : net_(net), surface_(surface), free_index_(net.nodes.size(), -1) {
  for (std::size_t node = 0; node < net.nodes.size(); ++node) {
    if (net.fixed[node]) continue;
    free_index_[node] = n_free();
    free_nodes_.push_back(static_cast<int>(node));
  }
  if (surface) {
    on_surface_.assign(free_nodes_.size(), true);
    height_index_.assign(free_nodes_.size(), -1);
    for (int i = 0; i < n_free(); ++i) {
      if (net.on_surface.empty() || net.on_surface[free_nodes_[i]]) continue;
      on_surface_[i] = false;
      height_index_[i] = static_cast<int>(height_nodes_.size());
      height_nodes_.push_back(i);
    }
  }
  if (!guided()) return;
  basis_.assign(free_nodes_.size(), Mat3::Identity());
  std::vector<int> unknowns(free_nodes_.size(), 3);
  for (const Guide& guide : net.guides) {
    const int i = free_index_[guide.node];
    basis_[i] = free_directions(guide);
    unknowns[i] = guide.kind == Guide::Kind::line ? 1 : 2;
  }
  first_unknown_.assign(1, 0);
  for (const int count : unknowns) first_unknown_.push_back(first_unknown_.back() + count);
}

void NetSystem::factorise(const VecX& force_density) {
  check_hung(force_density);
  force_density_ = force_density;
  if (guided())
    factorise_guided(force_density);
  else
    factorise_scalar(force_density);
}

void NetSystem::factorise_scalar(const VecX& force_density) {
  const auto assemble = [&](const std::vector<int>* index) {
    SparseFactor::Entries entries;
    entries.reserve(3 * net_.branches.size());
    const auto unknown = [&](int free) { return free < 0 || !index ? free : (*index)[free]; };
    for (int b = 0; b < n_branches(); ++b) {
      const int i = unknown(free_index_[net_.branches[b][0]]), j = unknown(free_index_[net_.branches[b][1]]);
      if (i >= 0) entries.emplace_back(i, i, force_density[b]);
      if (j >= 0) entries.emplace_back(j, j, force_density[b]);
      if (i >= 0 && j >= 0) entries.emplace_back(std::max(i, j), std::min(i, j), -force_density[b]);
    }
    return entries;
  };
  const int cancelled = factor_.factorise(n_free(), assemble(nullptr));
  if (cancelled >= 0) report_cancelled(cancelled);
  if (height_nodes_.empty()) return;
  const int cancelled_height =
      height_factor_.factorise(static_cast<int>(height_nodes_.size()), assemble(&height_index_));
  if (cancelled_height >= 0) report_cancelled(height_nodes_[cancelled_height]);
}

void NetSystem::factorise_guided(const VecX& force_density) {
  SparseFactor::Entries entries;
  const auto add = [&](int i, int j, double value) {
    for (int a = first_unknown_[i]; a < first_unknown_[i + 1]; ++a)
      for (int b = first_unknown_[j]; b < first_unknown_[j + 1]; ++b)
        if (a >= b)
          entries.emplace_back(
              a, b, value * basis_[i].col(a - first_unknown_[i]).dot(basis_[j].col(b - first_unknown_[j])));
  };
  for (int b = 0; b < n_branches(); ++b) {
    const int i = free_index_[net_.branches[b][0]], j = free_index_[net_.branches[b][1]];
    if (i >= 0) add(i, i, force_density[b]);
    if (j >= 0) add(j, j, force_density[b]);
    if (i >= 0 && j >= 0) add(std::max(i, j), std::min(i, j), -force_density[b]);
  }
  const int cancelled = factor_.factorise(first_unknown_.back(), entries);
  if (cancelled < 0) return;
  const auto after = std::upper_bound(first_unknown_.begin(), first_unknown_.end(), cancelled);
  report_cancelled(static_cast<int>(after - first_unknown_.begin()) - 1);
}

void NetSystem::report_cancelled(int free) const {
  throw CancelledDensities("the force densities around ", {free_nodes_[free]},
                           " cancel out: its place is not determined");
}

int NetSystem::negative_pivots() const {
  // Without guides each of the three directions has the same D.
  if (guided()) return factor_.negative_pivots();
  return surface_ ? 2 * factor_.negative_pivots() + height_factor_.negative_pivots()
                  : 3 * factor_.negative_pivots();
}

void NetSystem::check_hung(const VecX& force_density) const {
  std::vector<bool> hung = net_.fixed;
  std::vector<int> front, first(net_.nodes.size() + 1, 0), neighbours(2 * net_.branches.size());
  for (const auto& branch : net_.branches)
    for (const int node : branch) ++first[node + 1];
  for (std::size_t node = 0; node < net_.nodes.size(); ++node) first[node + 1] += first[node];
  std::vector<int> next(first.begin(), first.end() - 1);
  for (int b = 0; b < n_branches(); ++b)
    for (const int node : net_.branches[b]) neighbours[next[node]++] = b;
  for (const Guide& guide : net_.guides) hung[guide.node] = true;  // held across its guide
  for (std::size_t node = 0; node < hung.size(); ++node)
    if (hung[node]) front.push_back(static_cast<int>(node));
  while (!front.empty()) {
    const int node = front.back();
    front.pop_back();
    for (int k = first[node]; k < first[node + 1]; ++k) {
      const int b = neighbours[k];
      const int other = net_.branches[b][0] == node ? net_.branches[b][1] : net_.branches[b][0];
      if (hung[other] || force_density[b] == 0) continue;
      hung[other] = true;
      front.push_back(other);
    }
  }
  for (const int node : free_nodes_)
    if (!hung[node]) throw NodeError("", {node}, " is not connected to any fixed node");
}

NetState NetSystem::state(const VecX& force_density, Coordinates nodes) const {
  NetState state;
  state.force_density = force_density;
  state.nodes = std::move(nodes);
  if (surface_) {
    state.slope_x = state.slope_y = VecX::Zero(n_free());
    for (int i = 0; i < n_free(); ++i) {
      if (!on_surface(i)) continue;
      auto node = state.nodes.row(free_nodes_[i]);
      const Vec3 z = surface_->height_and_slope(node.x(), node.y());
      node.z() = z[0];
      state.slope_x[i] = z[1];
      state.slope_y[i] = z[2];
    }
  }
  state.vectors = branch_vectors(net_, state.nodes);
  state.length = state.vectors.rowwise().norm();
  return state;
}

NetState NetSystem::equilibrium(const VecX& force_density) const {
  // Right-hand side f - D_f x_f: the pull of the net on its free nodes when all of them lie at the origin, or
  // at the given points of their guides.
  Coordinates nodes = to_coordinates(net_.nodes);
  for (const int node : free_nodes_) nodes.row(node).setZero();
  for (const Guide& guide : net_.guides) nodes.row(guide.node) = guide.point;
  const Coordinates pull =
      nodal_forces(net_, force_density, branch_vectors(net_, nodes))(free_nodes_, Eigen::all);
  const Coordinates moved = guided() ? from_unknowns(factor_.solve(to_unknowns(pull))) : factor_.solve(pull);
  for (int i = 0; i < n_free(); ++i) nodes.row(free_nodes_[i]) += moved.row(i);
  if (height_nodes_.empty()) return state(force_density, nodes);

  nodes = state(force_density, nodes).nodes;
  for (const int i : height_nodes_) nodes(free_nodes_[i], 2) = 0;
  const Coordinates force = nodal_forces(net_, force_density, branch_vectors(net_, nodes));
  VecX lift(height_nodes_.size());
  for (std::size_t k = 0; k < height_nodes_.size(); ++k) lift[k] = force(free_nodes_[height_nodes_[k]], 2);
  lift = height_factor_.solve(lift);
  for (std::size_t k = 0; k < height_nodes_.size(); ++k) nodes(free_nodes_[height_nodes_[k]], 2) = lift[k];
  return state(force_density, nodes);
}

VecX NetSystem::couple(const VecX& values, bool transposed) const {
  VecX result = VecX::Zero(transposed ? n_free() : static_cast<Eigen::Index>(height_nodes_.size()));
  for (int b = 0; b < n_branches(); ++b) {
    int on = free_index_[net_.branches[b][0]], off = free_index_[net_.branches[b][1]];
    if (on < 0 || off < 0 || on_surface(on) == on_surface(off)) continue;
    if (!on_surface(on)) std::swap(on, off);
    if (transposed)
      result[on] += force_density_[b] * values[height_index_[off]];
    else
      result[height_index_[off]] += force_density_[b] * values[on];
  }
  return result;
}

Coordinates NetSystem::respond(const NetState& state, const Coordinates& force) const {
  if (guided()) return from_unknowns(factor_.solve(to_unknowns(force)));
  Coordinates dx = factor_.solve(force);
  if (!surface_ || !state.z_follows_surface) return dx;
  dx.col(2) = state.slope_x.cwiseProduct(dx.col(0)) + state.slope_y.cwiseProduct(dx.col(1));
  if (height_nodes_.empty()) return dx;
  const VecX lift = force.col(2)(height_nodes_) + couple(dx.col(2), false);
  dx.col(2)(height_nodes_) = height_factor_.solve(lift);
  return dx;
}

Coordinates NetSystem::respond_transposed(const NetState& state, const Coordinates& values) const {
  if (guided() || !surface_ || !state.z_follows_surface) return respond(state, values);
  Coordinates by_force = values;
  VecX by_height = values.col(2), lift;
  if (!height_nodes_.empty()) {
    lift = height_factor_.solve(VecX(values.col(2)(height_nodes_)));
    by_height += couple(lift, true);
  }
  by_force.col(0) += state.slope_x.cwiseProduct(by_height);
  by_force.col(1) += state.slope_y.cwiseProduct(by_height);
  by_force.col(2).setZero();
  by_force = factor_.solve(by_force);
  if (!height_nodes_.empty()) by_force.col(2)(height_nodes_) = lift;
  return by_force;
}

NetSystem::Directions NetSystem::directions(const NetState& state, int free) const {
  Directions ways;
  if (guided()) {
    ways.count = first_unknown_[free + 1] - first_unknown_[free];
    ways.motion = ways.force = basis_[free];
  }
  if (!on_surface(free)) return ways;
  ways.count = 2;
  ways.motion.row(2) << state.slope_x[free], state.slope_y[free], 0;
  return ways;
}

Coordinates NetSystem::unbalanced(Coordinates force) const {
  if (guided()) return from_unknowns(to_unknowns(force));
  for (int i = 0; i < n_free(); ++i)
    if (on_surface(i)) force(i, 2) = 0;
  return force;
}

VecX NetSystem::to_unknowns(const Coordinates& force) const {
  VecX unknowns(first_unknown_.back());
  for (int i = 0; i < n_free(); ++i)
    for (int k = first_unknown_[i]; k < first_unknown_[i + 1]; ++k)
      unknowns[k] = force.row(i).dot(basis_[i].col(k - first_unknown_[i]));
  return unknowns;
}

Coordinates NetSystem::from_unknowns(const VecX& unknowns) const {
  Coordinates moved = Coordinates::Zero(n_free(), 3);
  for (int i = 0; i < n_free(); ++i)
    for (int k = first_unknown_[i]; k < first_unknown_[i + 1]; ++k)
      moved.row(i) += unknowns[k] * basis_[i].col(k - first_unknown_[i]).transpose();
  return moved;
}

Coordinates NetSystem::along_branches(const Coordinates& free_values) const {
  Coordinates difference = Coordinates::Zero(n_branches(), 3);
  for (int b = 0; b < n_branches(); ++b) {
    const int i = free_index_[net_.branches[b][0]], j = free_index_[net_.branches[b][1]];
    if (j >= 0) difference.row(b) += free_values.row(j);
    if (i >= 0) difference.row(b) -= free_values.row(i);
  }
  return difference;
}

Coordinates NetSystem::at_free_nodes(const Coordinates& branch_values) const {
  Coordinates sum = Coordinates::Zero(n_free(), 3);
  for (int b = 0; b < n_branches(); ++b) {
    const int i = free_index_[net_.branches[b][0]], j = free_index_[net_.branches[b][1]];
    if (j >= 0) sum.row(j) += branch_values.row(b);
    if (i >= 0) sum.row(i) -= branch_values.row(b);
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

Points to_points(const Coordinates& nodes) {
  Points points(nodes.rows());
  for (Eigen::Index node = 0; node < nodes.rows(); ++node) points[node] = nodes.row(node);
  return points;
}

Coordinates to_coordinates(const Points& points) {
  Coordinates nodes(points.size(), 3);
  for (std::size_t node = 0; node < points.size(); ++node) nodes.row(node) = points[node];
  return nodes;
}

Vec3 coordinate_norm(const NetSystem& system, const NetState& state) {
  Vec3 squares = Vec3::Zero();
  for (const int node : system.free_nodes()) squares += state.nodes.row(node).cwiseAbs2().transpose();
  return squares.cwiseSqrt();
}

}  // namespace tautline::formfinding
