#include "steps/form_methods.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/formfinding/constraints.hpp>
#include <tautline/formfinding/dynamic_relaxation.hpp>
#include <tautline/formfinding/force_density.hpp>
#include <tautline/formfinding/minimal_film.hpp>

#include "steps/form_verdict.hpp"
#include "steps/self_stress_form.hpp"

namespace tautline::steps {

namespace {

using formfinding::ConstrainedNet;
using formfinding::ConstraintKind;

/// Tension asked of each branch by its group [N], of bars also a compression < 0; NaN: none.
VecX target_tensions(const model::Model& structure, const FormNet& form) {
  VecX target(form.cables.size());
  for (std::size_t b = 0; b < form.cables.size(); ++b) {
    const double tension = structure.groups[structure.cables[form.cables[b]].group].target_tension;
    const bool asked = tension > 0 || (tension < 0 && form.is_bar(structure, static_cast<int>(b)));
    target[static_cast<int>(b)] = asked ? tension : std::nan("");
  }
  if (!(target.array() > 0).any())
    throw ModelError(
        fmt::format("form-finding: no group of the net states a tension; give one of {} a "
                    "`tension`, or use `method: linear`",
                    fmt::join(form.groups, ", ")));
  return target;
}

/// The net's own force densities, or else tension over length as drawn [N/m]; `otherwise` where there is
/// none.
VecX given_force_density(const FormNet& form, double otherwise) {
  if (form.force_density.size() > 0) return form.force_density;
  const VecX drawn = form.drawn_tension.cwiseQuotient(form.drawn_length);
  return (drawn.array() == 0).select(otherwise, drawn);
}

std::vector<bool> bars(const model::Model& structure, const FormNet& form) {
  std::vector<bool> bar;
  for (std::size_t b = 0; b < form.cables.size(); ++b)
    bar.push_back(form.is_bar(structure, static_cast<int>(b)));
  return bar;
}

VecX axial_stiffness(const model::Model& structure, const FormNet& form) {
  VecX stiffness(form.cables.size());
  for (std::size_t b = 0; b < form.cables.size(); ++b)
    stiffness[static_cast<int>(b)] = form.stiffness(structure, b);
  return stiffness;
}

/// What branches, loads and films leave at each node.
/// @param[in] film_stress  of each facet of the film [N/m]; may be empty
Points reactions(const FormNet& form, const Points& nodes, const VecX& tension,
                 const Points& film_stress = {}) {
  Points reaction(nodes.size(), Vec3::Zero());
  for (std::size_t i = 0; i < form.net.load.size(); ++i) reaction[i] = -form.net.load[i];
  for (std::size_t b = 0; b < form.net.branches.size(); ++b) {
    const auto& [i, j] = form.net.branches[b];
    const Vec3 pull = tension[static_cast<int>(b)] * (nodes[j] - nodes[i]).normalized();
    reaction[i] -= pull;
    reaction[j] += pull;
  }
  if (film_stress.empty()) return reaction;
  const Points pull = formfinding::film_forces(form.film, film_stress, nodes);
  for (std::size_t i = 0; i < reaction.size(); ++i) reaction[i] -= pull[i];
  return reaction;
}

/// Triangles of cloth that has one stress in all directions; a quadrilateral is two.
void add_cloth(const FormNet& form, ConstrainedNet& problem) {
  std::vector<double> stress;
  for (const auto& facet : form.film)
    for (const auto& triangle : facet.nodes.triangles()) {
      problem.triangles.push_back(triangle);
      stress.push_back(facet.stress[0]);
    }
  problem.surface_stress = Eigen::Map<const VecX>(stress.data(), static_cast<Eigen::Index>(stress.size()));
}

/// What every method's answer has.
template <class Found>
Form begin(const Found& found) {
  Form result;
  result.converged = found.converged;
  result.reason = found.reason;
  result.nodes = found.nodes;
  return result;
}

Json norms_json(const std::vector<Vec3>& norms) {
  Json list = Json::array();
  for (const auto& n : norms) list.push_back(Json::array({n.x(), n.y(), n.z()}));
  return list;
}

const char* name_of(formfinding::TensionMethod method) {
  using enum formfinding::TensionMethod;
  return method == position_newton ? "position_newton"
         : method == fixed_point   ? "fixed_point"
                                   : "smallest_norm";
}

Form find_by_tensions(const Context& context, const FormFindingOptions& options, const FormNet& form) {
  formfinding::ForceDensityOptions solver;
  solver.jacobian = options.jacobian;
  solver.initial_force_density = options.initial_force_density;
  solver.tolerance = options.tolerance.value_or(solver.tolerance);
  solver.max_iterations = options.max_iterations.value_or(solver.max_iterations);
  solver.estimate_condition = options.condition_number;
  using enum formfinding::TensionMethod;
  if (options.solver == FormSolver::smallest_norm) solver.method = step_of_smallest_norm;
  if (options.solver == FormSolver::position_newton) solver.method = position_newton;
  if (options.solver == FormSolver::fixed_point) solver.method = fixed_point;
  // The published Jacobian is for the published iteration.
  if (options.jacobian == formfinding::SurfaceJacobian::as_published) solver.method = step_of_smallest_norm;
  const auto found = formfinding::find_tensions(
      form.net, target_tensions(context.structure, form), form.surface, solver,
      [&](int iteration, double residual) {
        context.progress.update(
            fmt::format("{} | iteration {}, residual {:.2e} N", context.step_name, iteration, residual));
      });
  Form result = begin(found);
  result.tension = found.tension;
  result.reaction = reactions(form, found.nodes, found.tension);
  result.residual = found.constraint_residual;
  result.residual_name = found.method == step_of_smallest_norm ? "largest tension error [N]"
                                                               : "largest force out of balance [N]";
  result.details = {{"solver", name_of(found.method)},
                    {"iterations", found.iterations},
                    {"constraint_residual", found.constraint_residual}};
  result.details["coordinate_norm"] = norms_json(found.coordinate_norm);
  result.details["step_relaxation"] = found.step_relaxation;
  result.details["out_of_balance"] = found.out_of_balance;
  if (found.condition_number > 0) result.details["condition_number"] = found.condition_number;
  return result;
}

Form find_linear(const FormFindingOptions& options, const FormNet& form) {
  const auto found = formfinding::find_linear_form(
      form.net, given_force_density(form, options.initial_force_density), form.surface);
  Form result;
  result.converged = true;
  result.reason = "one linear solve";
  result.warnings = found.warnings;
  result.nodes = found.nodes;
  result.tension = found.tension;
  result.reaction = found.reaction;
  result.details = {{"iterations", 1},
                    {"constraint_residual", Json::array()},
                    {"coordinate_norm", Json::array()},
                    {"step_relaxation", Json::array()},
                    {"out_of_balance", found.out_of_balance}};
  if (found.negative_directions > 0) result.details["negative_directions"] = found.negative_directions;
  return result;
}

std::string names_text(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

/// In a net found for tensions, groups that state a force density keep it.
bool keeps_force_density(const Context& context, const FormFindingOptions& options,
                         const std::string& group) {
  return options.method == FormMethod::tension && context.deck.groups.at(group).force_density.has_value();
}

/// @throws ModelError if a cable shall push
void check_pushed(const model::Model& structure, const FormNet& form,
                  const formfinding::Constraint& constraint) {
  if (constraint.kind != ConstraintKind::tension && constraint.kind != ConstraintKind::force_density) return;
  for (std::size_t k = 0; k < constraint.members.size(); ++k)
    if (const double wanted = constraint.wanted(k, 0);
        wanted < 0 && !form.is_bar(structure, constraint.members[k]))
      throw ModelError(
          fmt::format("form-finding: {:.6g} asked of {} would put tension-only cables in compression; make "
                      "them bars",
                      wanted, constraint.name));
}

/// Soft bounds of force densities are demands.
void add_soft_bounds(const model::Model& structure, const FormFindingOptions& options, const FormNet& form,
                     std::vector<formfinding::Constraint>& list) {
  for (const auto& bounds : options.bounds)
    if (bounds.weight)
      list.push_back({ConstraintKind::force_density,
                      names_text(bounds.on),
                      form.branches_of(structure, bounds.on),
                      {},
                      bounds.min,
                      bounds.max,
                      *bounds.weight});
}

/// The demands of the deck, or of the groups' tensions where cloth stands beside method tension.
std::vector<formfinding::Constraint> demands(const model::Model& structure, const FormFindingOptions& options,
                                             const FormNet& form) {
  std::vector<formfinding::Constraint> list;
  for (const auto& wish : options.constraints) {
    list.push_back({wish.kind, names_text(wish.on),
                    wish.kind >= ConstraintKind::reaction_x ? form.nodes_of(structure, wish.on)
                                                            : form.branches_of(structure, wish.on),
                    wish.value, wish.min, wish.max, wish.weight});
    check_pushed(structure, form, list.back());
  }
  add_soft_bounds(structure, options, form, list);
  if (options.method != FormMethod::tension) return list;
  const VecX target = target_tensions(structure, form);
  for (const auto& group : form.groups) {
    formfinding::Constraint tension{ConstraintKind::tension, group, form.branches_of(structure, {group}), {}};
    if (tension.members.empty() || std::isnan(target[tension.members.front()])) continue;
    tension.value = {target[tension.members.front()]};
    list.push_back(std::move(tension));
  }
  return list;
}

void set_bounds(const model::Model& structure, const FormFindingOptions& options, const FormNet& form,
                ConstrainedNet& problem) {
  const auto n = static_cast<Eigen::Index>(form.cables.size());
  for (const auto& bounds : options.bounds) {
    if (bounds.weight) continue;
    for (const int b : form.branches_of(structure, bounds.on)) {
      if (bounds.min) {
        if (problem.lower.size() == 0) problem.lower = VecX::Constant(n, std::nan(""));
        problem.lower[b] = *bounds.min;
      }
      if (bounds.max) {
        if (problem.upper.size() == 0) problem.upper = VecX::Constant(n, std::nan(""));
        problem.upper[b] = *bounds.max;
      }
    }
  }
}

formfinding::ConstrainedOptions constrained_options(const FormFindingOptions& options) {
  formfinding::ConstrainedOptions solver;
  solver.jacobian = options.jacobian;
  solver.initial_force_density = options.initial_force_density;
  solver.tolerance = options.tolerance.value_or(solver.tolerance);
  solver.max_iterations = options.max_iterations.value_or(solver.max_iterations);
  solver.estimate_condition = options.condition_number;
  using enum formfinding::StepSolver;
  if (options.solver == FormSolver::dense) solver.step_solver = dense;
  if (options.solver == FormSolver::lsqr) solver.step_solver = lsqr;
  if (options.solver == FormSolver::position_newton) solver.step_solver = position_newton;
  return solver;
}

Form find_with_constraints(const Context& context, const FormFindingOptions& options, const FormNet& form) {
  const auto& structure = context.structure;
  ConstrainedNet problem{form.net,
                         form.surface,
                         demands(structure, options, form),
                         given_force_density(form, options.initial_force_density),
                         std::vector<bool>(form.cables.size(), false),
                         {},
                         {},
                         axial_stiffness(structure, form)};
  add_cloth(form, problem);
  if (options.method == FormMethod::linear || options.method == FormMethod::balanced)
    problem.held.assign(form.cables.size(), true);
  auto held = options.hold;
  for (const auto& group : form.groups)
    if (keeps_force_density(context, options, group)) held.push_back(group);
  for (const int b : form.branches_of(structure, held)) problem.held[b] = true;
  if (form.start_density.size() > 0)
    for (std::size_t b = 0; b < problem.held.size(); ++b)
      if (!problem.held[b])
        problem.force_density[static_cast<Eigen::Index>(b)] =
            form.start_density[static_cast<Eigen::Index>(b)];
  set_bounds(structure, options, form, problem);
  problem.pulls = bars(structure, form);
  problem.pulls.flip();
  const auto found =
      formfinding::find_form(problem, constrained_options(options), [&](int iteration, double residual) {
        context.progress.update(
            fmt::format("{} | iteration {}, residual {:.2e}", context.step_name, iteration, residual));
      });
  Form result = begin(found);
  if (!found.misses.empty()) result.reason = reason_of_misses(context, form, found);
  result.compromise = !found.converged && found.in_balance && !found.misses.empty();
  result.warnings = found.warnings;
  result.tension = found.tension;
  result.reaction = found.reaction;
  result.cloth_pull = found.cloth_force_density;
  result.residual = found.residual;
  result.residual_name = "largest scaled residual [-]";
  result.details = {{"solver", found.method},
                    {"iterations", found.iterations},
                    {"constraint_residual", found.residual},
                    {"coordinate_norm", norms_json(found.coordinate_norm)},
                    {"step_relaxation", found.step_relaxation},
                    {"out_of_balance", found.out_of_balance},
                    {"constraints", found.n_rows}};
  if (found.rank >= 0) result.details["rank"] = found.rank;
  if (found.condition_number > 0) {
    result.details["condition_number"] = found.condition_number;
    result.details["condition_is_lower_bound"] = found.condition_is_estimate;
  }
  if (found.cloth_iterations > 0) result.details["cloth_iterations"] = found.cloth_iterations;
  if (!found.worst.empty()) result.details.update(misses_json(context, form, found));
  return result;
}

Form find_elastic(const Context& context, const FormFindingOptions& options, const FormNet& form) {
  formfinding::ElasticOptions solver;
  solver.tolerance = options.tolerance.value_or(solver.tolerance);
  solver.max_iterations = options.max_iterations.value_or(solver.max_iterations);
  formfinding::ElasticNet net{form.net, axial_stiffness(context.structure, form), form.unstressed_length};
  net.carries_compression = bars(context.structure, form);
  const auto found = formfinding::find_elastic_equilibrium(net, solver);
  Form result = begin(found);
  result.tension = found.tension;
  result.unstressed_length = form.unstressed_length;
  result.reaction = reactions(form, found.nodes, found.tension);
  result.residual = found.residual;
  result.residual_name = "largest force out of balance [N]";
  result.details = {{"iterations", found.iterations},
                    {"force_residual", found.residual},
                    {"out_of_balance", found.out_of_balance},
                    {"slack", found.n_slack}};
  return result;
}

/// Ropes keep their unstressed lengths in dynamic relaxation, not the tensions that they were given by.
void note_changed_tensions(const model::Model& structure, const FormNet& form, const VecX& constant,
                           Form& result) {
  constexpr double noted = 0.05;  // of the tension given
  for (const auto& name : form.groups) {
    const double given =
        structure.groups[static_cast<std::size_t>(structure.find_group(name))].target_tension;
    if (given == 0) continue;
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const int b : form.branches_of(structure, {name}))
      if (std::isnan(constant[b])) {
        least = std::min(least, result.tension[b]);
        most = std::max(most, result.tension[b]);
      }
    if (least > most || std::max(std::abs(least - given), std::abs(most - given)) <= noted * std::abs(given))
      continue;
    result.warnings.push_back(
        fmt::format("\"{}\" was given {:.6g} N and carries {:.6g} to {:.6g} N in the shape found: elastic "
                    "cables keep the unstressed length of the drawing; `constant_tension: [{}]` keeps the "
                    "tension",
                    name, given, least, most, name));
  }
}

Form relax(const Context& context, const FormFindingOptions& options, const FormNet& form) {
  auto solver = options.relaxation;
  solver.tolerance = options.tolerance.value_or(solver.tolerance);
  solver.max_iterations = options.max_iterations.value_or(solver.max_iterations);
  const auto& structure = context.structure;
  formfinding::ElasticNet net{form.net, axial_stiffness(structure, form), form.unstressed_length,
                              VecX::Constant(static_cast<Eigen::Index>(form.cables.size()), std::nan("")),
                              form.film};
  net.carries_compression = bars(structure, form);
  VecX lengths = net.unstressed_length;
  const auto constant = form.branches_of(structure, options.constant_tension);
  for (const int b : constant) net.tension[b] = form.drawn_tension[b];
  const auto found = formfinding::relax(net, solver);
  for (const int b : constant) {
    const auto [i, j] = form.net.branches[b];
    const double length = (found.nodes[j] - found.nodes[i]).norm();
    lengths[b] = length / (1 + found.tension[b] / net.axial_stiffness[b]);
  }
  Form result = begin(found);
  result.tension = found.tension;
  result.unstressed_length = lengths;
  result.film_stress = found.stress;
  result.reaction = reactions(form, found.nodes, found.tension, result.film_stress);
  if (found.converged) note_changed_tensions(structure, form, net.tension, result);
  result.details = {{"iterations", found.iterations}, {"out_of_balance", found.out_of_balance}};
  const bool viscous = solver.damping == formfinding::Damping::viscous;
  if (viscous) result.details["pilot_iterations"] = found.pilot_iterations;
  if (viscous) result.details["period"] = found.period;
  if (!viscous) result.details["kinetic_peaks"] = found.n_peaks;
  return result;
}

Form find_film(const Context& context, const FormFindingOptions& options, const FormNet& form) {
  formfinding::MinimalFilmOptions solver;
  solver.tolerance = options.tolerance.value_or(solver.tolerance);
  solver.max_iterations = options.max_iterations.value_or(solver.max_iterations);
  const auto& structure = context.structure;
  VecX tension(form.cables.size());
  for (std::size_t b = 0; b < form.cables.size(); ++b) {
    const double target = structure.groups[structure.cables[form.cables[b]].group].target_tension;
    tension[static_cast<int>(b)] = target > 0 ? target : std::nan("");
  }
  const auto found = formfinding::find_minimal_film(
      {form.net, form.film, tension, given_force_density(form, options.initial_force_density)}, solver,
      [&](int iteration, double residual) {
        context.progress.update(
            fmt::format("{} | iteration {}, residual {:.2e} N", context.step_name, iteration, residual));
      });
  Form result = begin(found);
  result.tension = found.cable_tension;
  result.film_stress = found.stress;
  result.reaction = reactions(form, found.nodes, found.cable_tension, result.film_stress);
  result.residual = found.residual;
  result.residual_name = "largest force out of balance [N]";
  result.details = {{"iterations", found.iterations},
                    {"force_residual", found.residual},
                    {"out_of_balance", found.out_of_balance},
                    {"film_area", found.area}};
  return result;
}

}  // namespace

namespace {

Form find_by_method(const Context& context, const FormFindingOptions& options, const FormNet& form) {
  switch (options.method) {
    case FormMethod::linear:
    case FormMethod::balanced:
      return form.film.empty() ? find_linear(options, form) : find_with_constraints(context, options, form);
    case FormMethod::constraints:
      return find_with_constraints(context, options, form);
    case FormMethod::elastic:
      return find_elastic(context, options, form);
    case FormMethod::dynamic_relaxation:
      return relax(context, options, form);
    case FormMethod::film:
      return find_film(context, options, form);
    case FormMethod::self_stress:
      return find_self_stressed(context, options, form);
    case FormMethod::tension:
      break;
  }
  const bool mixed = std::any_of(form.groups.begin(), form.groups.end(), [&](const std::string& group) {
    return keeps_force_density(context, options, group);
  });
  const bool pressed = (target_tensions(context.structure, form).array() < 0).any();
  if (!form.film.empty() || mixed || pressed) return find_with_constraints(context, options, form);
  Form found = find_by_tensions(context, options, form);
  // Tensions that no net can have in full: the one nearest to them.
  const int most = options.max_iterations.value_or(formfinding::ForceDensityOptions{}.max_iterations);
  if (found.converged || options.solver == FormSolver::position_newton ||
      found.details["iterations"].get<int>() >= most)
    return found;
  Form nearest = find_with_constraints(context, options, form);
  return nearest.converged || nearest.compromise ? nearest : found;
}

}  // namespace

Points net_reactions(const FormNet& form, const Points& nodes, const VecX& tension) {
  return reactions(form, nodes, tension);
}

Form find_form(const Context& context, const FormFindingOptions& options, const FormNet& form) {
  try {
    Form found = find_by_method(context, options, form);
    refuse_collapsed(context.structure, form, found);
    return found;
  } catch (const formfinding::NetError& error) {
    throw named(context, form, error);
  }
}

}  // namespace tautline::steps
