#include <tautline/formfinding/constraints.hpp>

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <formfinding/balance.hpp>
#include <formfinding/cloth_form.hpp>
#include <formfinding/compromise.hpp>
#include <formfinding/constraint_search.hpp>
#include <formfinding/deviation.hpp>
#include <formfinding/position_search.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <tautline/core/error.hpp>
#include <tautline/formfinding/node_error.hpp>
#include <utility>

namespace tautline::formfinding {

namespace {

constexpr int dense_rows = 300;      // up to here the step comes from a dense decomposition
constexpr int largest_dense = 2000;  // rows for which rank and condition are computed on request
constexpr int many_branches = 2000;  // from here on the positions are the unknowns where they can be
constexpr double balance_limit =
    1e-9;  // of the largest force out of balance, relative to the largest tension
constexpr int most_compromising =
    20000;                            // branches for which positions and force densities are sought together
constexpr double push_limit = 1e-7;   // of the largest tension, below which a push is rounding
constexpr double rank_limit = 1e-12;  // singular values below this part of the largest count as zero

bool is_length(ConstraintKind kind) {
  return kind == ConstraintKind::length || kind == ConstraintKind::unstressed_length;
}

void check_values(const Constraint& constraint) {
  const std::size_t values = constraint.value.size();
  const bool none = constraint.kind == ConstraintKind::equal_tension || constraint.is_range();
  if (none ? values != 0 : values != 1 && values != constraint.members.size())
    throw ModelError(fmt::format("{} has {} members, but {} values", describe(constraint),
                                 constraint.members.size(), values));
  const bool any = is_reaction(constraint.kind), positive = is_length(constraint.kind);
  for (const double value : constraint.value)
    if (!std::isfinite(value) || (!any && value == 0) || (positive && value <= 0))
      throw ModelError(fmt::format("{} must be {}, not {}", describe(constraint),
                                   any        ? "a number"
                                   : positive ? "positive"
                                              : "a number that is not zero",
                                   value));
  if (!(constraint.weight > 0))
    throw ModelError(
        fmt::format("the weight of {} must be positive, not {}", describe(constraint), constraint.weight));
  if (constraint.least && constraint.most && *constraint.least > *constraint.most)
    throw ModelError(fmt::format("{}: its least value {:.6g} is above its greatest {:.6g}",
                                 describe(constraint), *constraint.least, *constraint.most));
  if (constraint.is_range() && !any && !(constraint.size(0) > 0))
    throw ModelError(fmt::format("{} has bounds of no size", describe(constraint)));
}

void check_members(const ConstrainedNet& problem, const Constraint& constraint) {
  const bool nodes = is_reaction(constraint.kind);
  const std::size_t count = nodes ? problem.net.nodes.size() : problem.net.branches.size();
  if (constraint.members.empty())
    throw ModelError(fmt::format("{} names no {}", describe(constraint), nodes ? "node" : "cable"));
  for (const int member : constraint.members)
    if (member < 0 || member >= static_cast<int>(count))
      throw ModelError(fmt::format("{} names {} {}, but the net has {}", describe(constraint),
                                   nodes ? "node" : "branch", member + 1, count));
  check_values(constraint);
}

/// A length between two fixed nodes is no free choice.
void check_fixed_length(const ConstrainedNet& problem, const Constraint& constraint) {
  if (constraint.kind != ConstraintKind::length || constraint.is_range()) return;
  for (std::size_t k = 0; k < constraint.members.size(); ++k) {
    const auto [i, j] = problem.net.branches[constraint.members[k]];
    if (!problem.net.fixed[i] || !problem.net.fixed[j]) continue;
    const double wanted = constraint.value[constraint.value.size() == 1 ? 0 : k];
    const double distance = (problem.net.nodes[j] - problem.net.nodes[i]).norm();
    if (std::abs(wanted - distance) > 1e-9 * distance)
      throw NetError({describe(constraint) + ": ", branch_word(constraint.members[k]),
                      fmt::format(" shall be {:.6g} m long, but joins two fixed nodes, ", wanted),
                      node_word(i), " and ", node_word(j),
                      fmt::format(", which are {:.6g} m apart", distance)});
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
      throw NetError(
          {describe(constraint) + ": ", node_word(node), " is free in that direction, where nothing reacts"});
  }
}

/// Two demands of one kind on one branch or node.
void check_repeated(const ConstrainedNet& problem) {
  std::map<std::pair<ConstraintKind, int>, const Constraint*> seen;
  for (const Constraint& constraint : problem.constraints) {
    if (constraint.kind == ConstraintKind::equal_tension || constraint.is_range()) continue;
    for (const int member : constraint.members) {
      const auto [it, first] = seen.try_emplace({constraint.kind, member}, &constraint);
      if (!first)
        throw NetError({fmt::format("{} and {} both set the {} of ", describe(*it->second),
                                    describe(constraint), to_string(constraint.kind)),
                        is_reaction(constraint.kind) ? node_word(member) : branch_word(member)});
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
      throw NetError({branch_word(static_cast<int>(b)),
                      fmt::format(": the lower bound {:.6g} N/m is above the upper one {:.6g} N/m",
                                  problem.lower[b], problem.upper[b])});
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
        throw NetError({describe(constraint) + " needs the axial stiffness of ", branch_word(b)});
  }
  check_repeated(problem);
}

/// By which forces without a target of their own are scaled: the largest one asked for, else the largest
/// tension at the start [N].
double force_scale(const ConstrainedNet& problem, const NetState& start) {
  double scale = 0;
  for (const Constraint& constraint : problem.constraints)
    if (constraint.kind == ConstraintKind::tension || is_reaction(constraint.kind))
      for (std::size_t k = 0; k < constraint.members.size(); ++k) scale = std::max(scale, constraint.size(k));
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
    if (constraint.kind != ConstraintKind::tension || constraint.is_range()) return {};
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

/// The given nodes, on their guides.
Coordinates given_nodes(const Net& net) {
  Coordinates nodes = to_coordinates(net.nodes);
  for (const Guide& guide : net.guides) {
    const Vec3 along = guide.direction.normalized(), arm = net.nodes[guide.node] - guide.point;
    const Vec3 kept =
        guide.kind == Guide::Kind::line ? Vec3(along * along.dot(arm)) : Vec3(arm - along * along.dot(arm));
    nodes.row(guide.node) = guide.point + kept;
  }
  return nodes;
}

/// Force densities of the tensions asked for in the given shape, else those to start from.
VecX given_density(const ConstrainedNet& problem, VecX q) {
  const Coordinates vectors = branch_vectors(problem.net, given_nodes(problem.net));
  for (const Constraint& constraint : problem.constraints) {
    if (constraint.kind != ConstraintKind::tension) continue;
    for (std::size_t k = 0; k < constraint.members.size(); ++k) {
      const int b = constraint.members[k];
      const double length = vectors.row(b).norm();
      if (length > 0 && (problem.held.empty() || !problem.held[b]))
        q[b] = constraint.wanted(k, q[b] * length) / length;
    }
  }
  return q;
}

class FormSearch {
 public:
  FormSearch(const ConstrainedNet& problem, const ConstrainedOptions& options,
             const std::function<void(int, double)>& progress)
      : problem_(problem), options_(options), progress_(progress), system_(problem.net, problem.surface) {
    start_ = problem.force_density.size() > 0
                 ? problem.force_density
                 : VecX::Constant(static_cast<Eigen::Index>(problem.net.branches.size()),
                                  options.initial_force_density);
    // A member asked to push starts as one: on the way there it would pass a net that hangs on nothing.
    for (const Constraint& constraint : problem.constraints)
      for (std::size_t k = 0; k < constraint.members.size(); ++k)
        if (constraint.kind == ConstraintKind::tension &&
            constraint.wanted(k, 0) * start_[constraint.members[k]] < 0)
          start_[constraint.members[k]] *= -1;
  }

  ConstrainedResult run();

 private:
  bool try_positions();
  SearchSettings search_settings() const;
  void search();
  ConstraintRows rows(const NetState& state) const;
  void take_shape(const NetState& state);
  /// Why the search that ended has not converged, if so.
  void judge(ConstraintSearch& search);
  void blame(const ConstraintRows& rows, const std::string& end);
  void find_rank(ConstraintSearch& search);
  /// The least weighted squares, from where the search ended and from the given nodes.
  /// @return whether there is an answer
  bool compromise(const NetState* end);
  CompromiseSettings compromise_settings() const;
  std::optional<CompromiseResult> best_compromise(const NetState* end) const;
  /// How far a node has moved from where it was drawn, over the mean length of the members there.
  double strayed(const CompromiseResult& found) const;
  bool is_better(const CompromiseResult& a, const CompromiseResult& b) const;
  bool pushes(const ConstrainedResult& found) const;

  const ConstrainedNet& problem_;
  const ConstrainedOptions& options_;
  const std::function<void(int, double)>& progress_;  ///< (iteration, residual)
  NetSystem system_;
  VecX start_;
  double force_scale_ = 0;  ///< see force_scale(); 0: not known yet [N]
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
  try {
    system_.factorise(state.force_density);
    result_.warnings = stability_warnings(system_, state);
  } catch (const NodeError&) {  // it was not found from its force densities alone
    result_.warnings = {
        "with its force densities held, the net could take other shapes as well: only the stiffness of its "
        "members keeps it in the one found"};
  }
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
  const PositionResult found =
      find_positions(system_, tension, start_, limit, options_.max_iterations, progress_);
  if (!found.converged && !asked && start_.size() <= most_compromising) return false;
  result_.method = "position_newton";
  result_.iterations = found.iterations;
  result_.inner_iterations = found.inner_iterations;
  for (const double force : found.residual) result_.residual.push_back(force / largest);
  result_.step_relaxation = found.relaxation;
  result_.converged = result_.in_balance = found.converged;
  take_shape(found.state);
  result_.n_rows = static_cast<int>(rows(found.state).value.size());
  result_.reason = fmt::format("largest force out of balance {:.3g} N {} {:.3g} N", result_.out_of_balance,
                               found.converged ? "<=" : ">", limit);
  return true;
}

SearchSettings FormSearch::search_settings() const {
  SearchSettings settings;
  settings.tolerance = options_.tolerance;
  settings.max_iterations = options_.max_iterations;
  settings.z_follows_surface = options_.jacobian == SurfaceJacobian::consistent;
  settings.held = problem_.held;
  settings.lower = problem_.lower;
  settings.upper = problem_.upper;
  int n_rows = 0;
  for (const Constraint& constraint : problem_.constraints)
    n_rows += static_cast<int>(constraint.members.size());
  settings.dense = options_.step_solver == StepSolver::dense ||
                   (options_.step_solver == StepSolver::automatic && n_rows <= dense_rows);
  return settings;
}

void FormSearch::search() {
  system_.factorise(start_);
  force_scale_ = force_scale(problem_, system_.equilibrium(start_));
  const SearchSettings settings = search_settings();
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
    if (progress_) progress_(search.iterations(), search.error());
  });
  result_.method = settings.dense ? "dense" : "lsqr";
  result_.n_rows = static_cast<int>(search.missing().size());
  result_.iterations = search.iterations();
  result_.inner_iterations = search.inner_iterations();
  result_.step_relaxation = search.relaxation();
  take_shape(search.state());
  judge(search);
  if (result_.n_rows > 0) find_rank(search);
  const bool ended = search.stuck() || search.iterations() >= ConstrainedOptions{}.max_iterations;
  if ((!search.met() && ended) || (result_.converged && pushes(result_))) compromise(&search.state());
}

void FormSearch::judge(ConstraintSearch& search) {
  const double largest_tension = result_.tension.size() > 0 ? result_.tension.cwiseAbs().maxCoeff() : 0.0;
  const double balanced = balance_limit * largest_tension;
  result_.in_balance = result_.out_of_balance <= balanced;
  result_.converged = search.met() && result_.in_balance;
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
  result_.least_squares_optimum = search.stationary(1e-5);
  blame(search.rows(), search.stuck() ? "no step reduces the residual after" : "stopped after");
}

void FormSearch::blame(const ConstraintRows& rows, const std::string& end) {
  const VecX missing = rows.missing();
  result_.weighted_squares = weighted_squares(rows, missing);
  list_deviations(problem_.constraints, rows, missing, options_, result_);
  result_.reason =
      fmt::format("{} {} iterations: largest scaled residual {:.3g} > {:.3g}, {}", end, result_.iterations,
                  missing.lpNorm<Eigen::Infinity>(), options_.tolerance, to_string(result_.worst.front()));
  if (result_.least_squares_optimum)
    result_.reason +=
        "; the constraints contradict each other, this is the nearest shape in the sense of least squares";
  result_.short_path = find_short_path(problem_);
  if (const auto& path = result_.short_path)
    result_.reason +=
        "; " + to_string(*path, fmt::format("node {}", path->from + 1), fmt::format("node {}", path->to + 1));
}

bool FormSearch::pushes(const ConstrainedResult& found) const {
  const double rounding = push_limit * found.tension.cwiseAbs().maxCoeff();
  for (std::size_t b = 0; b < problem_.pulls.size(); ++b)
    if (problem_.pulls[b] && found.tension[static_cast<Eigen::Index>(b)] < -rounding) return true;
  return false;
}

CompromiseSettings FormSearch::compromise_settings() const {
  CompromiseSettings settings;
  settings.tolerance = options_.tolerance;
  settings.force = force_scale_;
  settings.held = problem_.held;
  settings.lower = problem_.lower;
  settings.upper = problem_.upper;
  if (problem_.pulls.empty()) return settings;
  settings.lower = VecX::Constant(start_.size(), std::nan(""));
  for (Eigen::Index b = 0; b < start_.size(); ++b) {
    const double own = problem_.lower.size() > 0 ? problem_.lower[b] : std::nan("");
    const bool pulls = problem_.pulls[static_cast<std::size_t>(b)];
    settings.lower[b] = pulls && !(own > 0) ? 0 : own;
  }
  return settings;
}

double FormSearch::strayed(const CompromiseResult& found) const {
  const Coordinates drawn = given_nodes(problem_.net);
  const double farthest = (found.state.nodes - drawn).rowwise().norm().maxCoeff();
  return farthest / system_.state(given_density(problem_, start_), drawn).length.mean();
}

/// Fewer squares are better. But beside a net that all but meets the demands, one that is twice as far from
/// the drawing, nodes moved by more than a member's length, is folded: another net than was asked for.
bool FormSearch::is_better(const CompromiseResult& a, const CompromiseResult& b) const {
  constexpr double nearly = 1e-2;
  const auto folded_beside = [&](const CompromiseResult& one, const CompromiseResult& other) {
    const double far = strayed(one);
    return far > 1 && far > 2 * strayed(other) && other.rows.missing().lpNorm<Eigen::Infinity>() < nearly;
  };
  if (folded_beside(a, b)) return false;
  if (folded_beside(b, a)) return true;
  return !b.met && (a.met || a.squares < (1 - 1e-9) * b.squares);
}

std::optional<CompromiseResult> FormSearch::best_compromise(const NetState* end) const {
  const CompromiseSettings settings = compromise_settings();
  std::optional<CompromiseResult> best;
  const auto search_from = [&](const NetState& start) {
    try {
      CompromiseResult found = find_compromise(
          system_, [&](const NetState& state) { return rows(state); }, start, settings);
      if (found.in_balance && (!best || is_better(found, *best))) best = std::move(found);
    } catch (const ModelError&) {
      // This start leads off the surface.
    }
  };
  if (end != nullptr) search_from(*end);
  search_from(system_.state(given_density(problem_, start_), given_nodes(problem_.net)));
  return best;
}

bool FormSearch::compromise(const NetState* end) {
  if (problem_.constraints.empty() || start_.size() > most_compromising ||
      options_.jacobian == SurfaceJacobian::as_published)
    return false;
  if (force_scale_ == 0)
    force_scale_ = force_scale(problem_, system_.state(start_, given_nodes(problem_.net)));
  const auto best = best_compromise(end);
  if (!best) return false;
  take_shape(best->state);
  result_.iterations += best->iterations;
  result_.converged = best->met;
  result_.in_balance = true;
  result_.least_squares_optimum = best->optimum;
  const VecX missing = best->rows.missing();
  result_.residual.push_back(missing.lpNorm<Eigen::Infinity>());
  result_.coordinate_norm.push_back(coordinate_norm(system_, best->state));
  result_.method = "compromise";
  result_.n_rows = static_cast<int>(missing.size());
  result_.worst.clear();
  result_.misses.clear();
  result_.short_path.reset();
  result_.weighted_squares = 0;
  if (best->met)
    result_.reason = fmt::format("largest scaled residual {:.3g} <= {:.3g}",
                                 missing.lpNorm<Eigen::Infinity>(), options_.tolerance);
  else
    blame(best->rows, "no step reduces the weighted squares after");
  return true;
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

ConstrainedResult FormSearch::run() {
  try {
    if (!try_positions())
      search();
    else if (!result_.converged && result_.iterations < options_.max_iterations)
      compromise(nullptr);
  } catch (const CancelledDensities&) {
    // The start leaves a direction open. The shape as given may not.
    if (!compromise(nullptr)) throw;
  }
  return std::move(result_);
}

}  // namespace

ConstrainedResult find_form(const ConstrainedNet& problem, const ConstrainedOptions& options,
                            const std::function<void(int, double)>& progress) {
  check_problem(problem, options);
  if (!problem.triangles.empty()) return find_form_with_cloth(problem, options);
  return FormSearch(problem, options, progress).run();
}

}  // namespace tautline::formfinding
