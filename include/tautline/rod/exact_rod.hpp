#pragma once
/// @file
/// The inextensible rod without approximation: X' = cos theta, Y' = sin theta, M = EI theta', M' = -N_k sin
/// theta on each link, joined at the nodes and solved by multiple shooting. Theory: docs/theory/rod.md

#include <tautline/rod/solution.hpp>

namespace tautline::rod {

/// @brief Inverse problem: reactions that bring the nodes onto the surface (form A) or onto the target's
/// nodes with lengths found (form B). Starts from the target, with the reactions that the
/// cantilever model finds.
RodSolution design_exact(const Umbrella& umbrella, const ExactOptions& options);

/// Equilibrium under given constant forces [N], from angles `start` of the nodes [rad].
RodSolution load_exact(const Rod& rod, const VecX& reactions, const VecX& start, const ExactOptions& options);

/// @brief Forward problem: the root is turned from the straight rod to the stop while cables of given
/// stiffness E_T F_k [N] bend the rod.
/// @param lengths of the links, e.g. of form B; the cables are cut for them [m]
RodSolution turn_exact(const Umbrella& umbrella, const VecX& lengths, const VecX& stiffness,
                       const ExactOptions& options);

}  // namespace tautline::rod
