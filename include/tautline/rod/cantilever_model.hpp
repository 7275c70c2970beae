#pragma once
/// @file
/// The paper's model: each link a cantilever in the frame of the node before it, bent as a cubic and
/// shortened to second order. Source: Russkikh & Shklyarchuk (2021), eqs (2.1)-(3.5). Theory:
/// docs/theory/rod.md

#include <optional>

#include <tautline/rod/solution.hpp>

namespace tautline::rod {

/// @brief Inverse problem: reactions that bend the rod to the target, eqs (3.1)-(3.3).
///
/// Only the component of each node across the frame of the node before is imposed, so that the nodes slip
/// along the links. Moments use the target's Y, as in the paper's tables 4 and 5. The stability is that of
/// the rod with cables of the stiffnesses found.
/// @param start angles theta_k to begin with [rad]; not given: the target's
RodSolution design_cantilevers(const Umbrella& umbrella, const CantileverOptions& options,
                               const std::optional<VecX>& start = {});

/// Equilibrium under given constant forces, eq. (2.9), by Newton's method from angles `start` [rad].
RodSolution load_cantilevers(const Rod& rod, const VecX& reactions, const VecX& start,
                             const CantileverOptions& options);

/// @brief Forward problem: the root is turned from the straight rod to the stop, cables of given stiffness
/// E_T F_k [N] stretch and bend the rod.
RodSolution turn_cantilevers(const Umbrella& umbrella, const VecX& stiffness,
                             const CantileverOptions& options);

}  // namespace tautline::rod
