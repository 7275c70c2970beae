#pragma once
/// @file
/// Derivative of the constraints with respect to the force densities (eqs 2.56-2.64), as an operator: never
/// formed.

#include <array>
#include <formfinding/constraint.hpp>

namespace tautline::formfinding {

/// G^T, rows = constraints, columns = branches.
class ConstraintJacobian {
 public:
  /// @param[in] system  factorised at state.force_density; both must outlive this object
  /// @param[in] z_follows_surface  dz = z_x dx + z_y dy if true, else dz from vertical equilibrium (eq. 2.61)
  ConstraintJacobian(const NetSystem& system, const NetState& state, const ConstraintRows& rows,
                     bool z_follows_surface);

  Eigen::Index rows() const noexcept { return by_force_density_.rows(); }
  Eigen::Index columns() const noexcept { return by_force_density_.cols(); }
  /// G^T dq
  VecX apply(const VecX& dq) const;
  /// G y
  VecX apply_transposed(const VecX& y) const;

 private:
  const NetSystem& system_;
  const NetState& state_;
  int solved_directions_;  ///< x, y and perhaps z follow from equilibrium
  Eigen::SparseMatrix<double, Eigen::RowMajor> by_force_density_;
  std::array<Eigen::SparseMatrix<double, Eigen::RowMajor>, 3> by_vector_;
};

/// Ratio of the largest to the smallest eigenvalue of G^T G (rows x rows); infinite if it is singular. Dense:
/// n^3.
double condition_number(const ConstraintJacobian& jacobian);

}  // namespace tautline::formfinding
