#pragma once
/// @file
/// Generalised symmetric eigenproblems by SLEPc (Krylov-Schur, shift-invert with MUMPS).

#include <vector>

#include <tautline/la/direct_solver.hpp>
#include <tautline/la/symmetric_matrix.hpp>

namespace tautline::la {

struct EigenPairs {
  std::vector<double> values;
  std::vector<Vector> vectors;    ///< normalised to x^T M x = 1
  std::vector<double> residuals;  ///< |K x - lambda M x| / (|diagonal of K|_max |x|)
  SolverTimings timings;          ///< of the refinement; SLEPc keeps its own
};

/// @brief The `count` eigenvalues of K x = lambda M x nearest to `shift`, smallest first; K symmetric, M
/// positive semidefinite, its pattern within that of K. Collective.
///
/// That none is left out, multiple ones least of all, is shown by the inertia of K - s M on either side of
/// those found.
/// @throws LibraryError if fewer converge
EigenPairs solve_vibration(const SymmetricMatrix& stiffness, const SymmetricMatrix& mass, int count,
                           double shift = 0);

}  // namespace tautline::la
