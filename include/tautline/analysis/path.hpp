#pragma once
/// @file
/// Every stage is a path: from boundary state A (lambda = 0) to B (lambda = 1). Full step first, halved on
/// failure, doubled on success. Theory: docs/theory/stages.md

#include <functional>
#include <string>
#include <vector>

#include <tautline/analysis/newton.hpp>

namespace tautline::analysis {

/// A problem whose boundary state depends on lambda; at lambda = 0 its present point is in equilibrium.
class PathProblem : public NonlinearProblem {
 public:
  virtual void set_lambda(double lambda) = 0;
  /// Moves the present point towards the equilibrium at the lambda just set, as far as a tangent can tell;
  /// false if the tangent is singular. A problem whose unknowns themselves are prescribed needs it.
  virtual bool predict(Workspace&) { return true; }
  virtual void commit() = 0;     ///< keeps the present point
  virtual void roll_back() = 0;  ///< returns to the point kept last
};

struct PathPoint {
  double lambda = 0;
  NewtonSummary newton;
};

struct PathSummary {
  bool reached = false;
  std::string reason;             ///< one sentence: reached, or why not and what to try
  std::vector<PathPoint> points;  ///< converged ones, in order
  bool singular = false;          ///< the last failed attempt met a singular tangent
  int failed_attempts = 0;
  int newton_iterations = 0;  ///< of all attempts
  la::Inertia inertia;        ///< of the tangent at the end
  double lambda() const { return points.empty() ? 0 : points.back().lambda; }
};

/// What is told on the way.
struct PathCallback {
  std::function<void(double, int, double)> iteration;  ///< (lambda aimed at, iteration, relative residual)
  std::function<void(double)> converged;               ///< (lambda), the problem stands at the point
};

/// @brief Follows the path to lambda = 1 or as far as it goes; the problem is left at the last converged
/// point. Collective.
/// @throws Interrupted between iterations if the user asked for it; the problem is then at its last converged
/// point
PathSummary follow_path(PathProblem& problem, Workspace& workspace, const NewtonOptions& options,
                        const PathCallback& callback = {});

}  // namespace tautline::analysis
