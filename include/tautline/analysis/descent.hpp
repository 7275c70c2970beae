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

/// @brief The same from where elements that only pull are slack, or so far from rest that their stiffness
/// hides the way: first with elements as soft as the forces out of balance, which rest soon, then with
/// stiffer ones from there, and so on to their own stiffness. Collective.
///
/// Cables and sheets turn on their way to rest; a stiff one lets an end go round the other only by tiny
/// straight steps, a soft one by large ones.
/// @throws Interrupted if the user asked for it
DescentSummary descend_softly(NonlinearProblem& problem, Workspace& workspace, const NewtonOptions& options,
                              const IterationCallback& callback = {});

/// Whether the present point is without resistance because elements that only pull are slack there: its
/// tangent is singular, and is not if they were taut. Collective.
bool gives_way(NonlinearProblem& problem, Workspace& workspace);

}  // namespace tautline::analysis
