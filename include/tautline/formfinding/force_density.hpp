#pragma once
/// @file
/// Force density method: linear solve and the nonlinear solve with prescribed tensions. Sparse throughout.
/// Source: Belov (2021), ch. 2, after Schek (1974). Theory: docs/theory/force_density.md

#include <functional>
#include <string>
#include <vector>

#include <tautline/core/types.hpp>
#include <tautline/formfinding/force_density_options.hpp>
#include <tautline/formfinding/net.hpp>

namespace tautline::formfinding {

/// Positions of all nodes for given force densities: D x = f - D_f x_f (eq. 2.12), with D = C^T Q C.
/// With a surface, x and y come from equilibrium and z from the surface (eq. 3.9).
/// @param[in] force_density  one for each branch [N/m]
/// @throws ModelError if D is singular: names a free node that hangs on nothing.
Points solve_linear(const Net& net, const VecX& force_density, const Surface* surface = nullptr);

/// What the nonlinear solve found.
struct ForceDensityResult {
  bool converged = false;
  std::string reason;                          ///< one sentence with both sides of the inequality
  Points nodes;                                ///< all nodes [m]
  VecX force_density;                          ///< [N/m]
  VecX tension;                                ///< q L [N]
  VecX residual_z;                             ///< force each node needs along z to be in equilibrium on the surface, one for each node [N]
  int iterations = 0;
  std::vector<double> constraint_residual;     ///< max |T - T_target| before the first and after each iteration [N]
  std::vector<double> constraint_residual_norm;///< its Euclidean norm [N]
  std::vector<Vec3> coordinate_norm;           ///< |x|, |y|, |z| over free nodes after each iteration [m]
  std::vector<double> step_relaxation;         ///< alpha of eq. (2.25) in each iteration
  double out_of_balance = 0;                   ///< largest nodal force at a free node along the directions in equilibrium [N]
  double condition_number = 0;                 ///< estimate of cond(G^T G); 0 if not computed
};

/// @brief Finds force densities with the tensions asked for (eqs 2.13-2.26, minimal-norm step 2.53, relaxation 2.25).
///
/// @param[in] target  prescribed tension for each branch [N]; NaN leaves the branch's force density free,
///                    see ForceDensityOptions::free_branches
/// @param[in] progress  called after each iteration with (iteration, residual); may be empty
ForceDensityResult find_tensions(const Net& net, const VecX& target, const Surface* surface,
                                 const ForceDensityOptions& options,
                                 const std::function<void(int, double)>& progress = {});

}  // namespace tautline::formfinding
