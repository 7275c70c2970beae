#include "analysis/bordered.hpp"

#include <cmath>

#include <fmt/format.h>

#include "analysis/judge.hpp"

namespace tautline::analysis {

double SphereCondition::value(const la::Vector& x, double l, la::Vector& by_x, double& by_lambda) const {
  by_x.copy(x);
  by_x.multiply_entries(weights_);
  const double square = x.dot(by_x) + psi2_ * l * l;
  by_x.scale(2 / length_);
  by_lambda = 2 * psi2_ * l / length_;
  return (square - length_ * length_) / length_;
}

double PlaneCondition::value(const la::Vector& x, double l, la::Vector& by_x, double& by_lambda) const {
  by_x.copy(c_);
  by_lambda = e_;
  return c_.dot(x) + e_ * l - target_;
}

namespace {

/// The increments of one iteration by block elimination; false if there are no factors or no direction.
bool eliminate(PathProblem& problem, Workspace& workspace, const Condition& condition, const Increment& step,
               const la::Vector& residual, Increment& change) {
  problem.extrapolated_tangent(workspace.tangent);
  if (!workspace.solver.factor(workspace.tangent)) return false;
  const la::SkewPart skew = problem.skew_part();
  la::Vector q = la::Vector::like(residual), along = la::Vector::like(residual),
             by_x = la::Vector::like(residual);
  problem.load_rate(q);
  la::solve(workspace.solver, skew, residual, change.x);
  change.x.scale(-1);
  la::solve(workspace.solver, skew, q, along);
  double by_lambda = 0;
  const double g = condition.value(step.x, step.lambda, by_x, by_lambda);
  const double slope = by_lambda + by_x.dot(along);
  change.lambda = -(g + by_x.dot(change.x)) / slope;
  if (!std::isfinite(change.lambda)) return false;
  change.x.add(change.lambda, along);
  return true;
}

}  // namespace

NewtonSummary solve_bordered(PathProblem& problem, Workspace& workspace, const Condition& condition,
                             double lambda, Increment& step, const NewtonOptions& options,
                             const IterationCallback& callback) {
  Judge judge(problem, options, callback);
  Increment change{la::Vector::like(step.x), 0};
  la::Vector residual = la::Vector::like(step.x);
  change.x.copy(step.x);
  problem.restart();
  for (int iteration = 0;; ++iteration) {
    problem.set_lambda(lambda + step.lambda);
    problem.residual(step.x, residual);
    if (!std::isfinite(residual.norm())) {
      judge.summary.reason = "the residual is no longer a number: the step was far too large";
      return std::move(judge.summary);
    }
    const auto verdict = judge(iteration, residual, change.x);
    problem.accept(step.x);
    if (verdict != la::Verdict::go_on) return std::move(judge.summary);
    if (!eliminate(problem, workspace, condition, step, residual, change)) {
      judge.summary.status = NewtonStatus::singular;
      judge.summary.reason = "the tangent stiffness is singular on the way";
      return std::move(judge.summary);
    }
    step.x.add(1, change.x);
    step.lambda += change.lambda;
  }
}

}  // namespace tautline::analysis
