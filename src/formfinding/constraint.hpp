#pragma once
/// @file
/// Constraints g(x, y, z, q) = 0 on a net (eqs 2.62-2.73) as rows that know their derivatives with respect to
/// the branch vectors (u, v, w) and the force densities. How those follow the force densities is the
/// Jacobian's business.

#include <Eigen/SparseCore>
#include <array>
#include <formfinding/net_system.hpp>
#include <vector>

namespace tautline::formfinding {

/// A net in the shape that some force densities give it.
struct NetState {
  VecX force_density;     ///< [N/m]
  Coordinates nodes;      ///< all nodes [m]
  Coordinates vectors;    ///< second minus first end of every branch [m]
  VecX length;            ///< [m]
  VecX slope_x, slope_y;  ///< dz/dx, dz/dy of the surface at the free nodes; empty without a surface
};

/// Rows of constraints, value - target = 0 each. A new kind of constraint is one more function that appends
/// rows.
struct ConstraintRows {
  using Entries = std::vector<Eigen::Triplet<double>>;  ///< (row, branch, derivative)
  std::vector<double> value, target;
  Entries by_force_density;
  std::array<Entries, 3> by_vector;  ///< one for each direction

  /// Right-hand side r = target - value of eq. (2.16).
  VecX missing() const;
};

/// Tension q L = target of every branch whose target is not NaN (eqs 2.62, 2.63) [N].
void add_tensions(const NetState& state, const VecX& target, ConstraintRows& rows);

}  // namespace tautline::formfinding
