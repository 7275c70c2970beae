#pragma once
/// @file
/// Constraints g(x, y, z, q) = 0 on a net (eqs 2.62-2.73) as rows that know their derivatives with respect to
/// the branch vectors (u, v, w) and the force densities. How those follow the force densities is the
/// Jacobian's business.

#include <Eigen/SparseCore>
#include <array>
#include <formfinding/net_system.hpp>
#include <tautline/formfinding/constraints.hpp>

namespace tautline::formfinding {

/// Rows of constraints, value - target = 0 each, divided by a scale of their own.
struct ConstraintRows {
  using Entries = std::vector<Eigen::Triplet<double>>;  ///< (row, branch, derivative)
  std::vector<double> value, target;
  std::vector<double> scale;   ///< [unit of the value]
  std::vector<double> weight;  ///< of the square of each row where they are weighed against each other
  Entries by_force_density;
  std::array<Entries, 3> by_vector;         ///< one for each direction
  std::vector<std::array<int, 2>> centred;  ///< (first row, count): only differences from the mean count
  /// Second derivatives of a row by the force density q and the length L of one branch, and the first by L.
  struct Curvature {
    int row, branch;
    double by_L, by_qL, by_qq, by_LL;
  };
  std::vector<Curvature> curvature;
  /// Rows with the product of q and one component of the branch vector: (row, branch, factor) by direction.
  std::array<Entries, 3> by_product;

  /// Right-hand side r = target - value of eq. (2.16).
  VecX missing() const;
};

/// Tension q L = target of every branch whose target is not NaN (eqs 2.62, 2.63) [N], not scaled.
void add_tensions(const NetState& state, const VecX& target, ConstraintRows& rows);

/// @brief Appends the rows of one constraint (2.62-2.71).
/// @param[in] axial_stiffness  EA of every branch [N]; needed for unstressed lengths
/// @param[in] force_scale  by which rows without a force of their own are divided [N]
void add_constraint(const NetSystem& system, const NetState& state, const Constraint& constraint,
                    const VecX& axial_stiffness, double force_scale, ConstraintRows& rows);

}  // namespace tautline::formfinding
