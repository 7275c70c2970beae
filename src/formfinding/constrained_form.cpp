#include <tautline/formfinding/constraints.hpp>

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <formfinding/balance.hpp>
#include <formfinding/cloth_form.hpp>
#include <formfinding/constraint_search.hpp>
#include <formfinding/position_search.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <tautline/core/error.hpp>
#include <utility>

namespace tautline::formfinding {

namespace {

constexpr int dense_rows = 300;      // up to here the step comes from a dense decomposition
constexpr int largest_dense = 2000;  // rows for which rank and condition are computed on request
constexpr int many_branches = 2000;  // from here on the positions are the unknowns where they can be
constexpr double balance_limit =
    1e-9;                             // of the largest force out of balance, relative to the largest tension
constexpr double rank_limit = 1e-12;  // singular values below this part of the largest count as zero

bool is_reaction(ConstraintKind kind) {
  return kind >= ConstraintKind::reaction_x;
}

const char* word(ConstraintKind kind) {
  constexpr const char* words[] = {"tension",    "length",     "unstressed length", "equal tension",
                                   "reaction x", "reaction y", "reaction z"};
  return words[static_cast<int>(kind)];
}

std::string describe(const Constraint& constraint) {
  return fmt::format("{} of {}", word(constraint.kind), constraint.name);
}

void check_members(const ConstrainedNet& problem, const Constraint& constraint) {
  const bool nodes = is_reaction(constraint.kind);
  const std::size_t count = nodes ? problem.net.nodes.size() : problem.net.branches.size();
  if (constraint.members.empty())
    throw ModelError(fmt::format("{} names no {}", describe(constraint), nodes ? "node" : "cable"));
  for (const int member : constraint.members)
    if (member < 0 || member >= static_cast<int>(count))
      throw ModelError(fmt::format("{} names {} {}, but the net has {}", describe(constraint),
                                   nodes ? "node" : "branch", member, count));
  const std::size_t values = constraint.value.size();
  if (constraint.kind == ConstraintKind::equal_tension ? values != 0
                                                       : values != 1 && values != constraint.members.size())
    throw ModelError(fmt::format("{} has {} members, but {} values", describe(constraint),
                                 constraint.members.size(), values));
  for (const double value : constraint.value)
    if (!std::isfinite(value) || (!nodes && value <= 0))
      throw ModelError(
          fmt::format("{} must be {}, not {}", describe(constraint), nodes ? "a number" : "positive", value));
}

/// A length between two fixed nodes is no free choice.
void check_fixed_length(const ConstrainedNet& problem, const Constraint& constraint) {
  if (constraint.kind != ConstraintKind::length) return;
  for (std::size_t k = 0; k < constraint.members.size(); ++k) {
    const auto [i, j] = problem.net.branches[constraint.members[k]];
    if (!problem.net.fixed[i] || !problem.net.fixed[j]) continue;
    const double wanted = constraint.value[constraint.value.size() == 1 ? 0 : k];
    const double distance = (problem.net.nodes[j] - problem.net.nodes[i]).norm();
    if (std::abs(wanted - distance) > 1e-9 * distance)
      throw ModelError(
          fmt::format("{}: branch {} shall be {:.6g} m long, but joins the fixed nodes {} and {}, which "
                      "are {:.6g} m apart",
                      describe(constraint), constraint.members[k], wanted, i, j, distance));
  }
}

void check_reaction(const ConstrainedNet& problem, const Constraint& constraint) {
  if (!is_reaction(constraint.kind)) return;
  for (const int node : constraint.members) {
    const auto guided = std::any_of(problem.net.guides.begin(), problem.net.guides.end(),
                                    [&](const Guide& guide) { return guide.node == node; });
    const bool tied = problem.surface && constraint.kind == ConstraintKind::reaction_z &&
                      (problem.net.on_surface.empty() || problem.net.on_surface[node]);
    if (!problem.net.fixed[node] && !tied && !guided)
      throw ModelError(fmt::format("{}: node {} is free in that direction, where nothing reacts",
                                   describe(constraint), node));
  }
}

/// Two demands of one kind on one branch or node.
void check_repeated(const ConstrainedNet& problem) {
  std::map<std::pair<ConstraintKind, int>, const Constraint*> seen;
  for (const Constraint& constraint : problem.constraints) {
    if (constraint.kind == ConstraintKind::equal_tension) continue;
    for (const int member : constraint.members) {
      const auto [it, first] = seen.try_emplace({constraint.kind, member}, &constraint);
      if (!first)
        throw ModelError(fmt::format("{} and {} both set the {} of {} {}", describe(*it->second),
                                     describe(constraint), word(constraint.kind),
                                     is_reaction(constraint.kind) ? "node" : "branch", member));
    }
  }
}

void check_vector(const VecX& values, const ConstrainedNet& problem, const char* what) {
  if (values.size() != 0 && values.size() != static_cast<Eigen::Index>(problem.net.branches.size()))
    throw ModelError(
        fmt::format("the net has {} branches, but {} {}", problem.net.branches.size(), values.size(), what));
}

void check_branch_data(const ConstrainedNet& problem, const ConstrainedOptions& options) {
  check_vector(problem.force_density, problem, "force densities");
  check_vector(problem.lower, problem, "lower bounds");
  check_vector(problem.upper, problem, "upper bounds");
  check_vector(problem.axial_stiffness, problem, "axial stiffnesses");
  if (!problem.held.empty() && problem.held.size() != problem.net.branches.size())
    throw ModelError(fmt::format("the net has {} branches, but {} are held or not",
                                 problem.net.branches.size(), problem.held.size()));
  if (!(options.initial_force_density > 0))
    throw ModelError(
        fmt::format("the initial force density must be positive, not {} N/m", options.initial_force_density));
  for (Eigen::Index b = 0; b < std::min(problem.lower.size(), problem.upper.size()); ++b)
    if (problem.lower[b] > problem.upper[b])
      throw ModelError(fmt::format("branch {}: the lower bound {:.6g} N/m is above the upper one {:.6g} N/m",
                                   b, problem.lower[b], problem.upper[b]));
}

void check_problem(const ConstrainedNet& problem, const ConstrainedOptions& options) {
  check(problem.net, problem.surface);
  check_branch_data(problem, options);
  for (const Constraint& constraint : problem.constraints) {
    check_members(problem, constraint);
    check_fixed_length(problem, constraint);
    check_reaction(problem, constraint);
    if (constraint.kind != ConstraintKind::unstressed_length) continue;
    for (const int b : constraint.members)
      if (problem.axial_stiffness.size() == 0 || !(problem.axial_stiffness[b] > 0))
        throw ModelError(fmt::format("{} needs the axial stiffness of branch {}", describe(constraint), b));
  }
  check_repeated(problem);
}

/// By which forces without a target of their own are scaled: the largest one asked for, else the largest
/// tension at the start [N].
double force_scale(const ConstrainedNet& problem, const NetState& start) {
  double scale = 0;
  for (const Constraint& constraint : problem.constraints)
    if (constraint.kind == ConstraintKind::tension || is_reaction(constraint.kind))
      for (const double value : constraint.value) scale = std::max(scale, std::abs(value));
  if (scale > 0) return scale;
  scale = start.force_density.cwiseProduct(start.length).lpNorm<Eigen::Infinity>();
  return scale > 0 ? scale : 1;
}

/// Tension of every branch that has one prescribed, NaN elsewhere; empty if anything else is asked for, or if
/// some branch is neither prescribed nor held.
VecX tensions_only(const ConstrainedNet& problem) {
  const auto m = static_cast<Eigen::Index>(problem.net.branches.size());
  VecX tension = VecX::Constant(m, std::numeric_limits<double>::quiet_NaN());
  for (const Constraint& constraint : problem.constraints) {
    if (constraint.kind != ConstraintKind::tension) return {};
    for (std::size_t k = 0; k < constraint.members.size(); ++k)
      tension[constraint.members[k]] = constraint.value[constraint.value.size() == 1 ? 0 : k];
  }
  for (Eigen::Index b = 0; b < m; ++b) {
    const bool held = !problem.held.empty() && problem.held[b];
    if (held == !std::isnan(tension[b])) return {};
  }
  const bool bounded = problem.lower.size() > 0 || problem.upper.size() > 0;
  return bounded || problem.constraints.empty() ? VecX() : tension;
}

class FormSearch {
 public:
  FormSearch(const ConstrainedNet& problem, const ConstrainedOptions& options)
      : problem_(problem), options_(options), system_(problem.net, problem.surface) {
    start_ = problem.force_density.size() > 0
                 ? problem.force_density
                 : VecX::Constant(static_cast<Eigen::Index>(problem.net.branches.size()),
                                  options.initial_force_density);
  }

  ConstrainedResult run();

 private:
  bool try_positions();
  void search();
  ConstraintRows rows(const NetState& state) const;
  void take_shape(const NetState& state);
  void judge(ConstraintSearch& search);
  void list_worst(const ConstraintRows& rows, const VecX& missing);
  void find_rank(ConstraintSearch& search);
  std::string short_path() const;

  const ConstrainedNet& problem_;
  const ConstrainedOptions& options_;
  NetSystem system_;
  VecX start_;
  double force_scale_ = 1;
  ConstrainedResult result_;
};

ConstraintRows FormSearch::rows(const NetState& state) const {
  ConstraintRows rows;
  for (const Constraint& constraint : problem_.constraints)
    add_constraint(system_, state, constraint, problem_.axial_stiffness, force_scale_, rows);
  return rows;
}

void FormSearch::take_shape(const NetState& state) {
  result_.nodes = to_points(state.nodes);
  result_.force_density = state.force_density;
  result_.length = state.length;
  result_.tension = state.force_density.cwiseProduct(state.length);
  if (const VecX& EA = problem_.axial_stiffness; EA.size() > 0)
    result_.unstressed_length = state.length.cwiseProduct(EA).cwiseQuotient(EA + result_.tension);
  Balance at_nodes = balance(system_, state);
  result_.reaction = std::move(at_nodes.reaction);
  result_.out_of_balance = at_nodes.out_of_balance;
  system_.factorise(state.force_density);
  result_.warnings = stability_warnings(system_, state);
}

bool FormSearch::try_positions() {
  const bool asked = options_.step_solver == StepSolver::position_newton;
  if (!asked && options_.step_solver != StepSolver::automatic) return false;
  const bool suits = static_cast<int>(problem_.net.branches.size()) >= many_branches &&
                     !options_.estimate_condition && options_.jacobian == SurfaceJacobian::consistent;
  if (!asked && !suits) return false;
  const VecX tension = tensions_only(problem_);
  if (tension.size() == 0) {
    if (asked)
      throw ModelError(
          "with the positions as unknowns every branch needs a tension or is held, and nothing else may be "
          "asked for");
    return false;
  }
  const double largest = tension.array().isNaN().select(0.0, tension).maxCoeff();
  const double limit = std::max(1e-10, options_.tolerance) * largest;
  const PositionResult found = find_positions(system_, tension, start_, limit, options_.max_iterations);
  if (!found.converged && !asked) return false;
  result_.method = "position_newton";
  result_.iterations = found.iterations;
  result_.inner_iterations = found.inner_iterations;
  for (const double force : found.residual) result_.residual.push_back(force / largest);
  result_.step_relaxation = found.relaxation;
  result_.converged = found.converged;
  take_shape(found.state);
  result_.n_rows = static_cast<int>(rows(found.state).value.size());
  result_.reason = fmt::format("largest force out of balance {:.3g} N {} {:.3g} N", result_.out_of_balance,
                               found.converged ? "<=" : ">", limit);
  return true;
}

void FormSearch::search() {
  system_.factorise(start_);
  force_scale_ = force_scale(problem_, system_.equilibrium(start_));
  const bool dense = options_.step_solver == StepSolver::dense;
  SearchSettings settings;
  settings.tolerance = options_.tolerance;
  settings.max_iterations = options_.max_iterations;
  settings.z_follows_surface = options_.jacobian == SurfaceJacobian::consistent;
  settings.held = problem_.held;
  settings.lower = problem_.lower;
  settings.upper = problem_.upper;
  const int n_rows = static_cast<int>(rows(system_.equilibrium(start_)).value.size());
  settings.dense = dense || (options_.step_solver == StepSolver::automatic && n_rows <= dense_rows);
  ConstraintSearch search(
      system_,
      [&](const NetState& state) {
        ConstraintRows all = rows(state);
        if (result_.residual.empty() && !all.value.empty())
          result_.residual.push_back(all.missing().lpNorm<Eigen::Infinity>());
        return all;
      },
      settings);
  search.run(start_, [&] {
    result_.residual.push_back(search.error());
    result_.coordinate_norm.push_back(coordinate_norm(system_, search.state()));
  });
  result_.method = settings.dense ? "dense" : "lsqr";
  result_.n_rows = n_rows;
  result_.iterations = search.iterations();
  result_.inner_iterations = search.inner_iterations();
  result_.step_relaxation = search.relaxation();
  take_shape(search.state());
  judge(search);
  if (n_rows > 0) find_rank(search);
}

void FormSearch::judge(ConstraintSearch& search) {
  const double largest_tension = result_.tension.size() > 0 ? result_.tension.cwiseAbs().maxCoeff() : 0.0;
  const double balanced = balance_limit * largest_tension;
  result_.converged = search.met() && result_.out_of_balance <= balanced;
  if (result_.converged) {
    result_.reason =
        fmt::format("largest scaled residual {:.3g} <= {:.3g}", search.error(), options_.tolerance);
    return;
  }
  if (search.met()) {
    result_.reason =
        fmt::format("the constraints are met, but the largest force out of balance {:.3g} N > {:.3g} N",
                    result_.out_of_balance, balanced);
    return;
  }
  list_worst(search.rows(), search.missing());
  result_.least_squares_optimum = search.stationary(1e-5);
  result_.reason =
      fmt::format("{} {} iterations: largest scaled residual {:.3g} > {:.3g}, {}",
                  search.stuck() ? "no step reduces the residual after" : "stopped after", result_.iterations,
                  search.error(), options_.tolerance, to_string(result_.worst.front()));
  if (result_.least_squares_optimum)
    result_.reason +=
        "; the constraints contradict each other, this is the nearest shape in the sense of least squares";
  if (const std::string path = short_path(); !path.empty()) result_.reason += "; " + path;
}

void FormSearch::list_worst(const ConstraintRows& rows, const VecX& missing) {
  int row = 0;
  for (const Constraint& constraint : problem_.constraints) {
    for (const int member : constraint.members) {
      const double scale = rows.scale[row], found = rows.value[row] * scale;
      if (std::abs(missing[row]) > options_.tolerance)
        result_.worst.push_back(
            {constraint.name, constraint.kind, member, found + missing[row] * scale, found, -missing[row]});
      ++row;
    }
  }
  std::stable_sort(result_.worst.begin(), result_.worst.end(),
                   [](const auto& a, const auto& b) { return std::abs(a.relative) > std::abs(b.relative); });
  if (static_cast<int>(result_.worst.size()) > options_.n_worst) result_.worst.resize(options_.n_worst);
}

void FormSearch::find_rank(ConstraintSearch& search) {
  const bool small = result_.n_rows <= dense_rows;
  if (small || (options_.estimate_condition && result_.n_rows <= largest_dense)) {
    ConstraintJacobian G = search.jacobian();
    if (!problem_.held.empty()) G.hold(problem_.held);
    const VecX values = Eigen::BDCSVD<MatX>(G.dense()).singularValues();
    result_.rank = static_cast<int>((values.array() > rank_limit * values[0]).count());
    if (result_.rank > 0) result_.condition_number = std::pow(values[0] / values[result_.rank - 1], 2);
    return;
  }
  const auto [smallest, largest] = search.ritz_values();
  if (!(smallest > 0)) return;
  result_.condition_number = std::pow(largest / smallest, 2);
  result_.condition_is_estimate = true;
}

/// The shortest path over branches of prescribed length that cannot reach from one fixed node to another, if
/// there is one: a sentence.
std::string FormSearch::short_path() const {
  const Net& net = problem_.net;
  std::vector<std::vector<std::pair<int, double>>> next(net.nodes.size());
  for (const Constraint& constraint : problem_.constraints) {
    if (constraint.kind != ConstraintKind::length) continue;
    for (std::size_t k = 0; k < constraint.members.size(); ++k) {
      const auto [i, j] = net.branches[constraint.members[k]];
      const double length = constraint.value[constraint.value.size() == 1 ? 0 : k];
      next[i].emplace_back(j, length);
      next[j].emplace_back(i, length);
    }
  }
  int sources = 0;
  for (int from = 0; from < static_cast<int>(net.nodes.size()) && sources < 200; ++from) {
    if (!net.fixed[from] || next[from].empty()) continue;
    ++sources;
    std::vector<double> reach(net.nodes.size(), std::numeric_limits<double>::infinity());
    std::multimap<double, int> front{{0.0, from}};
    reach[from] = 0;
    while (!front.empty()) {
      const auto [length, node] = *front.begin();
      front.erase(front.begin());
      if (length > reach[node]) continue;
      const double distance = (net.nodes[node] - net.nodes[from]).norm();
      if (net.fixed[node] && length < distance * (1 - 1e-9))
        return fmt::format(
            "the lengths asked for between the fixed nodes {} and {} add up to {:.6g} m, but these are "
            "{:.6g} m apart",
            from, node, length, distance);
      for (const auto& [other, step] : next[node]) {
        if (length + step >= reach[other]) continue;
        reach[other] = length + step;
        front.emplace(reach[other], other);
      }
    }
  }
  return {};
}

ConstrainedResult FormSearch::run() {
  if (!try_positions()) search();
  return std::move(result_);
}

}  // namespace

std::string to_string(const Deviation& deviation) {
  const bool length =
      deviation.kind == ConstraintKind::length || deviation.kind == ConstraintKind::unstressed_length;
  const char* unit = length ? "m" : "N";
  return fmt::format("{} of {}, {} {}: {:.6g} {} wanted, {:.6g} {} found", word(deviation.kind),
                     deviation.constraint, is_reaction(deviation.kind) ? "node" : "branch", deviation.member,
                     deviation.wanted, unit, deviation.found, unit);
}

ConstrainedResult find_form(const ConstrainedNet& problem, const ConstrainedOptions& options) {
  check_problem(problem, options);
  if (!problem.triangles.empty()) return find_form_with_cloth(problem, options);
  return FormSearch(problem, options).run();
}

}  // namespace tautline::formfinding
