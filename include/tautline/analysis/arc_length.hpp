#pragma once
/// @file
/// The path of equilibria followed by its length: round limit points, back, and onto branches. Theory:
/// docs/theory/paths.md

#include <functional>
#include <optional>

#include <tautline/analysis/arc_length_options.hpp>
#include <tautline/analysis/path.hpp>

namespace tautline::analysis {

/// A motion that is watched [m].
struct Watch {
  la::Vector c;                     ///< its derivative by the unknowns
  std::function<double()> measure;  ///< its value at the problem's present point
};

/// @brief Follows the path from the problem's present point, which must be an equilibrium at `start.lambda`,
/// until one of the options' ends; the problem is left at the last converged point. Collective.
///
/// PathSummary::points, critical and reason tell of it; `reached` is true at an end that was asked for.
/// @param watch  the motion that ArcLengthOptions::displacement speaks of
/// @throws Interrupted between iterations if the user asked for it
PathSummary follow_arc(PathProblem& problem, Workspace& workspace, const NewtonOptions& newton,
                       const ArcLengthOptions& options, const std::optional<Watch>& watch = {},
                       const PathCallback& callback = {}, const PathStart& start = {});

}  // namespace tautline::analysis
