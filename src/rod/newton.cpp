#include <rod/newton.hpp>

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <fmt/format.h>

namespace tautline::rod {

namespace {

constexpr int halvings = 10;

/// Moves x along the step, whole or halved until the residual falls.
/// @return false if it never does
bool move(const std::function<Linearised(const VecX&)>& problem, const VecX& step, bool is_last, VecX& x,
          Linearised& at) {
  double part = 1;
  for (int i = 0; i <= halvings; ++i, part /= 2) {
    const VecX next = x - part * step;
    Linearised there = problem(next);
    const bool fell = there.residual.norm() < (1 - part / 10) * at.residual.norm();
    if (there.residual.allFinite() && there.jacobian.allFinite() && (fell || is_last)) {
      x = next;
      at = std::move(there);
      return true;
    }
  }
  return false;
}

}  // namespace

SolveSummary ended(SolveSummary summary, SolveStatus status, std::string reason) {
  summary.status = status;
  summary.reason = std::move(reason);
  summary.total_iterations = summary.iterations();
  return summary;
}

SolveSummary solve_newton(const std::function<Linearised(const VecX&)>& problem, const VecX& size,
                          double tolerance, int max_iterations, VecX& x) {
  SolveSummary summary;
  const auto end = [&](SolveStatus status, std::string reason) {
    return ended(std::move(summary), status, std::move(reason));
  };
  Linearised at = problem(x);
  if (!at.residual.allFinite() || !at.jacobian.allFinite())
    return end(SolveStatus::diverging, "the start has no residual");
  while (summary.iterations() < max_iterations) {
    const Eigen::FullPivLU<MatX> factors(at.jacobian * size.asDiagonal());
    if (!factors.isInvertible())
      return end(SolveStatus::singular,
                 fmt::format("the Jacobian lost rank in iteration {}", summary.iterations() + 1));
    const VecX relative = factors.solve(at.residual);
    const double increment = relative.cwiseAbs().maxCoeff();
    summary.increments.push_back(increment);
    if (!move(problem, size.cwiseProduct(relative), increment <= tolerance, x, at))
      return end(SolveStatus::diverging,
                 fmt::format("iteration {}: the residual {:.3g} does not fall along the step of {:.3g}",
                             summary.iterations(), at.residual.norm(), increment));
    if (increment <= tolerance)
      return end(SolveStatus::converged,
                 fmt::format("increment {:.3g} <= {:.3g} after {} iterations, residual {:.3g}", increment,
                             tolerance, summary.iterations(), at.residual.norm()));
  }
  return end(
      SolveStatus::too_many_iterations,
      fmt::format("increment {:.3g} > {:.3g} after {} iterations",
                  summary.increments.empty() ? 0 : summary.increments.back(), tolerance, max_iterations));
}

SolveSummary follow_turning(const VecX& stiffness,
                            const std::function<SolveSummary(double turn, VecX& x)>& solve_at,
                            double min_step, VecX& x) {
  for (int k = 0; k < stiffness.size(); ++k)
    if (!std::isfinite(stiffness[k]))
      return ended(
          {}, SolveStatus::impossible,
          fmt::format("cable {} has no stiffness: no cable gives its node the reaction it needs", k + 1));
  SolveSummary last;
  int steps = 0, iterations = 0;
  double turn = 0, step = 0.25;
  while (turn < 1) {
    const double next = std::min(1.0, turn + step);
    VecX there = x;
    last = solve_at(next, there);
    iterations += last.total_iterations;
    if (last.converged()) {
      x = there;
      turn = next;
      ++steps;
      step *= 2;
    } else if ((step /= 4) < min_step) {
      last.reason =
          fmt::format("the root turned to {:.4g} of its way to the stop, not further: {}", turn, last.reason);
      break;
    }
  }
  last.steps = steps;
  last.total_iterations = iterations;
  return last;
}

}  // namespace tautline::rod
