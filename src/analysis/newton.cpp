#include <tautline/analysis/newton.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <tautline/core/interrupt.hpp>
#include <tautline/core/error.hpp>
#include <tautline/la/session.hpp>
#include <tautline/la/snes.hpp>

namespace tautline::analysis {

namespace {

double ratio(double value, double reference) {
  if (value == 0) return 0;
  return reference > 0 ? value / reference : std::numeric_limits<double>::infinity();
}

double relative_residual(const ResidualNorms& norms) {
  return std::max(ratio(norms.force, norms.reference_force), ratio(norms.moment, norms.reference_moment));
}

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

/// The stopping rule and the record of one solve.
class Judge {
 public:
  Judge(NonlinearProblem& problem, const NewtonOptions& options, const IterationCallback& callback)
      : problem_(problem), options_(options), callback_(callback) {}

  la::Verdict operator()(int iteration, const la::Vector& f, const la::Vector& increment) {
    if (la::true_on_any_rank(interrupt_requested())) throw Interrupted();
    NewtonIteration record{problem_.norms(f), iteration == 0 ? 0.0 : problem_.relative_size(increment), step};
    summary.iterations.push_back(record);
    const double residual = relative_residual(record.norms);
    if (callback_) callback_(iteration, residual);
    if (settled(record, residual, iteration)) return la::Verdict::converged;
    if (record.increment > 10) {
      summary.reason = fmt::format(
          "the increment is {:.2g} times the structure's size: the iteration runs away", record.increment);
      return la::Verdict::diverged;
    }
    if (iteration >= options_.max_iterations) {
      summary.status = NewtonStatus::too_many_iterations;
      summary.reason = fmt::format(
          "after {} iterations the out-of-balance is {:.2e} of the reference force, not below {:.0e}",
          iteration, residual, options_.force_tolerance);
      return la::Verdict::diverged;
    }
    return la::Verdict::go_on;
  }

  NewtonSummary summary;
  double step = 1;

 private:
  /// Forces in balance and, after the start, an increment that has died out; or an increment that has died
  /// out with forces that fall no more, at the level that round-off of the stiffest element leaves, as where
  /// a mechanism moves without force.
  bool settled(const NewtonIteration& record, double residual, int iteration) {
    const bool balanced = residual <= options_.force_tolerance;
    const bool still = iteration > 0 && record.increment <= options_.increment_tolerance;
    const auto& norms = record.norms;
    const bool tiny = norms.force <= norms.rounding_force && norms.moment <= norms.rounding_moment &&
                      norms.force >= stagnation * last_force_ && norms.moment >= stagnation * last_moment_;
    last_force_ = norms.force;
    last_moment_ = norms.moment;
    const bool at_rounding =
        iteration > 0 && ((record.increment <= 1e-14 && residual <= 1e3 * options_.force_tolerance) ||
                          (record.increment <= 1e-9 && tiny));
    const bool at_rest = iteration == 0 && residual <= 1e-3 * options_.force_tolerance;
    if (!(balanced && still) && !at_rounding && !at_rest) return false;
    summary.status = NewtonStatus::converged;
    summary.reason = fmt::format(
        "out-of-balance {:.2e} of the reference force {:.3g} N <= {:.0e}, increment {:.2e} of the size",
        residual, record.norms.reference_force, options_.force_tolerance, record.increment);
    return true;
  }

  static constexpr double stagnation = 0.1;  ///< a residual that falls less than this is at its end
  NonlinearProblem& problem_;
  const NewtonOptions& options_;
  const IterationCallback& callback_;
  double last_force_ = 0, last_moment_ = 0;
};

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
