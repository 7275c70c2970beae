#pragma once
/// @file
/// Newton's method on the positions of a net whose branches carry given tensions or given force densities.

#include <string>
#include <formfinding/net_system.hpp>
#include <functional>
#include <vector>

namespace tautline::formfinding {

struct PositionResult {
  bool converged = false;
  bool collapsed = false;  ///< nodes ran together: the shape cannot be solved for
  NetState state;          ///< its force densities are T/L where a tension is given
  std::vector<double>
      residual;  ///< largest force out of balance before the first and after each iteration [N]
  std::vector<double> relaxation;
  int iterations = 0, inner_iterations = 0, factorisations = 0;

  /// One sentence with both sides of the inequality and, if not converged, what to try.
  /// @param[in] limit  of the largest force out of balance [N]
  std::string reason(double limit) const;
};

/// @brief Equilibrium of the free nodes for tensions `tension`, or force densities where that is NaN.
///
/// A few sweeps q <- T/L give the start. Each Newton step is solved by GMRES with the factors of D from the
/// last sweep as preconditioner: D differs from the true derivative only by the axial part q e e^T of every
/// branch, so that the number of products grows slowly with the size of the net, and one factor serves all.
/// @param[in] force_density  to start from, and for good where no tension is given [N/m]
/// @param[in] tolerance      of the largest force out of balance [N]
/// @throws ModelError if D is singular at the start
PositionResult find_positions(NetSystem& system, const VecX& tension, const VecX& force_density,
                              double tolerance, int max_iterations,
                              const std::function<void(int, double)>& progress = {});

/// Force densities that a shape calls for [N/m].
using DensityOfShape = std::function<VecX(const NetState&)>;

/// Another rule than equilibrium for where nodes lie, in some directions.
struct PlaceRule {
  /// Replaces forces on the free nodes by what counts as out of balance.
  std::function<void(const NetState&, Coordinates& force)> force;
  /// Replaces the displacements of the free nodes under these forces, in the same directions.
  std::function<void(const NetState&, const Coordinates& force, Coordinates& step)> step;
};

/// @brief The fixed point "equilibrium for the force densities of the shape before", accelerated by
/// Anderson's method on the free nodes.
///
/// Needs no derivative, hence also finds nets whose nodes may slide along their cables, and films.
/// @param[in] rule  what counts as out of balance in place of the forces; both parts or none
PositionResult find_fixed_point(NetSystem& system, const DensityOfShape& density, const NetState& start,
                                double tolerance, int max_iterations, const PlaceRule& rule = {},
                                const std::function<void(int, double)>& progress = {});

/// The same for given tensions: q <- T/L.
PositionResult find_fixed_point(NetSystem& system, const VecX& tension, const VecX& force_density,
                                double tolerance, int max_iterations,
                                const std::function<void(int, double)>& progress = {});

}  // namespace tautline::formfinding
