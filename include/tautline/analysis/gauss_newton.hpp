#pragma once
/// @file
/// Inverse problems: parameters that make residuals vanish, by Gauss and Newton's method, with bounds.
/// Theory: docs/theory/inverse.md

#include <functional>
#include <string>
#include <vector>

#include <tautline/core/types.hpp>

namespace tautline::analysis {

/// Residuals that depend on parameters through a state that has to be found, e.g. an equilibrium.
class InverseProblem {
 public:
  virtual ~InverseProblem() = default;
  /// Goes from the state kept last to that of `parameters`; false if it cannot be reached.
  virtual bool move_to(const VecX& parameters) = 0;
  virtual void keep() = 0;     ///< the present state is the one to go on from
  virtual void restore() = 0;  ///< back to the state kept last
  /// In the present state.
  virtual VecX residual() = 0;
  /// d residual / d parameters in the present state, shape (residuals, parameters).
  virtual MatX jacobian() = 0;
};

struct GaussNewtonOptions {
  double tolerance = 1e-6;       ///< residuals as small as this are met
  double step_tolerance = 1e-7;  ///< largest change of a parameter in the last iteration
  double rank_tolerance = 1e-8;  ///< singular values below this part of the largest count as zero
  int max_iterations = 50;
};

/// One point of the iteration and the step taken from it.
struct GaussNewtonIteration {
  double largest = 0, rms = 0;  ///< of the residuals
  double change = 0;            ///< largest change of a parameter asked for
  double step = 0;              ///< part of it that was taken
};

enum class GaussNewtonStatus {
  met,            ///< all residuals vanish
  least_squares,  ///< they do not; their sum of squares has a minimum
  too_many_iterations,
  stuck  ///< no part of the step could be taken
};

/// How it went, with a sentence that holds the numbers that ended it.
struct GaussNewtonSummary {
  GaussNewtonStatus status = GaussNewtonStatus::stuck;
  std::string reason;
  VecX parameters, residual;
  std::vector<GaussNewtonIteration> iterations;
  int rank = 0;          ///< of the last Jacobian
  double condition = 0;  ///< largest over least singular value that counts
  VecX influence;        ///< of all parameters on each residual: norms of the last Jacobian's rows
  bool converged() const {
    return status == GaussNewtonStatus::met || status == GaussNewtonStatus::least_squares;
  }
};

/// Parameters between bounds.
struct Box {
  VecX lower, upper;
};

/// @brief Minimises |residual + jacobian (q - at)| over the q in the box; among several minimisers the one
/// nearest to `preferred`.
///
/// Active set of Stark & Parker (1995) with complete orthogonal decompositions.
VecX bounded_least_squares(const MatX& jacobian, const VecX& residual, const VecX& at, const VecX& preferred,
                           const Box& box, double rank_tolerance);

/// @brief Solves from `start`, where the problem is and which must lie in the box. Where there are fewer
/// independent residuals than parameters, the solution nearest to `start` is found. Never throws for
/// non-convergence; the problem is left at `parameters`.
/// @param told after each iteration
GaussNewtonSummary solve_inverse(InverseProblem& problem, const VecX& start, const Box& box,
                                 const GaussNewtonOptions& options,
                                 const std::function<void(const GaussNewtonIteration&)>& told = {});

}  // namespace tautline::analysis
