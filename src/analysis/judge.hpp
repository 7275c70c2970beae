#pragma once
/// @file
/// When an iteration has converged, and when there is no hope for it.

#include <tautline/analysis/newton.hpp>
#include <tautline/la/snes.hpp>

namespace tautline::analysis {

/// The larger of force and moment out of balance over their references.
double relative_residual(const ResidualNorms& norms);

/// The stopping rule and the record of one solve.
class Judge {
 public:
  Judge(const NonlinearProblem& problem, const NewtonOptions& options, const IterationCallback& callback)
      : problem_(problem), options_(options), callback_(callback) {}

  /// @throws Interrupted if the user asked for it
  la::Verdict operator()(int iteration, const la::Vector& f, const la::Vector& increment);

  NewtonSummary summary;
  double step = 1;

 private:
  bool settled(const NewtonIteration& record, double residual, int iteration);

  const NonlinearProblem& problem_;
  const NewtonOptions& options_;
  const IterationCallback& callback_;
  double last_force_ = 0, last_moment_ = 0;
};

}  // namespace tautline::analysis
