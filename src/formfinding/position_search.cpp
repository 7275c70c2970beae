#include <formfinding/position_search.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tautline/core/anderson.hpp>
#include <formfinding/gmres.hpp>
#include <tautline/core/error.hpp>
#include <tautline/core/interrupt.hpp>
#include <utility>

namespace tautline::formfinding {

namespace {

constexpr int n_sweeps = 2;         // q <- T/L before Newton's method
constexpr int max_inner = 60;       // products in one Newton step; each keeps a vector of 3 n_free numbers
constexpr int refactor_after = 30;  // products in one step after which the factors are renewed
constexpr int max_halvings = 8;
constexpr int most_strays = 10;  // of Newton's steps, after each of which sweeps come nearer
constexpr int sweeps_after_stray = 3;
constexpr int anderson_depth = 8;

VecX flat(const Coordinates& values) {
  return Eigen::Map<const VecX>(values.data(), values.size());
}

Coordinates shaped(const VecX& values) {
  return Eigen::Map<const Coordinates>(values.data(), values.size() / 3, 3);
}

double largest_row(const Coordinates& values) {
  return values.rows() > 0 ? values.rowwise().norm().maxCoeff() : 0.0;
}

class PositionSearch {
 public:
  PositionSearch(NetSystem& system, const VecX& tension, const VecX& force_density)
      : system_(system), tension_(tension), density_(force_density) {}

  /// q = T/L in this shape; a branch without length keeps what it has.
  VecX force_density(const NetState& state) const {
    VecX q = density_;
    for (Eigen::Index b = 0; b < q.size(); ++b)
      if (!std::isnan(tension_[b]))
        q[b] = state.length[b] > 0 ? tension_[b] / state.length[b] : state.force_density[b];
    return q;
  }

  /// One step of the fixed point: equilibrium for q = T/L of the shape before.
  NetState sweep(const NetState& state) {
    const VecX q = force_density(state);
    system_.factorise(q);
    return with_tensions(system_.equilibrium(q));
  }

  NetState with_tensions(NetState state) const {
    state.force_density = force_density(state);
    return state;
  }

  /// Forces on the free nodes along the directions in equilibrium [N].
  Coordinates out_of_balance(const NetState& state) const {
    const Coordinates force = nodal_forces(system_.net(), state.force_density, state.vectors);
    return system_.unbalanced(force(system_.free_nodes(), Eigen::all));
  }

  /// Force lost when the nodes move by the response to `y`; the derivative of out_of_balance.
  VecX product(const NetState& state, const VecX& y) const {
    Coordinates change = system_.along_branches(system_.respond(state, shaped(y)));
    for (Eigen::Index b = 0; b < change.rows(); ++b) {
      if (!std::isnan(tension_[b])) {
        const Eigen::RowVector3d axis = state.vectors.row(b) / state.length[b];
        change.row(b) -= change.row(b).dot(axis) * axis;
      }
      change.row(b) *= state.force_density[b];
    }
    return flat(system_.unbalanced(system_.at_free_nodes(change)));
  }

  NetState moved(const NetState& state, const Coordinates& dx) const {
    Coordinates nodes = state.nodes;
    for (int i = 0; i < system_.n_free(); ++i) nodes.row(system_.free_nodes()[i]) += dx.row(i);
    return with_tensions(system_.state(state.force_density, std::move(nodes)));
  }

 private:
  NetSystem& system_;
  const VecX& tension_;
  const VecX& density_;
};

/// Moves by dx, or by a half, a quarter ... of it until the norm of the force out of balance falls.
bool take_step(const PositionSearch& search, NetState& state, Coordinates& force, const Coordinates& dx,
               std::vector<double>& relaxation) {
  for (int i = 0; i <= max_halvings; ++i) {
    const double alpha = std::ldexp(1.0, -i);
    try {
      NetState trial = search.moved(state, alpha * dx);
      Coordinates left = search.out_of_balance(trial);
      if (!(left.norm() < force.norm())) continue;
      state = std::move(trial);
      force = std::move(left);
      relaxation.push_back(alpha);
      return true;
    } catch (const ModelError&) {
      // The step left the surface: too long.
    }
  }
  return false;
}

}  // namespace

std::string PositionResult::reason(double limit) const {
  const double last = residual.back();
  if (converged) return fmt::format("largest force out of balance {:.3g} N <= {:.3g} N", last, limit);
  return fmt::format(
      "{} {} iterations: largest force out of balance {:.3g} N > {:.3g} N; more tension in edge "
      "cables, less stress in a film, or a start nearer to the shape may help",
      collapsed ? "nodes ran together or triangles turned over after" : "stopped after", iterations, last,
      limit);
}

PositionResult find_positions(NetSystem& system, const VecX& tension, const VecX& force_density,
                              double tolerance, int max_iterations,
                              const std::function<void(int, double)>& progress) {
  PositionResult result;
  PositionSearch search(system, tension, force_density);
  system.factorise(force_density);
  NetState& state = result.state;
  state = search.with_tensions(system.equilibrium(force_density));
  for (int k = 0; k < n_sweeps; ++k) state = search.sweep(state);
  result.factorisations = 1 + n_sweeps;
  Coordinates force = search.out_of_balance(state);
  result.residual.push_back(largest_row(force));
  double forcing = 0.1;
  int strays = 0;
  while (result.residual.back() > tolerance && result.iterations < max_iterations) {
    if (interrupt_requested()) throw Interrupted();
    const double before = force.norm();
    const double needed = 0.3 * tolerance / result.residual.back();
    const auto step = gmres([&](const VecX& y) { return search.product(state, y); }, flat(force),
                            std::max(forcing, needed), max_inner);
    result.inner_iterations += step.iterations;
    if (!take_step(search, state, force, system.respond(state, shaped(step.x)), result.relaxation)) {
      if (++strays > most_strays) break;
      for (int k = 0; k < sweeps_after_stray; ++k) state = search.sweep(state);
      result.factorisations += sweeps_after_stray;
      force = search.out_of_balance(state);
      result.relaxation.push_back(0);
    }
    ++result.iterations;
    result.residual.push_back(largest_row(force));
    if (progress) progress(result.iterations, result.residual.back());
    // Eisenstat & Walker (1996): as accurate as the last step was successful.
    forcing = std::clamp(0.9 * std::pow(force.norm() / before, 2), 1e-6, 0.1);
    if (step.iterations < refactor_after || result.residual.back() <= tolerance) continue;
    system.factorise(state.force_density);
    ++result.factorisations;
  }
  result.converged = result.residual.back() <= tolerance;
  return result;
}

PositionResult find_fixed_point(NetSystem& system, const DensityOfShape& density, const NetState& start,
                                double tolerance, int max_iterations, const PlaceRule& rule,
                                const std::function<void(int, double)>& progress) {
  PositionResult result;
  const auto free_part = [&](const NetState& s) {
    return Coordinates(s.nodes(system.free_nodes(), Eigen::all));
  };
  const auto with_density = [&](NetState s) {
    s.force_density = density(s);
    return s;
  };
  const auto out_of_balance = [&](const NetState& s) {
    const Coordinates force = nodal_forces(system.net(), s.force_density, s.vectors);
    Coordinates left = force(system.free_nodes(), Eigen::all);
    if (rule.force) rule.force(s, left);
    return system.unbalanced(left);
  };
  NetState& state = result.state;
  state = with_density(start);
  Anderson anderson(anderson_depth);
  Coordinates force = out_of_balance(state);
  result.residual.push_back(largest_row(force));
  while (result.residual.back() > tolerance && result.iterations < max_iterations) {
    if (interrupt_requested()) throw Interrupted();
    try {
      system.factorise(state.force_density);
    } catch (const ModelError&) {
      result.collapsed = true;
      break;
    }
    // The equilibrium for these densities lies at the response to what is out of balance.
    Coordinates dx = system.respond(state, force);
    if (rule.step) rule.step(state, force, dx);
    const VecX x = flat(free_part(state)), step = flat(dx);
    const VecX mixed = anderson.next(x, x + step) - x;
    const auto moved = [&](const VecX& change) {
      Coordinates nodes = state.nodes;
      for (int k = 0; k < system.n_free(); ++k)
        nodes.row(system.free_nodes()[k]) += change.segment<3>(3 * k).transpose();
      return with_density(system.state(state.force_density, std::move(nodes)));
    };
    NetState next = moved(mixed);
    Coordinates left = out_of_balance(next);
    if (!(left.norm() <
          2 * force.norm())) {  // the acceleration led astray: the plain step, and forget the past
      next = moved(step);
      left = out_of_balance(next);
      anderson.restart();
    }
    state = std::move(next);
    force = std::move(left);
    ++result.iterations;
    ++result.factorisations;
    result.relaxation.push_back(1);
    result.residual.push_back(largest_row(force));
    if (progress) progress(result.iterations, result.residual.back());
  }
  result.converged = result.residual.back() <= tolerance;
  return result;
}

PositionResult find_fixed_point(NetSystem& system, const VecX& tension, const VecX& force_density,
                                double tolerance, int max_iterations,
                                const std::function<void(int, double)>& progress) {
  const PositionSearch search(system, tension, force_density);
  system.factorise(force_density);
  return find_fixed_point(
      system, [&](const NetState& state) { return search.force_density(state); },
      system.equilibrium(force_density), tolerance, max_iterations, {}, progress);
}

}  // namespace tautline::formfinding
