#include <tautline/analysis/path.hpp>

#include <algorithm>

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

}  // namespace

PathSummary follow_path(PathProblem& problem, Workspace& workspace, const NewtonOptions& options,
                        const PathCallback& callback) {
  PathSummary summary;
  double reached = 0, step = 1;
  problem.commit();
  try {
    while (reached < 1) {
      const double aim = reached + step > 1 - 1e-12 ? 1.0 : reached + step;
      problem.set_lambda(aim);
      auto newton = solve_newton(problem, workspace, options, [&](int iteration, double residual) {
        if (callback) callback(aim, iteration, residual);
      });
      summary.newton_iterations += newton.newton_iterations();
      if (newton.converged()) {
        if (newton.newton_iterations() <= easy_iterations) step *= 2;
        problem.commit();
        reached = aim;
        summary.points.push_back({aim, std::move(newton)});
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
