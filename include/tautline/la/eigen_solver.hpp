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
/// @throws ModelError if there are fewer; LibraryError if fewer converge
///
/// @param known  vectors of the null space of K, orthonormal in M: counted and kept out; K may then be
///               singular, and the shift must be below zero
EigenPairs solve_vibration(const SymmetricMatrix& stiffness, const SymmetricMatrix& mass, int count,
                           double shift = 0, const std::vector<Vector>& known = {});

/// Which end of a spectrum.
enum class Extreme { lowest, highest, both };

/// @brief Up to `count` eigenvalues of A x = nu B x farthest from zero, below it, above it or on both sides,
/// farthest first; A symmetric, B positive definite, patterns within that of B. Collective.
///
/// Eigenvalues below 1e-10 of the largest are taken for zero. That none is left out is shown by the inertia
/// of A - s B beyond those found.
/// @return vectors normalised to x^T B x = 1; residuals |A x - nu B x| / |nu| / (|diagonal of B|_max |x|)
/// @throws LibraryError if SLEPc fails
EigenPairs solve_extreme(const SymmetricMatrix& a, const SymmetricMatrix& b, int count, Extreme which);

}  // namespace tautline::la
