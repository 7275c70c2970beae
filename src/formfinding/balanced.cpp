#include <tautline/formfinding/balanced.hpp>

#include <algorithm>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/formfinding/node_error.hpp>
#include <tautline/formfinding/force_density.hpp>

namespace tautline::formfinding {

namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr int most_corrections = 20;  // for branches found below their least tension

void check(const Net& net, const VecX& wanted) {
  if (!net.guides.empty()) throw ModelError("a net with guided nodes cannot be balanced as drawn");
  for (std::size_t b = 0; b < net.branches.size(); ++b) {
    const auto [i, j] = net.branches[b];
    if (!(wanted[static_cast<Eigen::Index>(b)] > 0))
      throw NetError({branch_word(static_cast<int>(b)), " has no tension to aim at"});
    if (!((net.nodes[j] - net.nodes[i]).norm() > 0))
      throw NetError({branch_word(static_cast<int>(b)), " has no length as drawn"});
  }
}

/// Largest wanted tension at each node: the measure of what is out of balance there.
std::vector<double> node_scales(const Net& net, const VecX& wanted) {
  std::vector<double> scale(net.nodes.size(), 0);
  for (std::size_t b = 0; b < net.branches.size(); ++b)
    for (const int i : net.branches[b]) scale[i] = std::max(scale[i], wanted[static_cast<Eigen::Index>(b)]);
  return scale;
}

/// Equations of balance, scaled: rows of B and p in B s = p, s = tension over what is wanted.
class Balance {
 public:
  Balance(const Net& net, const VecX& wanted, const Surface* surface, const BalancedOptions& options)
      : net_(net),
        scale_(node_scales(net, wanted)),
        weight_(options.balance_weight * Vec3(1, 1, options.height_weight)),
        row_(net.nodes.size(), -1) {
    number_rows(surface);
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t b = 0; b < net.branches.size(); ++b) {
      const auto [i, j] = net.branches[b];
      const Vec3 pull = wanted[static_cast<Eigen::Index>(b)] * (net.nodes[j] - net.nodes[i]).normalized();
      add(entries, i, static_cast<int>(b), pull);
      add(entries, j, static_cast<int>(b), -pull);
    }
    matrix_ = Sparse(n_rows_, static_cast<Eigen::Index>(net.branches.size()));
    matrix_.setFromTriplets(entries.begin(), entries.end());
  }

  const Sparse& matrix() const { return matrix_; }
  VecX right_side() const {
    VecX p = VecX::Zero(n_rows_);
    for (std::size_t i = 0; i < net_.load.size(); ++i)
      for (int c = 0; c < n_directions_[i]; ++c) p[row_[i] + c] = -weight_[c] / scale_[i] * net_.load[i][c];
    return p;
  }

 private:
  void number_rows(const Surface* surface) {
    n_directions_.assign(net_.nodes.size(), 0);
    for (std::size_t i = 0; i < net_.nodes.size(); ++i) {
      if (net_.fixed[i] || scale_[i] == 0) continue;
      const bool bound = surface != nullptr && (net_.on_surface.empty() || net_.on_surface[i]);
      row_[i] = n_rows_;
      n_directions_[i] = bound ? 2 : 3;
      n_rows_ += n_directions_[i];
    }
  }
  void add(std::vector<Eigen::Triplet<double>>& entries, int node, int branch, const Vec3& pull) const {
    for (int c = 0; c < n_directions_[node]; ++c)
      entries.emplace_back(row_[node] + c, branch, weight_[c] / scale_[node] * pull[c]);
  }

  const Net& net_;
  std::vector<double> scale_;
  Vec3 weight_;  ///< of balance along x, y, z
  std::vector<int> row_, n_directions_;
  int n_rows_ = 0;
  Sparse matrix_;
};

/// Minimises |s - 1|^2 + |B s - p|^2 over the branches that are not set; the others keep their s.
VecX least_squares(const Balance& balance, VecX s, const std::vector<bool>& set) {
  Sparse choice(s.size(), s.size());  // columns of the unknowns only
  VecX given = VecX::Zero(s.size());
  std::vector<Eigen::Triplet<double>> ones;
  int n = 0;
  for (Eigen::Index b = 0; b < s.size(); ++b) {
    if (set[static_cast<std::size_t>(b)])
      given[b] = s[b];
    else
      ones.emplace_back(b, n++, 1.0);
  }
  choice.resize(s.size(), n);
  choice.setFromTriplets(ones.begin(), ones.end());
  const Sparse b = balance.matrix() * choice;
  Sparse normal = b.transpose() * b;
  Sparse identity(n, n);
  identity.setIdentity();
  normal += identity;
  const VecX side = VecX::Ones(n) + b.transpose() * (balance.right_side() - balance.matrix() * given);
  const Eigen::SimplicialLDLT<Sparse> factor(normal);
  return given + choice * factor.solve(side);
}

VecX lengths(const Net& net) {
  VecX length(net.branches.size());
  for (std::size_t b = 0; b < net.branches.size(); ++b)
    length[static_cast<Eigen::Index>(b)] =
        (net.nodes[net.branches[b][1]] - net.nodes[net.branches[b][0]]).norm();
  return length;
}

/// One round: branches that would carry less than their least part are set to it, the others found again.
VecX fit(const Net& net, const VecX& wanted, std::vector<bool> set, const Surface* surface,
         const BalancedOptions& options) {
  const Balance balance(net, wanted, surface, options);
  VecX s = VecX::Ones(wanted.size());
  for (int i = 0; i < most_corrections; ++i) {
    s = least_squares(balance, s, set);
    bool pressed = false;
    for (Eigen::Index b = 0; b < s.size(); ++b) {
      if (set[static_cast<std::size_t>(b)] || s[b] >= options.least_part) continue;
      s[b] = options.least_part;
      set[static_cast<std::size_t>(b)] = pressed = true;
    }
    if (!pressed) break;
  }
  return s.cwiseMax(options.least_part);
}

}  // namespace

VecX balancing_force_densities(const Net& net, const VecX& wanted, const std::vector<bool>& held,
                               const Surface* surface, const BalancedOptions& options) {
  check(net, wanted);
  const std::vector<bool> set = held.empty() ? std::vector<bool>(net.branches.size(), false) : held;
  Net at = net;
  VecX aim = wanted, q = wanted.cwiseQuotient(lengths(at));
  for (int round = 0; round < options.rounds; ++round) {
    if (round > 0) at.nodes = solve_linear(at, q, surface);
    const VecX length = lengths(at);
    for (std::size_t b = 0; b < set.size(); ++b)
      if (const auto i = static_cast<Eigen::Index>(b); set[b]) aim[i] = q[i] * length[i];
    q = fit(at, aim, set, surface, options).cwiseProduct(aim).cwiseQuotient(length);
  }
  return q;
}

}  // namespace tautline::formfinding
