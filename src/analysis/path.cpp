#include <tautline/analysis/path.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tautline::analysis {

namespace {

constexpr int easy_iterations = 6;  // a step that took no more may be followed by a longer one

/// The last iteration factored the tangent; where there was none it is done here.
la::Inertia inertia_at_end(NonlinearProblem& problem, Workspace& workspace, const NewtonSummary& last) {
  if (last.newton_iterations() == 0) {
    problem.tangent(workspace.tangent);
    if (!workspace.solver.factor(workspace.tangent)) return {};
  }
  return workspace.solver.inertia();
}

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

}  // namespace

PathSummary follow_path(PathProblem& problem, Workspace& workspace, const NewtonOptions& options,
                        const PathCallback& callback) {
  PathSummary summary;
  const double longest = 1.0 / options.increments;
  double reached = 0, step = longest;
  problem.commit();
  try {
    while (reached < 1) {
      const double aim = next_point(reached, step, options.increments);
      problem.set_lambda(aim);
      auto newton = solve_point(problem, workspace, options, [&](int iteration, double residual) {
        if (callback.iteration) callback.iteration(aim, iteration, residual);
      });
      summary.newton_iterations += newton.newton_iterations();
      if (newton.converged()) {
        if (newton.newton_iterations() <= easy_iterations) step = std::min(2 * step, longest);
        problem.commit();
        reached = aim;
        summary.points.push_back({aim, std::move(newton)});
        if (callback.converged) callback.converged(aim);
        continue;
      }
      problem.roll_back();
      ++summary.failed_attempts;
      summary.singular = newton.status == NewtonStatus::singular;
      step = std::min(step, aim - reached) / 2;
      if (step < options.min_step) {
        problem.set_lambda(reached);
        summary.reason = fmt::format(
            "stopped at lambda = {:.4g}: the step {:.2e} fell below min_step = {:.2e}; the last attempt "
            "failed because {}",
            reached, step, options.min_step, newton.reason);
        return summary;
      }
    }
  } catch (...) {
    problem.roll_back();
    problem.set_lambda(reached);
    throw;
  }
  summary.reached = true;
  summary.inertia = inertia_at_end(problem, workspace, summary.points.back().newton);
  summary.reason = fmt::format("lambda = 1 reached in {} step{}", summary.points.size(),
                               summary.points.size() == 1 ? "" : "s");
  return summary;
}

}  // namespace tautline::analysis
