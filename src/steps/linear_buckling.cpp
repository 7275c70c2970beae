#include "steps/linear_buckling.hpp"

#include <algorithm>

#include <fmt/format.h>

#include <tautline/analysis/stability.hpp>
#include <tautline/assembly/mechanism.hpp>
#include <tautline/core/error.hpp>

namespace tautline::steps {

namespace {

constexpr double small_deformation = 1e-5;  // of the elements, where the tangent is linear in the load

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Displacements and rotations for a unit of the load factor at a tangent that was factored.
la::Vector linear_response(assembly::System& system, analysis::Workspace& workspace) {
  la::Vector rate(system.layout()), response(system.layout());
  system.load_rate(rate);
  workspace.solver.solve(rate, response);
  system.add_drives(response);
  return response;
}

/// Factors from the eigenvalues nu of (K(h) - K(-h)) x = nu K x: lambda = -2 h / nu.
LinearBuckling factors_of(la::EigenPairs pairs, double h) {
  LinearBuckling result;
  for (std::size_t i = 0; i < pairs.values.size(); ++i) {
    result.factors.push_back(-2 * h / pairs.values[i]);
    result.residuals.push_back(pairs.residuals[i]);
    result.modes.push_back(std::move(pairs.vectors[i]));
  }
  return result;
}

}  // namespace

std::vector<std::string> scaled_loads(const Context& context,
                                      const std::optional<std::vector<std::string>>& given,
                                      const std::vector<std::string>& but) {
  if (given) return *given;
  std::vector<std::string> names;
  for (const auto& load : context.deck.loads)
    if (!has(context.acting_loads, load.name) && !has(but, load.name)) names.push_back(load.name);
  return names;
}

assembly::Boundary boundary_with(Context& context, const std::vector<std::string>& loads, double factor) {
  auto boundary = context.boundary({}, true);
  for (const auto& load : context.system().model().loads)
    if (has(loads, load.name)) boundary.loads.push_back(model::scaled(load, factor));
  return boundary;
}

double reference_load(Context& context, const std::vector<std::string>& loads) {
  double force = 0, moment = 0;
  for (const auto& load : context.system().model().loads) {
    if (!has(loads, load.name)) continue;
    force += static_cast<double>(load.nodes.size()) * load.force.norm();
    moment += static_cast<double>(load.nodes.size()) * load.moment.norm();
  }
  return force > 0 ? force : moment;
}

std::string come_to_rest(Context& context) {
  context.system().begin_stage(context.boundary({}, true));
  const auto path = follow(context, "at rest");
  return path.reached ? "" : "no equilibrium under what acts already: " + path.reason;
}

LinearBuckling linear_buckling(Context& context, const std::vector<std::string>& loads, int modes,
                               BucklingOptions::Sign sign) {
  auto& system = context.system();
  auto& workspace = context.workspace();
  LinearBuckling result;
  const auto rest = system.rest();
  system.begin_stage(boundary_with(context, loads));
  const int negative = analysis::count_negative(system, workspace);
  if (workspace.solver.inertia().null > 0 || !workspace.solver.failure().empty())
    if (const auto mechanism = assembly::find_mechanism(system, workspace))
      throw ModelError(fmt::format("linear buckling: {}", mechanism->text));
  if (negative > 0) {
    result.failure = fmt::format(
        "the present state is unstable already: {} negative pivot{}. Buckling is looked for from a stable "
        "state, so take away loads that act (loads of an equilibrium before)",
        negative, negative == 1 ? "" : "s");
  } else if (const auto response = linear_response(system, workspace);
             const double most = system.largest_deformation(response)) {
    const double h = small_deformation / most;
    system.tangent(workspace.tangent);
    const auto difference =
        system.stressed_tangent(response, h).plus(-1, system.stressed_tangent(response, -h));
    const auto which = sign == BucklingOptions::Sign::both       ? la::Extreme::both
                       : sign == BucklingOptions::Sign::positive ? la::Extreme::lowest
                                                                 : la::Extreme::highest;
    result = factors_of(la::solve_extreme(difference, workspace.tangent, modes, which), h);
  } else {
    result.failure = "the loads named move nothing, so that nothing can buckle under them";
  }
  system.restore(rest);
  return result;
}

}  // namespace tautline::steps
