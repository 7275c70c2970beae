#pragma once
/// @file
/// Derivative of the constraints with respect to the force densities (eqs 2.56-2.72), as an operator: never
/// formed.

#include <array>
#include <formfinding/constraint.hpp>

namespace tautline::formfinding {

/// G^T, rows = constraints, columns = branches.
class ConstraintJacobian {
 public:
  /// @param[in] system  factorised at state.force_density; system and state must outlive this object
  ConstraintJacobian(const NetSystem& system, const NetState& state, const ConstraintRows& rows);

  Eigen::Index rows() const noexcept { return by_force_density_.rows(); }
  Eigen::Index columns() const noexcept { return by_force_density_.cols(); }
  /// Columns of branches whose force density does not move become zero.
  void hold(const std::vector<bool>& held) { held_ = held; }
  /// G^T dq
  VecX apply(const VecX& dq) const;
  /// G y
  VecX apply_transposed(const VecX& y) const;
  /// The whole matrix, rows x columns; one solve for each row.
  MatX dense() const;

 private:
  VecX without_held(VecX dq) const;
  /// Subtracts its mean from every range of rows that asks only for equality.
  VecX centre(VecX rows) const;

  const NetSystem& system_;
  const NetState& state_;
  std::vector<bool> held_;
  std::vector<std::array<int, 2>> centred_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> by_force_density_;
  std::array<Eigen::SparseMatrix<double, Eigen::RowMajor>, 3> by_vector_;
};

/// Ratio of the largest to the smallest eigenvalue of G^T G (rows x rows); infinite if it is singular. Dense:
/// n^3.
double condition_number(const ConstraintJacobian& jacobian);

}  // namespace tautline::formfinding
