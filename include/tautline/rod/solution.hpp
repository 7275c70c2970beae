#pragma once
#include <tautline/rod/shape.hpp>
#include <tautline/rod/solve_summary.hpp>
#include <tautline/rod/stability.hpp>

namespace tautline::rod {

/// What a model found. The shape is meaningful if the summary converged.
struct RodSolution {
  SolveSummary summary;
  RodShape shape;
  Stability stability;  ///< with the cables of a design or of the forward problem; else under constant forces
};

}  // namespace tautline::rod
