#pragma once
/// @file
/// Whether a bent rod is a minimum of energy among its plane neighbours. Theory: docs/theory/rod.md

#include <tautline/rod/shape.hpp>

namespace tautline::rod {

/// Eigenvalues of the energy's second variation relative to that of the bending energy: 1 for a free rod.
struct Stability {
  int unstable = 0;  ///< how many are negative
  double least = 1;  ///< [-]
};

/// Of two quadratic forms, the second one positive.
Stability compare_forms(const MatX& energy, const MatX& bending);

/// Of the exact rod.
/// @param slopes dR_k/dX_k of the node forces [N/m]; zero for constant forces
Stability judge_stability(const RodShape& shape, const VecX& slopes);

}  // namespace tautline::rod
