#include <formfinding/barrier.hpp>
#include <formfinding/compromise.hpp>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include <tautline/core/error.hpp>
#include <tautline/core/interrupt.hpp>
#include <tuple>
#include <utility>

namespace tautline::formfinding {

namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Entries = std::vector<Eigen::Triplet<double>>;

constexpr double softness = 1e-10;  // of the equilibrium rows: makes the matrix quasi-definite
constexpr double least_damping = 1e-12, most_damping = 1e10;
constexpr double balanced = 1e-12;  // force out of balance, dimensionless
constexpr double flat = 1e-8;       // gradient over that of all deviations together: a minimum
constexpr double reluctance = 100;  // of the start's nodes to move, beside its force densities
constexpr double first_barrier = 1e-2;
constexpr double barrier_falls = 0.3, barrier_creeps = 0.8;  // after a step, by whether damping was needed
constexpr double free_damping = 1e-4;
constexpr double last_barrier = 1e-9;  // over the mean square of the deviations
constexpr double at_rest = 1e-9;       // the same, within which it counts as at its bound
constexpr double least_barrier = 1e-20;
constexpr int most_restorations = 30;
constexpr int most_active_sets = 10;
constexpr int most_refinements = 5;

/// Rows of deviations and of equilibrium about one state, dimensionless: columns are the motions of the free
/// nodes, the force densities, and the mean of each range of equal tensions.
struct Linear {
  Sparse deviation, equilibrium;
};

/// [W + damping, A^T; A, -softness], factorised; the solution is that without the softness.
class Saddle {
 public:
  bool factorise(const Sparse& lower_w, const Sparse& A, double damping, const std::vector<bool>& fixed);
  /// d and the multipliers for [W, A^T; A, 0] (d, y) = (upper, lower); fixed entries of d are zero.
  std::pair<VecX, VecX> solve(const VecX& upper, const VecX& lower) const;

 private:
  Sparse exact_;  ///< lower triangle, without softness
  Eigen::SimplicialLDLT<Sparse> factor_;
  std::vector<bool> fixed_;
  Eigen::Index n_ = 0;
};

bool Saddle::factorise(const Sparse& lower_w, const Sparse& A, double damping,
                       const std::vector<bool>& fixed) {
  n_ = lower_w.rows();
  fixed_ = fixed;
  Entries entries;
  entries.reserve(static_cast<std::size_t>(lower_w.nonZeros() + A.nonZeros() + n_ + A.rows()));
  for (Eigen::Index k = 0; k < n_; ++k) {
    const auto col = static_cast<std::size_t>(k);
    entries.emplace_back(k, k, fixed[col] ? 1 : damping);
    if (fixed[col]) continue;
    for (Sparse::InnerIterator it(lower_w, k); it; ++it)
      if (!fixed[static_cast<std::size_t>(it.row())]) entries.emplace_back(it.row(), k, it.value());
    for (Sparse::InnerIterator it(A, k); it; ++it) entries.emplace_back(n_ + it.row(), k, it.value());
  }
  const Eigen::Index size = n_ + A.rows();
  for (Eigen::Index k = n_; k < size; ++k) entries.emplace_back(k, k, 0.0);
  exact_.resize(size, size);
  exact_.setFromTriplets(entries.begin(), entries.end());
  Sparse soft = exact_;
  for (Eigen::Index k = n_; k < size; ++k) soft.coeffRef(k, k) = -softness;
  factor_.compute(soft);
  // As many negative pivots as rows of equilibrium: W is positive along all motions that keep it.
  return factor_.info() == Eigen::Success && factor_.vectorD().allFinite() &&
         (factor_.vectorD().array() < 0).count() == A.rows();
}

std::pair<VecX, VecX> Saddle::solve(const VecX& upper, const VecX& lower) const {
  VecX right(n_ + lower.size());
  right << upper, lower;
  for (Eigen::Index k = 0; k < n_; ++k)
    if (fixed_[static_cast<std::size_t>(k)]) right[k] = 0;
  const auto left = [&](const VecX& x) { return VecX(right - exact_.selfadjointView<Eigen::Lower>() * x); };
  VecX x = factor_.solve(right);
  double error = left(x).norm();
  for (int k = 0; k < most_refinements && error > 0; ++k) {
    const VecX better = x + factor_.solve(left(x));
    const double now = left(better).norm();
    if (!(now < error)) break;
    x = better;
    error = now;
  }
  return {x.head(n_), x.tail(lower.size())};
}

class Compromise {
 public:
  Compromise(const NetSystem& system, const std::function<ConstraintRows(const NetState&)>& make_rows,
             const CompromiseSettings& settings, const NetState& start);

  CompromiseResult run(const NetState& start);

 private:
  struct Point {
    NetState state;
    ConstraintRows rows;
    VecX deviation;  ///< sqrt(weight) x (value - target)
    VecX force;      ///< out of balance
    double squares() const { return deviation.squaredNorm(); }
    double unbalanced() const { return force.size() > 0 ? force.lpNorm<Eigen::Infinity>() : 0.0; }
  };

  struct Step {
    Saddle saddle;
    VecX d, multiplier;
  };

  Point evaluate(const NetState& state) const;
  Point moved(const Point& from, const VecX& d) const;
  VecX within_bounds(VecX force_density) const;
  Linear linearise(const Point& at) const;
  /// Second derivatives of deviations and equilibrium, each times its multiplier; lower triangle.
  void add_curvature(const Point& at, const VecX& multiplier, Entries& entries) const;
  /// Without a multiplier without the second derivatives: as Gauss and Newton have it.
  Sparse hessian(const Point& at, const Linear& linear, const VecX* multiplier) const;
  /// Of the merit alone.
  VecX slope(const Point& at, const Linear& linear) const {
    VecX slope = linear.deviation.transpose() * at.deviation;
    slope.segment(first_q(), n_q()) += barrier_.gradient(at.state.force_density / per_q());
    return slope;
  }
  VecX gradient(const Point& at, const Linear& linear, const VecX& multiplier) const {
    return slope(at, linear) + linear.equilibrium.transpose() * multiplier;
  }
  /// Held force densities, and those at a bound that the way downhill would leave.
  std::vector<bool> fixed(const Point& at, const VecX& downhill) const;
  bool restore(Point& at) const;
  /// A part of a step, or all of it and a correction of the forces that it leaves out of balance, if that is
  /// less by the merit. @param[in] decrease  of the merit foretold
  bool take(const Step& step, double decrease, Point& now) const;
  /// The step for a matrix W; force densities at a bound that it would leave are held.
  /// @return false if W is not positive along equilibrium
  bool step_from(const Point& now, const Linear& linear, const Sparse& W, const VecX& multiplier,
                 Step& step) const;
  bool take_step(Point& now, const Linear& linear, VecX& multiplier);
  /// Whether the gradient along equilibrium and within the bounds vanishes.
  /// @param[in] multiplier  tells which bounds hold
  bool stationary(const Point& at, const VecX& multiplier) const;

  /// What is made least, with a penalty for forces out of balance that lets only equilibrium be least.
  double merit(const Point& at) const {
    return 0.5 * at.squares() + barrier_.value(at.state.force_density / per_q()) + penalty_ * at.force.norm();
  }
  bool met(const Point& at) const {
    const VecX missing = at.rows.missing();
    if (at.unbalanced() > 1e3 * balanced) return false;
    return missing.size() == 0 || missing.lpNorm<Eigen::Infinity>() <= settings_.tolerance;
  }
  /// Inside the bounds, with a barrier that falls: to near the minimum. @return whether it came to its end
  bool run_inside(Point& now, VecX& multiplier, int& iterations);
  /// With the bounds themselves. @return whether it came to its end
  void run_at_bounds(Point& now, VecX& multiplier, int& iterations);

  double per_q() const { return settings_.force / length_; }
  Eigen::Index n_q() const { return system_.n_branches(); }
  int first_q() const { return first_.back(); }
  int column_of_q(int branch) const { return first_q() + branch; }

  const NetSystem& system_;
  const std::function<ConstraintRows(const NetState&)>& make_rows_;
  const CompromiseSettings& settings_;
  double length_ = 1;       ///< by which lengths are made dimensionless [m]
  std::vector<int> first_;  ///< column of each free node's first motion, then of the force densities
  double damping_ = 1e-4;
  double penalty_ = 0;
  Barrier barrier_;
};

/// A bound for each branch, dimensionless; NaN: none.
VecX dimensionless(const VecX& bounds, Eigen::Index n, double unit) {
  VecX result = VecX::Constant(n, std::nan(""));
  for (Eigen::Index b = 0; b < bounds.size(); ++b)
    if (std::isfinite(bounds[b])) result[b] = bounds[b] / unit;
  return result;
}

Compromise::Compromise(const NetSystem& system,
                       const std::function<ConstraintRows(const NetState&)>& make_rows,
                       const CompromiseSettings& settings, const NetState& start)
    : system_(system),
      make_rows_(make_rows),
      settings_(settings),
      length_(start.length.mean()),
      barrier_(dimensionless(settings.lower, system.n_branches(), per_q()),
               dimensionless(settings.upper, system.n_branches(), per_q())) {
  first_.assign(1, 0);
  for (int i = 0; i < system.n_free(); ++i)
    first_.push_back(first_.back() + system.directions(start, i).count);
}

Compromise::Point Compromise::evaluate(const NetState& state) const {
  Point at;
  at.state = state;
  at.rows = make_rows_(state);
  at.deviation = -at.rows.missing();
  for (Eigen::Index k = 0; k < at.deviation.size(); ++k)
    at.deviation[k] *= std::sqrt(at.rows.weight[static_cast<std::size_t>(k)]);
  const Coordinates force = nodal_forces(system_.net(), state.force_density, state.vectors);
  at.force.resize(first_q());
  for (int i = 0; i < system_.n_free(); ++i) {
    const auto ways = system_.directions(state, i);
    at.force.segment(first_[i], ways.count) = ways.force.leftCols(ways.count).transpose() *
                                              force.row(system_.free_nodes()[i]).transpose() /
                                              settings_.force;
  }
  return at;
}

Compromise::Point Compromise::moved(const Point& from, const VecX& d) const {
  Coordinates nodes = from.state.nodes;
  for (int i = 0; i < system_.n_free(); ++i) {
    const auto ways = system_.directions(from.state, i);
    const Vec3 motion = ways.motion.leftCols(ways.count) * d.segment(first_[i], ways.count);
    nodes.row(system_.free_nodes()[i]) += length_ * motion.transpose();
  }
  const VecX q = from.state.force_density + per_q() * d.segment(first_q(), n_q());
  const VecX kept =
      barrier_.active()
          ? VecX(per_q() * barrier_.keep_inside(from.state.force_density / per_q(), q / per_q()))
          : within_bounds(q);
  return evaluate(system_.state(kept, std::move(nodes)));
}

VecX Compromise::within_bounds(VecX q) const {
  for (Eigen::Index b = 0; b < settings_.lower.size(); ++b)
    if (q[b] < settings_.lower[b]) q[b] = settings_.lower[b];
  for (Eigen::Index b = 0; b < settings_.upper.size(); ++b)
    if (q[b] > settings_.upper[b]) q[b] = settings_.upper[b];
  return q;
}

Linear Compromise::linearise(const Point& at) const {
  const double per_q = this->per_q();
  Entries deviation, equilibrium;
  const auto weight = [&](int row) { return std::sqrt(at.rows.weight[static_cast<std::size_t>(row)]); };
  const auto motions = [&](int node, const auto& add) {
    if (const int i = system_.free_index(node); i >= 0) add(first_[i], system_.directions(at.state, i));
  };
  for (const auto& e : at.rows.by_force_density)
    deviation.emplace_back(e.row(), column_of_q(static_cast<int>(e.col())),
                           weight(static_cast<int>(e.row())) * e.value() * per_q);
  for (int d = 0; d < 3; ++d)
    for (const auto& e : at.rows.by_vector[d])
      for (int end = 0; end < 2; ++end)
        motions(system_.net().branches[static_cast<std::size_t>(e.col())][end],
                [&](int first, const NetSystem::Directions& ways) {
                  for (int k = 0; k < ways.count; ++k)
                    deviation.emplace_back(e.row(), first + k,
                                           (end == 0 ? -1 : 1) * weight(static_cast<int>(e.row())) *
                                               e.value() * ways.motion(d, k) * length_);
                });
  const int n_means = static_cast<int>(at.rows.centred.size());
  for (int c = 0; c < n_means; ++c)
    for (int k = 0; k < at.rows.centred[c][1]; ++k)
      deviation.emplace_back(at.rows.centred[c][0] + k, first_q() + n_q() + c,
                             -weight(at.rows.centred[c][0] + k));
  for (int b = 0; b < system_.n_branches(); ++b) {
    const auto& ends = system_.net().branches[b];
    const Vec3 u = at.state.vectors.row(b).transpose() / length_;
    const double q = at.state.force_density[b] / per_q;
    for (int end = 0; end < 2; ++end)
      motions(ends[end], [&](int row, const NetSystem::Directions& here) {
        const double sign = end == 0 ? 1 : -1;
        for (int k = 0; k < here.count; ++k)
          equilibrium.emplace_back(row + k, column_of_q(b), sign * here.force.col(k).dot(u));
        for (int other = 0; other < 2; ++other)
          motions(ends[other], [&](int column, const NetSystem::Directions& there) {
            for (int k = 0; k < here.count; ++k)
              for (int l = 0; l < there.count; ++l)
                equilibrium.emplace_back(
                    row + k, column + l,
                    sign * (other == 0 ? -1 : 1) * q * here.force.col(k).dot(there.motion.col(l)));
          });
      });
  }
  const auto columns = first_q() + n_q() + n_means;
  Linear linear{Sparse(at.deviation.size(), columns), Sparse(first_q(), columns)};
  linear.deviation.setFromTriplets(deviation.begin(), deviation.end());
  linear.equilibrium.setFromTriplets(equilibrium.begin(), equilibrium.end());
  return linear;
}

void Compromise::add_curvature(const Point& at, const VecX& multiplier, Entries& entries) const {
  // Of each branch by its vector u (3) and by q with u: in the net's units, then made dimensionless.
  const auto m = static_cast<std::size_t>(system_.n_branches());
  std::vector<Mat3> by_uu(m, Mat3::Zero());
  std::vector<Vec3> by_qu(m, Vec3::Zero());
  std::vector<double> by_qq(m, 0);
  const auto weighted = [&](int row) {
    return at.deviation[row] * std::sqrt(at.rows.weight[static_cast<std::size_t>(row)]);
  };
  for (const auto& c : at.rows.curvature) {
    const double L = at.state.length[c.branch], r = weighted(c.row);
    const Vec3 e = at.state.vectors.row(c.branch).transpose() / L;
    const auto b = static_cast<std::size_t>(c.branch);
    by_uu[b] += r * (c.by_LL * e * e.transpose() + c.by_L / L * (Mat3::Identity() - e * e.transpose()));
    by_qu[b] += r * c.by_qL * e;
    by_qq[b] += r * c.by_qq;
  }
  for (int d = 0; d < 3; ++d)
    for (const auto& e : at.rows.by_product[d])
      by_qu[static_cast<std::size_t>(e.col())][d] += weighted(static_cast<int>(e.row())) * e.value();
  const auto multiplier_at = [&](int node) -> Vec3 {
    const int i = system_.free_index(node);
    if (i < 0) return Vec3::Zero();
    const auto ways = system_.directions(at.state, i);
    return ways.force.leftCols(ways.count) * multiplier.segment(first_[i], ways.count);
  };
  const double per_q = this->per_q();
  const auto add = [&](int row, int column, double value) {
    if (row >= column) entries.emplace_back(row, column, value);
  };
  for (std::size_t b = 0; b < m; ++b) {
    const auto& ends = system_.net().branches[b];
    const Vec3 qu = by_qu[b] + (multiplier_at(ends[0]) - multiplier_at(ends[1])) / settings_.force;
    add(column_of_q(static_cast<int>(b)), column_of_q(static_cast<int>(b)), by_qq[b] * per_q * per_q);
    for (int end = 0; end < 2; ++end) {
      const int i = system_.free_index(ends[end]);
      if (i < 0) continue;
      const auto here = system_.directions(at.state, i);
      for (int k = 0; k < here.count; ++k)
        add(column_of_q(static_cast<int>(b)), first_[i] + k,
            (end == 0 ? -1 : 1) * qu.dot(here.motion.col(k)) * per_q * length_);
      for (int other = 0; other < 2; ++other) {
        const int j = system_.free_index(ends[other]);
        if (j < 0) continue;
        const auto there = system_.directions(at.state, j);
        for (int k = 0; k < here.count; ++k)
          for (int l = 0; l < there.count; ++l)
            add(first_[i] + k, first_[j] + l,
                (end == other ? 1 : -1) * length_ * length_ *
                    here.motion.col(k).dot(by_uu[b] * there.motion.col(l)));
      }
    }
  }
}

Sparse Compromise::hessian(const Point& at, const Linear& linear, const VecX* multiplier) const {
  Entries entries;
  if (multiplier != nullptr) add_curvature(at, *multiplier, entries);
  const VecX barrier = barrier_.curvature(at.state.force_density / per_q());
  for (int b = 0; b < system_.n_branches(); ++b)
    entries.emplace_back(column_of_q(b), column_of_q(b), barrier[b]);
  const auto n = linear.deviation.cols();
  Sparse curvature(n, n);
  curvature.setFromTriplets(entries.begin(), entries.end());
  const Sparse squares = linear.deviation.transpose() * linear.deviation;
  return curvature + Sparse(squares.triangularView<Eigen::Lower>());
}

std::vector<bool> Compromise::fixed(const Point& at, const VecX& downhill) const {
  std::vector<bool> fixed(static_cast<std::size_t>(downhill.size()), false);
  const VecX& q = at.state.force_density;
  const double rounding = at_rest * per_q();
  for (int b = 0; b < system_.n_branches(); ++b) {
    const double way = downhill[column_of_q(b)];
    const bool held = !settings_.held.empty() && settings_.held[b];
    const bool at_lower =
        !barrier_.active() && b < settings_.lower.size() && q[b] <= settings_.lower[b] + rounding;
    const bool at_upper =
        !barrier_.active() && b < settings_.upper.size() && q[b] >= settings_.upper[b] - rounding;
    fixed[column_of_q(b)] = held || (at_lower && way < 0) || (at_upper && way > 0);
  }
  return fixed;
}

bool Compromise::restore(Point& at) const {
  for (int k = 0; k < most_restorations && at.unbalanced() > balanced; ++k) {
    const Linear linear = linearise(at);
    Sparse identity(linear.equilibrium.cols(), linear.equilibrium.cols());
    identity.setIdentity();
    for (int i = 0; i < first_q(); ++i) identity.coeffRef(i, i) = reluctance;
    std::vector<bool> hold = fixed(at, VecX::Zero(linear.equilibrium.cols()));
    Saddle saddle;
    VecX d;
    for (int pass = 0; pass < most_active_sets; ++pass) {
      if (!saddle.factorise(identity, linear.equilibrium, 0, hold)) return false;
      d = saddle.solve(VecX::Zero(identity.rows()), -at.force).first;
      const auto leaving = fixed(at, d);
      if (leaving == hold) break;
      for (std::size_t i = 0; i < hold.size(); ++i) hold[i] = hold[i] || leaving[i];
    }
    bool better = false;
    for (double alpha = 1; !better && alpha > 1e-4; alpha /= 2) {
      Point trial = moved(at, alpha * d);
      better = trial.force.norm() < at.force.norm();
      if (better) at = std::move(trial);
    }
    if (!better) break;
  }
  return at.unbalanced() <= 1e3 * balanced;
}

bool Compromise::step_from(const Point& now, const Linear& linear, const Sparse& W, const VecX& multiplier,
                           Step& step) const {
  std::vector<bool> hold = fixed(now, -gradient(now, linear, multiplier));
  for (int pass = 0; pass < most_active_sets; ++pass) {
    if (!step.saddle.factorise(W, linear.equilibrium, damping_, hold)) return false;
    std::tie(step.d, step.multiplier) = step.saddle.solve(-slope(now, linear), -now.force);
    const auto leaving = fixed(now, step.d);
    bool more = false;
    for (std::size_t i = 0; i < hold.size(); ++i) {
      more = more || (leaving[i] && !hold[i]);
      hold[i] = hold[i] || leaving[i];
    }
    if (!more) break;
  }
  return true;
}

bool Compromise::take_step(Point& now, const Linear& linear, VecX& multiplier) {
  // Newton's matrix where it is positive along equilibrium, else that of Gauss and Newton.
  const Sparse newton = hessian(now, linear, &multiplier), gauss_newton = hessian(now, linear, nullptr);
  const VecX down = -slope(now, linear);
  for (; damping_ < most_damping; damping_ *= 10)
    for (const Sparse* W : {&newton, &gauss_newton}) {
      Step step;
      if (!step_from(now, linear, *W, multiplier, step)) continue;
      penalty_ = 1.5 * step.multiplier.norm();
      const VecX before = now.state.force_density / per_q();
      if (!take(step, penalty_ * now.force.norm() + down.dot(step.d), now)) continue;
      if (barrier_.active()) barrier_.follow(before, now.state.force_density / per_q() - before);
      multiplier = step.multiplier;
      damping_ = std::max(least_damping, damping_ / 10);
      return true;
    }
  return false;
}

bool Compromise::take(const Step& step, double decrease, Point& now) const {
  constexpr double worthwhile = 1e-4;  // of the decrease foretold
  for (const double alpha : {1.0, 0.5, 0.25}) {
    try {
      Point trial = moved(now, alpha * step.d);
      const double wanted = merit(now) - worthwhile * alpha * std::max(0.0, decrease);
      if (!(merit(trial) < wanted)) {
        if (alpha < 1) continue;
        trial = moved(trial, step.saddle.solve(VecX::Zero(step.d.size()), -trial.force).first);
        if (!(merit(trial) < wanted)) continue;
      }
      now = std::move(trial);
      return true;
    } catch (const ModelError&) {
      // The step left the surface: too long.
    }
  }
  return false;
}

bool Compromise::stationary(const Point& at, const VecX& multiplier) const {
  const Linear linear = linearise(at);
  Sparse identity(linear.equilibrium.cols(), linear.equilibrium.cols());
  identity.setIdentity();
  const VecX down = -slope(at, linear);
  double steepest = 0;
  for (Eigen::Index k = 0; k < linear.deviation.cols(); ++k)
    steepest = std::max(steepest, linear.deviation.col(k).norm());
  const double limit = flat * steepest * at.deviation.norm();
  // Along equilibrium, with what its bounds hold; and those must hold it.
  std::vector<bool> hold = fixed(at, -gradient(at, linear, multiplier));
  for (int pass = 0; pass < most_active_sets; ++pass) {
    Saddle saddle;
    if (!saddle.factorise(identity, linear.equilibrium, 0, hold)) return false;
    const auto [along, refined] = saddle.solve(down, VecX::Zero(at.force.size()));
    if (along.lpNorm<Eigen::Infinity>() > limit) return false;
    const VecX left = gradient(at, linear, refined);
    VecX beyond = -left;
    for (double& way : beyond)
      if (std::abs(way) <= limit) way = 0;
    const auto leaving = fixed(at, beyond);
    bool held_well = true;
    for (Eigen::Index k = 0; k < left.size(); ++k) {
      const auto column = static_cast<std::size_t>(k);
      if (!hold[column] || leaving[column] || std::abs(left[k]) <= limit) continue;
      held_well = false;  // it wants back inside
      hold[column] = false;
    }
    if (held_well) return true;
  }
  return false;
}

bool Compromise::run_inside(Point& now, VecX& multiplier, int& iterations) {
  VecX q = now.state.force_density / per_q();
  barrier_.begin(first_barrier, q);
  now = evaluate(system_.state(per_q() * q, now.state.nodes));
  const auto rows = static_cast<double>(std::max<Eigen::Index>(1, now.deviation.size()));
  const auto mean_square = [&] { return now.squares() / rows; };
  barrier_.lower_to(mean_square());
  while (iterations < settings_.max_iterations && barrier_.weight() > last_barrier * mean_square() &&
         barrier_.weight() > least_barrier) {
    if (interrupt_requested()) throw Interrupted();
    if (!take_step(now, linearise(now), multiplier)) break;
    ++iterations;
    barrier_.lower_to((damping_ <= free_damping ? barrier_falls : barrier_creeps) * barrier_.weight());
  }
  q = barrier_.settle(now.state.force_density / per_q());
  barrier_.end();
  now = evaluate(system_.state(within_bounds(per_q() * q), now.state.nodes));
  damping_ = std::min(damping_, 1e-4);
  return restore(now);
}

void Compromise::run_at_bounds(Point& now, VecX& multiplier, int& iterations) {
  while (!met(now) && iterations < settings_.max_iterations) {
    if (interrupt_requested()) throw Interrupted();
    const double before = merit(now);
    if (!take_step(now, linearise(now), multiplier)) break;
    ++iterations;
    if (merit(now) > (1 - 1e-14) * before && now.unbalanced() <= balanced) break;
  }
}

CompromiseResult Compromise::run(const NetState& start) {
  CompromiseResult result;
  Point now = evaluate(system_.state(within_bounds(start.force_density), start.nodes));
  VecX multiplier = VecX::Zero(now.force.size());
  if (!barrier_.empty()) {
    Point within = now;
    if (run_inside(within, multiplier, result.iterations)) now = std::move(within);
  }
  restore(now);
  run_at_bounds(now, multiplier, result.iterations);
  result.in_balance = restore(now);
  if (!result.in_balance) return result;
  result.met = met(now);
  result.optimum = !result.met && stationary(now, multiplier);
  result.squares = now.squares();
  result.state = std::move(now.state);
  result.rows = std::move(now.rows);
  return result;
}

}  // namespace

CompromiseResult find_compromise(const NetSystem& system,
                                 const std::function<ConstraintRows(const NetState&)>& make_rows,
                                 const NetState& start, const CompromiseSettings& settings) {
  if (start.length.size() == 0 || !(start.length.minCoeff() > 0)) return {};
  return Compromise(system, make_rows, settings, start).run(start);
}

}  // namespace tautline::formfinding
