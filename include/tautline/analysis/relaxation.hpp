#pragma once
/// @file
/// Dynamic relaxation with kinetic damping: to a state that Newton's method cannot reach. Theory:
/// docs/theory/paths.md

#include <functional>
#include <string>

#include <tautline/analysis/path.hpp>

namespace tautline::analysis {

struct RelaxationOptions {
  int max_steps = 20000;
  double tolerance =
      1e-4;  ///< residual force over reference force at which Newton's method may take over [-]
};

struct RelaxationSummary {
  bool settled = false;
  int steps = 0, peaks = 0;  ///< peaks of kinetic energy, at each of which all motion is stopped
  double residual = 0;       ///< at the end, over the reference force [-]
};

/// @brief Lets the problem move from its present point, at the lambda set last, under its residual forces,
/// and stops it at each peak of its kinetic energy. Collective.
///
/// Masses are fictitious: half the sums of |K_ij| over a row, so that a time step of one is stable (Barnes
/// 1999).
/// @throws Interrupted if the user asked for it
RelaxationSummary relax(PathProblem& problem, Workspace& workspace, const RelaxationOptions& options,
                        const std::function<void(int, double)>& callback = {});

}  // namespace tautline::analysis
