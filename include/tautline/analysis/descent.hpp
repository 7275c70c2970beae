#pragma once
/// @file
/// Newton's method damped so that it goes downhill in the potential energy wherever it starts. Theory:
/// docs/theory/newton.md

#include <tautline/analysis/newton.hpp>

namespace tautline::analysis {

struct DescentSummary {
  int steps = 0;
  double residual = 0;   ///< where the descent ended, of the reference force [-]
  NewtonSummary newton;  ///< from there; where the descent failed, its reason
};

/// @brief From the problem's present point to a stable equilibrium, any that lies downhill. Never throws for
/// non-convergence. Collective.
///
/// Each step solves (K + mu D) dx = -r, where D holds the largest absolute row sum of each block and mu is
/// the least of a geometric series that makes the matrix positive definite (Levenberg 1944, Marquardt 1963),
/// and goes along dx no farther than the energy falls. mu fades as steps succeed; near the end Newton's
/// method takes over.
/// @throws Interrupted if the user asked for it
DescentSummary descend(NonlinearProblem& problem, Workspace& workspace, const NewtonOptions& options,
                       const IterationCallback& callback = {});

}  // namespace tautline::analysis
