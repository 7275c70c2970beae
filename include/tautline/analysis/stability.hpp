#pragma once
/// @file
/// Where a path loses or regains its stability. Theory: docs/theory/paths.md

#include <functional>
#include <optional>

#include <tautline/analysis/path.hpp>

namespace tautline::analysis {

/// Eigenvalue of K x = mu d x nearest to zero and its mode, x^T d x = 1.
struct SoftestMode {
  double eigenvalue = 0;
  la::Vector mode;
};

/// @brief Inverse iteration with the factors of the tangent of the present point, in the space where
/// `weights` (PathProblem::weights) are positive. Collective.
SoftestMode softest_mode(const PathProblem& problem, la::DirectSolver& factored, const la::Vector& weights);

/// Assembles and factors the tangent of the present point. @return its negative pivots
int count_negative(PathProblem& problem, Workspace& workspace);

/// The same without those that rounding may have made negative.
int count_firmly_negative(PathProblem& problem, Workspace& workspace);

/// Cosine between a mode and the load, both measured by the weights.
double load_share(const la::Vector& mode, const la::Vector& load_rate, const la::Vector& weights);

/// A piece of a path: what lies at its ends, and a way to each point between.
struct Bracket {
  /// Brings the problem to the part t in (0, 1] of the piece. @return lambda there, or nothing if it failed
  std::function<std::optional<double>(double t)> go;
  int negative_before = 0, negative_after = 0;
  double lambda_before = 0;
};

/// @brief The first point of the piece at which the number of negative pivots changes, and a point just
/// behind it.
///
/// Inertia brackets the point; the secant of the critical eigenvalue and bisection close in on it.
/// Collective.
/// @param behind  part t of the piece just behind the point
/// @return nothing if the path could not be followed to it
std::optional<CriticalPoint> find_critical_point(PathProblem& problem, Workspace& workspace,
                                                 const Bracket& bracket, double& behind);

}  // namespace tautline::analysis
