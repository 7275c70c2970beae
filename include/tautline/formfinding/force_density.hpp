#pragma once
/// @file
/// Force density method: linear solve and the nonlinear solve with prescribed tensions. Sparse throughout.
/// Source: Belov (2021), ch. 2, after Schek (1974). Theory: docs/theory/force_density.md

#include <functional>
#include <string>
#include <tautline/core/types.hpp>
#include <tautline/formfinding/force_density_options.hpp>
#include <tautline/formfinding/net.hpp>
#include <vector>

namespace tautline::formfinding {

/// Positions of all nodes for given force densities: D x = f - D_f x_f (eq. 2.12), with D = C^T Q C.
/// With a surface, x and y come from equilibrium and z from the surface (eq. 3.9).
/// @param[in] force_density  one for each branch [N/m]
/// @throws ModelError if D is singular: names a free node that hangs on nothing.
Points solve_linear(const Net& net, const VecX& force_density, const Surface* surface = nullptr);

/// What given force densities make of a net.
struct LinearForm {
  Points nodes;                 ///< all nodes [m]
  VecX tension;                 ///< q L [N]; negative: compression
  VecX length;                  ///< [m]
  Points reaction;              ///< force that each node still needs: of supports, ties and guides [N]
  double out_of_balance = 0;    ///< largest force at a free node along the directions in equilibrium [N]
  int negative_directions = 0;  ///< negative eigenvalues of D, over all directions
  std::vector<std::string> warnings;  ///< compression members, indefiniteness
};

/// @brief solve_linear, with everything that follows from it.
///
/// Negative force densities (compression members) are allowed. If D is indefinite with them, the shape is in
/// equilibrium but not stable as a net of constant force densities; a warning says so.
LinearForm find_linear_form(const Net& net, const VecX& force_density, const Surface* surface = nullptr);

/// @brief What the nonlinear solve found.
///
/// residual_z = -(sum of q (z_j - z_i) over the branches of node i + load_z): at a free node on a surface
/// what the ties must exert, negative where they pull down, so that the tension of a tie below is
/// -residual_z; without a surface zero but for rounding. At a fixed node it is the z component of the
/// support's reaction.
struct ForceDensityResult {
  bool converged = false;
  std::string reason;  ///< one sentence with both sides of the inequality
  Points nodes;        ///< all nodes [m]
  VecX force_density;  ///< [N/m]
  VecX tension;        ///< q L [N]
  VecX residual_z;     ///< force along z that each node still needs, one for each node [N]
  int iterations = 0;
  /// max |T - T_target| before the first and after each iteration [N]; where the positions are the unknowns
  /// the tensions are met throughout, and this is the largest force out of balance [N]
  std::vector<double> constraint_residual;
  std::vector<double> constraint_residual_norm;  ///< Euclidean norm of T - T_target, likewise [N]
  std::vector<Vec3> coordinate_norm;             ///< |x|, |y|, |z| over free nodes after each iteration [m]
  std::vector<double> step_relaxation;           ///< alpha of eq. (2.25) in each iteration
  double out_of_balance = 0;  ///< largest nodal force at a free node along the directions in equilibrium [N]
  double condition_number = 0;                                  ///< cond(G^T G) at the end; 0 if not computed
  TensionMethod method = TensionMethod::step_of_smallest_norm;  ///< that found it
  int inner_iterations = 0;                                     ///< of the linear solver, in all
};

/// @brief Finds force densities with the tensions asked for (eqs 2.13-2.26, minimal-norm step 2.53,
/// relaxation 2.25).
///
/// Does not throw because of the iteration: `converged` and `reason` tell.
/// @param[in] target  prescribed tension for each branch [N], positive; NaN leaves the branch's force density
///                    to the step of smallest norm over all branches
/// @param[in] progress  called after each iteration with (iteration, residual); may be empty
/// @throws ModelError if a target is not positive, the net makes no sense, or a free node hangs on no fixed
/// one
ForceDensityResult find_tensions(const Net& net, const VecX& target, const Surface* surface,
                                 const ForceDensityOptions& options,
                                 const std::function<void(int, double)>& progress = {});

}  // namespace tautline::formfinding
