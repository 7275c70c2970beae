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

/// Tangents of one solve: with stresses foretold while forces are out of balance, then the true one.
class Tangents {
 public:
  Tangents(NonlinearProblem& problem, Workspace& workspace, const NewtonSummary& so_far)
      : problem_(problem), workspace_(workspace), so_far_(so_far) {}

  /// @return whether the tangent has been factored
  bool form(Stability stability) {
    const bool guarded = stability == Stability::kept;
    const bool far = guarded && relative_residual(so_far_.iterations.back().norms) > near;
    if (!far) problem_.tangent(workspace_.tangent);
    foretold_ = far && problem_.extrapolated_tangent(workspace_.tangent);
    if (!guarded || !factor()) return false;
    if (begun_with_ < 0) begun_with_ = negative();
    if (!foretold_ || negative() <= begun_with_) return true;
    problem_.tangent(workspace_.tangent);
    foretold_ = false;
    const bool factored = factor();
    astray_ = factored && negative() > begun_with_;
    return factored;
  }
  /// Whether the solve has left, far from balance, the side of stability on which it began.
  bool astray() const { return astray_; }
  /// Who asks for the inertia of the factors means the true tangent's.
  void leave_true() {
    if (!foretold_) return;
    problem_.tangent(workspace_.tangent);
    factor();
  }

 private:
  bool factor() { return workspace_.solver.factor(workspace_.tangent); }
  int negative() const { return workspace_.solver.inertia().negative; }

  static constexpr double near = 1e-6;
  NonlinearProblem& problem_;
  Workspace& workspace_;
  const NewtonSummary& so_far_;
  bool foretold_ = false, astray_ = false;
  int begun_with_ = -1;  // negative pivots
};

}  // namespace

NewtonSummary solve_newton(NonlinearProblem& problem, Workspace& workspace, const NewtonOptions& options,
                           const IterationCallback& callback, Stability stability) {
  Judge judge(problem, options, callback);
  Tangents tangents(problem, workspace, judge.summary);
  la::SnesCallbacks callbacks;
  callbacks.residual = [&](const la::Vector& x, la::Vector& f) { problem.residual(x, f); };
  callbacks.tangent = [&](la::SymmetricMatrix&) { return tangents.form(stability); };
  callbacks.correct = [&](const la::Vector& f, la::Vector& y) {
    la::correct_for_skew_part(workspace.solver, problem.skew_part(), f, y);
  };
  callbacks.accept = [&](const la::Vector& x) { problem.accept(x); };
  callbacks.verdict = [&](int iteration, const la::Vector& f, const la::Vector& dx) {
    const auto verdict = judge(iteration, f, dx);
    if (!tangents.astray() || verdict != la::Verdict::go_on) return verdict;
    judge.summary.reason =
        "the step leads through unstable states, out of balance, of a structure that was stable";
    return la::Verdict::diverged;
  };
  callbacks.line_search = [&](const std::function<double(double)>& slope, double slope_0, bool stiffened) {
    return judge.step = stiffened ? search_valley(slope, slope_0) : search_step(slope, slope_0);
  };
  problem.restart();
  la::Vector x(problem.layout());
  const auto outcome =
      la::run_snes(callbacks, workspace.tangent, workspace.solver, x, options.max_iterations + 1);
  NewtonSummary summary = std::move(judge.summary);
  if (outcome == la::SnesOutcome::converged) {
    tangents.leave_true();
  } else if (outcome == la::SnesOutcome::singular) {
    summary.status = NewtonStatus::singular;
    summary.reason = "the tangent stiffness is singular: " + why_singular(workspace.solver);
  } else if (outcome == la::SnesOutcome::not_a_number) {
    summary.reason =
        "the residual is no longer a number: an element was turned inside out or a step was far too large";
  }
  return summary;
}

}  // namespace tautline::analysis
