#include <tautline/formfinding/force_density.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <formfinding/balance.hpp>
#include <formfinding/constraint_search.hpp>
#include <formfinding/position_search.hpp>
#include <tautline/core/error.hpp>
#include <tautline/formfinding/node_error.hpp>
#include <utility>

namespace tautline::formfinding {

namespace {

constexpr int largest_dense = 2000;  // rows of G^T G for which the condition number is computed
constexpr int many_branches = 2000;  // from here on the positions are the unknowns where they can be
constexpr double balance_limit =
    1e-9;  // of the largest force out of balance, relative to the largest tension
constexpr int most_by_densities = 20000;    // branches; more take hours
constexpr double position_balance = 1e-10;  // likewise, aimed at where the positions are the unknowns

void check_targets(const Net& net, const VecX& target, const ForceDensityOptions& options) {
  if (target.size() != static_cast<Eigen::Index>(net.branches.size()))
    throw ModelError(
        fmt::format("the net has {} branches, but {} target tensions", net.branches.size(), target.size()));
  for (Eigen::Index b = 0; b < target.size(); ++b)
    if (!std::isnan(target[b]) && !(std::isfinite(target[b]) && target[b] > 0))
      throw NetError({"the target tension of ", branch_word(static_cast<int>(b)),
                      fmt::format(" must be positive, not {} N", target[b])});
  if (!(options.initial_force_density > 0))
    throw ModelError(
        fmt::format("the initial force density must be positive, not {} N/m", options.initial_force_density));
  const bool on_positions =
      options.method == TensionMethod::position_newton || options.method == TensionMethod::fixed_point;
  if (on_positions && target.array().isNaN().any())
    throw ModelError("with the positions as unknowns every branch needs a target tension");
}

double largest_target(const VecX& target) {
  double largest = 0;
  for (const double T : target)
    if (!std::isnan(T)) largest = std::max(largest, T);
  return largest;
}

void take_shape(const NetSystem& system, const NetState& state, ForceDensityResult& result) {
  result.nodes = to_points(state.nodes);
  result.force_density = state.force_density;
  result.tension = state.force_density.cwiseProduct(state.length);
  const Balance at_nodes = balance(system, state);
  result.out_of_balance = at_nodes.out_of_balance;
  result.residual_z.resize(static_cast<Eigen::Index>(at_nodes.reaction.size()));
  for (std::size_t i = 0; i < at_nodes.reaction.size(); ++i)
    result.residual_z[static_cast<Eigen::Index>(i)] = at_nodes.reaction[i].z();
}

/// Sets `converged` and `reason`. @param[in] error  largest tension error [N]
void judge(double error, double limit, bool stuck, ForceDensityResult& result) {
  const double largest_tension = result.tension.size() > 0 ? result.tension.cwiseAbs().maxCoeff() : 0.0;
  const double balanced = balance_limit * largest_tension;
  if (error > limit)
    result.reason = fmt::format("{} {} iterations: largest tension error {:.3g} N > {:.3g} N",
                                stuck ? "no step reduces the error after" : "stopped after",
                                result.iterations, error, limit);
  else if (result.out_of_balance > balanced)
    result.reason = fmt::format("tensions are met, but the largest force out of balance {:.3g} N > {:.3g} N",
                                result.out_of_balance, balanced);
  else
    result.reason = fmt::format("largest tension error {:.3g} N <= {:.3g} N", error, limit);
  result.converged = error <= limit && result.out_of_balance <= balanced;
}

ForceDensityResult search_force_densities(NetSystem& system, const VecX& target,
                                          const ForceDensityOptions& options,
                                          const std::function<void(int, double)>& progress) {
  ForceDensityResult result;
  SearchSettings settings;
  const double limit = settings.tolerance = options.tolerance * largest_target(target);
  settings.max_iterations = options.max_iterations;
  settings.z_follows_surface = options.jacobian == SurfaceJacobian::consistent;
  ConstraintSearch search(
      system,
      [&](const NetState& state) {
        ConstraintRows rows;
        add_tensions(state, target, rows);
        // The first state is recorded where it is made: before the first iteration.
        if (result.constraint_residual.empty()) {
          result.constraint_residual.push_back(rows.missing().lpNorm<Eigen::Infinity>());
          result.constraint_residual_norm.push_back(rows.missing().norm());
        }
        return rows;
      },
      settings);
  search.run(VecX::Constant(target.size(), options.initial_force_density), [&] {
    result.constraint_residual.push_back(search.error());
    result.constraint_residual_norm.push_back(search.missing().norm());
    result.coordinate_norm.push_back(coordinate_norm(system, search.state()));
    if (progress) progress(search.iterations(), search.error());
  });
  result.iterations = search.iterations();
  result.inner_iterations = search.inner_iterations();
  result.step_relaxation = search.relaxation();
  take_shape(system, search.state(), result);
  judge(search.error(), limit, search.stuck(), result);
  const auto n_rows = search.missing().size();
  if (options.estimate_condition && n_rows > 0 && n_rows <= largest_dense)
    result.condition_number = condition_number(search.jacobian());
  return result;
}

ForceDensityResult search_positions(NetSystem& system, const VecX& target, const ForceDensityOptions& options,
                                    const std::function<void(int, double)>& progress) {
  ForceDensityResult result;
  const double largest = largest_target(target);
  const double limit = std::max(position_balance, options.tolerance) * largest;
  const VecX start = VecX::Constant(target.size(), options.initial_force_density);
  PositionResult found =
      options.method == TensionMethod::fixed_point
          ? find_fixed_point(system, target, start, limit, options.max_iterations, progress)
          : find_positions(system, target, start, limit, options.max_iterations, progress);
  result.iterations = found.iterations;
  result.inner_iterations = found.inner_iterations;
  result.constraint_residual = result.constraint_residual_norm = found.residual;
  result.step_relaxation = std::move(found.relaxation);
  result.coordinate_norm.assign(found.iterations, coordinate_norm(system, found.state));
  take_shape(system, found.state, result);
  result.converged = found.converged;
  result.reason = found.reason(limit);
  return result;
}

/// The Jacobian and the condition number belong to the step of smallest norm.
TensionMethod choose_method(const Net& net, const VecX& target, const Surface* surface,
                            const ForceDensityOptions& options) {
  if (options.method != TensionMethod::automatic) return options.method;
  const bool well_conditioned = surface != nullptr && static_cast<int>(net.branches.size()) < many_branches;
  const bool on_positions = !well_conditioned && !target.array().isNaN().any() &&
                            options.jacobian == SurfaceJacobian::consistent && !options.estimate_condition;
  return on_positions ? TensionMethod::position_newton : TensionMethod::step_of_smallest_norm;
}

}  // namespace

LinearForm find_linear_form(const Net& net, const VecX& force_density, const Surface* surface) {
  check(net, surface);
  if (force_density.size() != static_cast<Eigen::Index>(net.branches.size()))
    throw ModelError(fmt::format("the net has {} branches, but {} force densities", net.branches.size(),
                                 force_density.size()));
  NetSystem system(net, surface);
  system.factorise(force_density);
  const NetState state = system.equilibrium(force_density);
  LinearForm form;
  form.nodes = to_points(state.nodes);
  form.length = state.length;
  form.tension = state.force_density.cwiseProduct(state.length);
  Balance at_nodes = balance(system, state);
  form.reaction = std::move(at_nodes.reaction);
  form.out_of_balance = at_nodes.out_of_balance;
  form.negative_directions = system.negative_pivots();
  form.warnings = stability_warnings(system, state);
  return form;
}

Points solve_linear(const Net& net, const VecX& force_density, const Surface* surface) {
  return find_linear_form(net, force_density, surface).nodes;
}

ForceDensityResult find_tensions(const Net& net, const VecX& target, const Surface* surface,
                                 const ForceDensityOptions& options,
                                 const std::function<void(int, double)>& progress) {
  check(net, surface);
  check_targets(net, target, options);
  NetSystem system(net, surface);
  ForceDensityOptions chosen = options;
  chosen.method = choose_method(net, target, surface, options);
  ForceDensityResult result;
  if (chosen.method != TensionMethod::step_of_smallest_norm) {
    result = search_positions(system, target, chosen, progress);
    result.method = chosen.method;
    // Where the positions are not determined or Newton's method strays, the published method has the last
    // word.
    const bool too_large = static_cast<int>(net.branches.size()) > most_by_densities;
    if (result.converged || options.method != TensionMethod::automatic || too_large) return result;
  }
  return search_force_densities(system, target, options, progress);
}

}  // namespace tautline::formfinding
