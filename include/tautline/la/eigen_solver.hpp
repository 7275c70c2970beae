#pragma once
/// @file
/// Generalised symmetric eigenproblems by SLEPc (Krylov-Schur, shift-invert with MUMPS).

#include <vector>

#include <tautline/la/symmetric_matrix.hpp>

namespace tautline::la {

struct EigenPairs {
  std::vector<double> values;
  std::vector<Vector> vectors;      ///< normalised to x^T M x = 1
  std::vector<double> residuals;    ///< |K x - lambda M x| / |K x|
};

/// @brief The `count` eigenvalues of K x = lambda M x nearest above `shift` in magnitude, smallest first; K symmetric, M positive
/// semidefinite. Collective.
/// @throws LibraryError if fewer converge
EigenPairs solve_vibration(const SymmetricMatrix& stiffness, const SymmetricMatrix& mass, int count, double shift = 0);

}  // namespace tautline::la
