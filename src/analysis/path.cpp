#include <tautline/analysis/path.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <tautline/analysis/descent.hpp>
#include <tautline/analysis/stability.hpp>

namespace tautline::analysis {

namespace {

constexpr int easy_iterations = 6;  // a step that took no more may be followed by a longer one

/// One step on, but not past the next of the points k / increments, nor past the end.
double next_point(double reached, double step, int increments) {
  const double slack = 1e-12, next = (std::floor(reached * increments + 1e-9) + 1) / increments;
  const double aim = std::min(reached + step, next);
  if (aim > 1 - slack) return 1;
  return aim > next - slack ? next : aim;
}

NewtonSummary solve_point(PathProblem& problem, Workspace& workspace, const NewtonOptions& options,
                          const IterationCallback& callback) {
  if (problem.predict(workspace)) return solve_newton(problem, workspace, options, callback);
  NewtonSummary summary;
  summary.status = NewtonStatus::singular;
  summary.reason = "the tangent stiffness is singular where the supports begin to move";
  return summary;
}

/// One run from lambda = 0 to 1.
class Driver {
 public:
  Driver(PathProblem& problem, Workspace& workspace, const NewtonOptions& options,
         const PathCallback& callback, const PathStart& start)
      : problem_(problem),
        workspace_(workspace),
        options_(options),
        callback_(callback),
        reached_(start.lambda),
        lost_(start.unknown) {}

  PathSummary run() {
    problem_.set_lambda(reached_);
    problem_.commit();
    here_ = problem_.keep();
    try {
      while (reached_ < 1 && advance()) {
      }
    } catch (...) {
      problem_.roll_back();
      problem_.set_lambda(reached_);
      throw;
    }
    if (reached_ < 1) return std::move(summary_);
    summary_.reached = true;
    summary_.inertia = inertia_;
    summary_.reason = fmt::format("lambda = 1 reached in {} step{}", summary_.points.size(),
                                  summary_.points.size() == 1 ? "" : "s");
    return std::move(summary_);
  }

 private:
  /// One step or one attempt at it. @return false if the path ends here
  bool advance() {
    const double aim = next_point(reached_, step_, options_.increments);
    problem_.set_lambda(aim);
    const IterationCallback tell = [&](int iteration, double residual) {
      if (callback_.iteration) callback_.iteration(aim, iteration, residual);
    };
    auto newton = solve_point(problem_, workspace_, options_, tell);
    summary_.newton_iterations += newton.newton_iterations();
    const bool lost = std::exchange(lost_, false);
    if (lost && (!newton.converged() || workspace_.solver.inertia().negative > 0))
      newton = go_downhill(std::move(newton), tell);
    if (!newton.converged()) return shorten(aim, newton);
    if (newton.newton_iterations() <= easy_iterations) step_ = std::min(2 * step_, 1.0 / options_.increments);
    note_inertia(newton);
    if (lost) negative_ = inertia_.negative;  // what led here is no path that could hold critical points
    problem_.commit();
    look_between(aim);
    here_ = problem_.keep();
    reached_ = aim;
    summary_.points.push_back({aim, std::move(newton), inertia_.negative});
    if (callback_.converged) callback_.converged(summary_.points.back());
    return true;
  }

  /// From where no equilibrium is known and Newton's method found none, or an unstable one, which is taken if
  /// nothing better is found.
  NewtonSummary go_downhill(NewtonSummary newton, const IterationCallback& tell) {
    const auto there = problem_.keep();
    problem_.roll_back();
    if (!problem_.predict(workspace_)) problem_.roll_back();
    auto descent = descend(problem_, workspace_, options_, tell);
    summary_.descent_steps += descent.steps;
    summary_.newton_iterations += descent.newton.newton_iterations();
    if (descent.newton.converged() || !newton.converged()) return std::move(descent.newton);
    problem_.return_to(*there);
    count_negative(problem_, workspace_);
    return newton;
  }

  bool shorten(double aim, const NewtonSummary& newton) {
    problem_.roll_back();
    ++summary_.failed_attempts;
    summary_.singular = newton.status == NewtonStatus::singular;
    step_ = std::min(step_, aim - reached_) / 2;
    if (step_ >= options_.min_step) return true;
    problem_.set_lambda(reached_);
    summary_.reason = fmt::format(
        "stopped at lambda = {:.4g}: the step {:.2e} fell below min_step = {:.2e}; the last attempt "
        "failed because {}",
        reached_, step_, options_.min_step, newton.reason);
    return false;
  }

  /// The last iteration factored the tangent; where there was none it is done here.
  void note_inertia(const NewtonSummary& newton) {
    if (newton.newton_iterations() == 0) count_negative(problem_, workspace_);
    inertia_ = workspace_.solver.inertia();
  }

  /// Where the number of negative pivots has changed since the last point, the points at which it did.
  void look_between(double aim) {
    const auto there = problem_.keep();
    const int after = inertia_.negative;
    if (negative_ < 0 && after == 0)
      negative_ = 0;  // a start that was unstable is past when the end is stable
    if (negative_ < 0) {
      problem_.return_to(*here_);
      negative_ = count_negative(problem_, workspace_);
    }
    if (negative_ == after) {
      problem_.return_to(*there);
      problem_.commit();
      return;
    }
    Workspace search{workspace_.tangent.shifted(0), la::DirectSolver()};  // what it does is not counted
    double low = reached_;
    for (int round = 0; round < most_critical && negative_ != after; ++round) {
      const auto go = [&](double t) -> std::optional<double> {
        const double lambda = low + t * (aim - low);
        problem_.return_to(*here_);
        problem_.set_lambda(lambda);
        if (!solve_point(problem_, search, options_, {}).converged()) return std::nullopt;
        return lambda;
      };
      problem_.return_to(*here_);
      if (low > reached_) go(0);
      double behind = 1;
      auto found = find_critical_point(problem_, search, {go, negative_, after, low}, behind);
      if (!found) break;
      negative_ = found->negative_after;
      low += behind * (aim - low);
      summary_.critical.push_back(std::move(*found));
      if (callback_.critical) callback_.critical(summary_.critical.back());
    }
    negative_ = after;
    problem_.return_to(*there);
    problem_.commit();
  }

  static constexpr int most_critical = 8;
  PathProblem& problem_;
  Workspace& workspace_;
  const NewtonOptions& options_;
  const PathCallback& callback_;
  PathSummary summary_;
  std::shared_ptr<const PathProblem::Kept> here_;
  la::Inertia inertia_;
  double reached_, step_ = 1.0 / options_.increments;
  bool lost_;          // no equilibrium is known
  int negative_ = -1;  // at the last point; not known at the start
};

}  // namespace

PathSummary follow_path(PathProblem& problem, Workspace& workspace, const NewtonOptions& options,
                        const PathCallback& callback, const PathStart& start) {
  return Driver(problem, workspace, options, callback, start).run();
}

}  // namespace tautline::analysis
