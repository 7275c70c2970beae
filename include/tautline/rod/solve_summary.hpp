#pragma once
#include <string>
#include <vector>

namespace tautline::rod {

enum class SolveStatus {
  converged,
  too_many_iterations,
  diverging,
  singular,
  impossible  ///< something needed is not there
};

/// How a solve went, with a sentence that holds the numbers that ended it.
struct SolveSummary {
  SolveStatus status = SolveStatus::diverging;
  std::string reason;
  std::vector<double> increments;  ///< largest change of an unknown, relative to its size, by iteration
  /// Inverse problem of the cantilever model: by what the paper's iteration shrinks errors. At a solution,
  /// whichever method found it, the spectral radius of the iteration's derivative: from 1 on the iteration
  /// leaves it. Where the iteration was given up, what its increments grew by last. Zero if unknown.
  double contraction_rate = 0;
  int steps = 1;             ///< in turning the root; 1 for a solve in one go
  int total_iterations = 0;  ///< of all steps, failed ones too
  bool converged() const { return status == SolveStatus::converged; }
  int iterations() const { return static_cast<int>(increments.size()); }
};

}  // namespace tautline::rod
