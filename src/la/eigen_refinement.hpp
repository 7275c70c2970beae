#pragma once
/// @file
/// Eigenpairs to the last digits that the matrices allow.

#include <tautline/la/eigen_solver.hpp>

namespace tautline::la {

/// Sharpens each mode by inverse iteration with its residual in extended precision, lower modes and those
/// `known` kept out, and gives its Rayleigh quotient and residual. @throws LibraryError if K - shift M is
/// singular
void refine(const SymmetricMatrix& stiffness, const SymmetricMatrix& mass, double shift,
            const std::vector<Vector>& known, EigenPairs& pairs);

}  // namespace tautline::la
