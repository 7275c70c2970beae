#pragma once
/// @file
/// PETSc's Newton loop with its own line search and stopping rule left to callbacks.

#include <functional>
#include <memory>

#include <tautline/la/direct_solver.hpp>
#include <tautline/la/symmetric_matrix.hpp>
#include <tautline/la/vector.hpp>

namespace tautline::la {

/// What the stopping rule answers.
enum class Verdict { go_on, converged, diverged };

struct SnesCallbacks {
  std::function<void(const Vector& x, Vector& f)> residual;
  /// Assembles the tangent at x; x was accepted before. @return whether it has been factored, too
  std::function<bool(SymmetricMatrix&)> tangent;
  /// Makes of y, which solves K y = f with the tangent's factors, the step proper; none: y is.
  std::function<void(const Vector& f, Vector& y)> correct = {};
  /// Called at the start of every iteration with the point the last one reached.
  std::function<void(const Vector& x)> accept;
  /// After each iteration (0 = the start): |increment| is 0 at the start.
  std::function<Verdict(int iteration, const Vector& f, const Vector& increment)> verdict;
  /// Factor for the full Newton step, in (0, 1]: given the directional derivatives it may ask for more of
  /// them. slope(t) = -f(x + t dx) . dx, evaluated anew at each call. `stiffened`: the tangent was singular
  /// and the step was made with a stiffer one, so that its length means little.
  std::function<double(const std::function<double(double)>& slope, double slope_0, bool stiffened)>
      line_search;
};

enum class SnesOutcome { converged, diverged, singular, not_a_number };

/// Runs SNES from x; x holds the last point on return. Exceptions of the callbacks pass through. Collective.
SnesOutcome run_snes(const SnesCallbacks& callbacks, SymmetricMatrix& tangent, DirectSolver& solver,
                     Vector& x, int max_iterations);

}  // namespace tautline::la
