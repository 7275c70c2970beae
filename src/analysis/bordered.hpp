#pragma once
/// @file
/// Newton's method for equilibrium and one more equation, with lambda as one more unknown.

#include <memory>

#include <tautline/analysis/path.hpp>

namespace tautline::analysis {

/// g(x, l) = 0, where x and l are the increments of the unknowns and of lambda since the step began.
class Condition {
 public:
  virtual ~Condition() = default;
  /// g, and its derivatives: by x into `by_x`, by l into `by_lambda`.
  virtual double value(const la::Vector& x, double l, la::Vector& by_x, double& by_lambda) const = 0;
};

/// x^T d x + psi2 l^2 = length^2.
class SphereCondition : public Condition {
 public:
  SphereCondition(const la::Vector& weights, double psi2, double length)
      : weights_(weights), psi2_(psi2), length_(length) {}
  double value(const la::Vector& x, double l, la::Vector& by_x, double& by_lambda) const override;

 private:
  const la::Vector& weights_;
  double psi2_, length_;
};

/// c . x + e l = target.
class PlaneCondition : public Condition {
 public:
  PlaneCondition(const la::Vector& c, double e, double target) : c_(c), e_(e), target_(target) {}
  double value(const la::Vector& x, double l, la::Vector& by_x, double& by_lambda) const override;

 private:
  const la::Vector& c_;
  double e_, target_;
};

/// A first guess and, after the solve, the increments reached.
struct Increment {
  la::Vector x;
  double lambda = 0;
};

/// @brief Solves from the problem's present point at `lambda` (where `step.lambda` counts from). Both
/// right-hand sides of a block elimination go through one factorisation. Collective.
/// @param step  in: the guess, which meets the condition; out: where it ended
NewtonSummary solve_bordered(PathProblem& problem, Workspace& workspace, const Condition& condition,
                             double lambda, Increment& step, const NewtonOptions& options,
                             const IterationCallback& callback = {});

}  // namespace tautline::analysis
