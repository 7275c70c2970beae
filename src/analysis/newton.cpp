#include <tautline/analysis/newton.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <tautline/la/snes.hpp>

#include "analysis/judge.hpp"

namespace tautline::analysis {

namespace {

/// A step is taken whole unless the energy still falls, or has begun to rise, too steeply at its end; then a
/// secant search looks for the point where the slope along it has mostly gone (Crisfield 1991, sec. 9.2).
double search_step(const std::function<double(double)>& slope, double slope_0) {
  constexpr double slack = 0.8,
                   growth =
                       1e8;  // a slender beam's full step may well overshoot by 1e6 and still be the best
  constexpr int most = 6;
  double left = 0, slope_left = slope_0, right = 1, slope_right = slope(1);
  if (!std::isfinite(slope_right))
    slope_right = -slope_0 * growth * growth;
  else if (std::abs(slope_right) <= growth * std::abs(slope_0) || slope_right * slope_0 > 0)
    return 1;
  double t = 1;
  for (int i = 0; i < most; ++i) {
    t = left + (right - left) * std::clamp(slope_left / (slope_left - slope_right), 0.1, 0.9);
    const double here = slope(t);
    if (std::abs(here) <= slack * std::abs(slope_0)) return t;
    if (std::isfinite(here) && here * slope_0 > 0) {
      left = t;
      slope_left = here;
    } else {
      right = t;
      slope_right = std::isfinite(here) ? here : -slope_0 * growth * growth;
    }
  }
  return t;
}

/// Along a step of arbitrary length: bisection for where the slope has mostly gone or has changed its sign,
/// so that the energy is lower there than at the start.
double search_valley(const std::function<double(double)>& slope, double slope_0) {
  constexpr int most = 40;
  double left = 0, right = 1;
  if (const double end = slope(1); std::isfinite(end) && end * slope_0 > 0) return 1;
  for (int i = 0; i < most; ++i) {
    const double t = (left + right) / 2, here = slope(t);
    const bool before = std::isfinite(here) && here * slope_0 > 0;
    if (std::isfinite(here) && std::abs(here) <= 0.5 * std::abs(slope_0)) return t;
    (before ? left : right) = t;
  }
  return right;
}

std::string why_singular(const la::DirectSolver& solver) {
  if (!solver.failure().empty()) return solver.failure();
  const int null = solver.inertia().null;
  return fmt::format("{} null pivot{}, so that part of the load meets no resistance", null,
                     null == 1 ? "" : "s");
}

}  // namespace

NewtonSummary solve_newton(NonlinearProblem& problem, Workspace& workspace, const NewtonOptions& options,
                           const IterationCallback& callback) {
  Judge judge(problem, options, callback);
  la::SnesCallbacks callbacks;
  callbacks.residual = [&](const la::Vector& x, la::Vector& f) { problem.residual(x, f); };
  callbacks.tangent = [&](la::SymmetricMatrix& k) { problem.tangent(k); };
  callbacks.accept = [&](const la::Vector& x) { problem.accept(x); };
  callbacks.verdict = [&](int iteration, const la::Vector& f, const la::Vector& dx) {
    return judge(iteration, f, dx);
  };
  callbacks.line_search = [&](const std::function<double(double)>& slope, double slope_0, bool stiffened) {
    return judge.step = stiffened ? search_valley(slope, slope_0) : search_step(slope, slope_0);
  };
  problem.restart();
  la::Vector x(problem.layout());
  const auto outcome =
      la::run_snes(callbacks, workspace.tangent, workspace.solver, x, options.max_iterations + 1);
  NewtonSummary summary = std::move(judge.summary);
  if (outcome == la::SnesOutcome::converged) return summary;
  if (outcome == la::SnesOutcome::singular) {
    summary.status = NewtonStatus::singular;
    summary.reason = "the tangent stiffness is singular: " + why_singular(workspace.solver);
  } else if (outcome == la::SnesOutcome::not_a_number) {
    summary.reason =
        "the residual is no longer a number: an element was turned inside out or a step was far too large";
  }
  return summary;
}

}  // namespace tautline::analysis
