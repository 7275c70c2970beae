#include <fmt/format.h>

#include <cmath>
#include <formfinding/jacobian.hpp>
#include <formfinding/lsqr.hpp>
#include <limits>
#include <tautline/core/error.hpp>
#include <tautline/core/interrupt.hpp>
#include <tautline/formfinding/force_density.hpp>
#include <utility>

namespace tautline::formfinding {

namespace {

constexpr double inner_tolerance = 1e-10;  // of the linear step: far below the quadratic error of Newton
constexpr int max_relaxations = 5;         // alpha = 1, 1/4, 1/64, 1/4096, 1/2^20
constexpr int largest_dense = 2000;        // rows of G^T G for which the condition number is computed

Points to_points(const Coordinates& nodes) {
  Points points(nodes.rows());
  for (Eigen::Index node = 0; node < nodes.rows(); ++node) points[node] = nodes.row(node);
  return points;
}

/// Shape of the net (eq. 3.9 with a surface, eq. 2.12 without) and what the constraints need to know of it.
NetState shape(NetSystem& system, const VecX& force_density, const Surface* surface) {
  NetState state;
  state.force_density = force_density;
  system.factorise(force_density);
  state.nodes = system.equilibrium(force_density);
  if (surface) {
    state.slope_x.resize(system.n_free());
    state.slope_y.resize(system.n_free());
    for (int i = 0; i < system.n_free(); ++i) {
      auto node = state.nodes.row(system.free_nodes()[i]);
      const Vec3 z = surface->height_and_slope(node.x(), node.y());
      node.z() = z[0];
      state.slope_x[i] = z[1];
      state.slope_y[i] = z[2];
    }
  }
  state.vectors = branch_vectors(system.net(), state.nodes);
  state.length = state.vectors.rowwise().norm();
  return state;
}

void check_targets(const Net& net, const VecX& target, const ForceDensityOptions& options) {
  if (target.size() != static_cast<Eigen::Index>(net.branches.size()))
    throw ModelError(
        fmt::format("the net has {} branches, but {} target tensions", net.branches.size(), target.size()));
  for (Eigen::Index b = 0; b < target.size(); ++b)
    if (!std::isnan(target[b]) && !(std::isfinite(target[b]) && target[b] > 0))
      throw ModelError(
          fmt::format("the target tension of branch {} must be positive, not {} N", b, target[b]));
  if (!(options.initial_force_density > 0))
    throw ModelError(
        fmt::format("the initial force density must be positive, not {} N/m", options.initial_force_density));
}

/// Newton's iteration on the force densities.
class TensionSearch {
 public:
  TensionSearch(const Net& net, const VecX& target, const Surface* surface,
                const ForceDensityOptions& options)
      : system_(net), target_(target), surface_(surface), options_(options) {
    largest_target_ = 0;
    for (const double T : target)
      if (!std::isnan(T)) largest_target_ = std::max(largest_target_, T);
  }

  ForceDensityResult run(const std::function<void(int, double)>& progress);

 private:
  struct Trial {
    NetState state;
    ConstraintRows rows;
    VecX missing;
  };

  Trial evaluate(const VecX& force_density);
  /// q + alpha dq with the first alpha of eq. (2.25) that satisfies (2.26); false if none does.
  bool take_step(const VecX& dq);
  ConstraintJacobian jacobian() const;
  double error() const { return now_.missing.size() > 0 ? now_.missing.cwiseAbs().maxCoeff() : 0.0; }
  void record_residual();
  void record_iteration();
  void finish(bool stuck);

  NetSystem system_;
  const VecX& target_;
  const Surface* surface_;
  const ForceDensityOptions& options_;
  double largest_target_;
  Trial now_;
  ForceDensityResult result_;
};

TensionSearch::Trial TensionSearch::evaluate(const VecX& force_density) {
  Trial trial;
  trial.state = shape(system_, force_density, surface_);
  add_tensions(trial.state, target_, trial.rows);
  trial.missing = trial.rows.missing();
  return trial;
}

bool TensionSearch::take_step(const VecX& dq) {
  for (int i = 1; i <= max_relaxations; ++i) {
    const double alpha = std::ldexp(1.0, -i * (i - 1));
    try {
      Trial trial = evaluate(now_.state.force_density + alpha * dq);
      if (!(trial.missing.norm() <= now_.missing.norm())) continue;
      now_ = std::move(trial);
      result_.step_relaxation.push_back(alpha);
      return true;
    } catch (const ModelError&) {
      // The step led to a singular net or off the surface: too long.
    }
  }
  return false;
}

ConstraintJacobian TensionSearch::jacobian() const {
  const bool z_follows_surface = surface_ && options_.jacobian == SurfaceJacobian::consistent;
  return {system_, now_.state, now_.rows, z_follows_surface};
}

void TensionSearch::record_residual() {
  result_.constraint_residual.push_back(error());
  result_.constraint_residual_norm.push_back(now_.missing.norm());
}

void TensionSearch::record_iteration() {
  ++result_.iterations;
  record_residual();
  Vec3 squares = Vec3::Zero();
  for (const int node : system_.free_nodes()) squares += now_.state.nodes.row(node).cwiseAbs2();
  result_.coordinate_norm.push_back(squares.cwiseSqrt());
}

ForceDensityResult TensionSearch::run(const std::function<void(int, double)>& progress) {
  now_ = evaluate(VecX::Constant(target_.size(), options_.initial_force_density));
  record_residual();
  bool stuck = false;
  while (!stuck && error() > options_.tolerance * largest_target_ &&
         result_.iterations < options_.max_iterations) {
    if (interrupt_requested()) throw Interrupted();
    const int max_inner = 2 * static_cast<int>(now_.missing.size() + target_.size());
    stuck = !take_step(least_squares(jacobian(), now_.missing, inner_tolerance, max_inner));
    if (stuck) break;
    record_iteration();
    if (progress) progress(result_.iterations, error());
  }
  finish(stuck);
  return std::move(result_);
}

void TensionSearch::finish(bool stuck) {
  const NetState& state = now_.state;
  result_.nodes = to_points(state.nodes);
  result_.force_density = state.force_density;
  result_.tension = state.force_density.cwiseProduct(state.length);
  const Coordinates force = nodal_forces(system_.net(), state.force_density, state.vectors);
  result_.residual_z = -force.col(2);
  const int directions = surface_ ? 2 : 3;
  for (const int node : system_.free_nodes())
    result_.out_of_balance = std::max(result_.out_of_balance, force.row(node).head(directions).norm());

  const double limit = options_.tolerance * largest_target_;
  const double largest_tension = result_.tension.size() > 0 ? result_.tension.cwiseAbs().maxCoeff() : 0.0;
  const double balance_limit = 1e-9 * largest_tension;
  if (error() > limit)
    result_.reason = fmt::format("{} {} iterations: largest tension error {:.3g} N > {:.3g} N",
                                 stuck ? "no step reduces the error after" : "stopped after",
                                 result_.iterations, error(), limit);
  else if (result_.out_of_balance > balance_limit)
    result_.reason = fmt::format("tensions are met, but the largest force out of balance {:.3g} N > {:.3g} N",
                                 result_.out_of_balance, balance_limit);
  else
    result_.reason = fmt::format("largest tension error {:.3g} N <= {:.3g} N", error(), limit);
  result_.converged = error() <= limit && result_.out_of_balance <= balance_limit;

  if (options_.estimate_condition && now_.missing.size() > 0 && now_.missing.size() <= largest_dense) {
    system_.factorise(state.force_density);  // a rejected step may have left another factor behind
    result_.condition_number = condition_number(jacobian());
  }
}

}  // namespace

Points solve_linear(const Net& net, const VecX& force_density, const Surface* surface) {
  check(net);
  if (force_density.size() != static_cast<Eigen::Index>(net.branches.size()))
    throw ModelError(fmt::format("the net has {} branches, but {} force densities", net.branches.size(),
                                 force_density.size()));
  NetSystem system(net);
  return to_points(shape(system, force_density, surface).nodes);
}

ForceDensityResult find_tensions(const Net& net, const VecX& target, const Surface* surface,
                                 const ForceDensityOptions& options,
                                 const std::function<void(int, double)>& progress) {
  check(net);
  check_targets(net, target, options);
  return TensionSearch(net, target, surface, options).run(progress);
}

}  // namespace tautline::formfinding
