#include <Eigen/Eigenvalues>
#include <formfinding/jacobian.hpp>
#include <limits>

namespace tautline::formfinding {

ConstraintJacobian::ConstraintJacobian(const NetSystem& system, const NetState& state,
                                       const ConstraintRows& rows, bool z_follows_surface)
    : system_(system), state_(state), solved_directions_(z_follows_surface ? 2 : 3) {
  const auto fill = [&](auto& matrix, const ConstraintRows::Entries& entries) {
    matrix.resize(static_cast<Eigen::Index>(rows.value.size()), system.n_branches());
    matrix.setFromTriplets(entries.begin(), entries.end());
  };
  fill(by_force_density_, rows.by_force_density);
  for (int d = 0; d < 3; ++d) fill(by_vector_[d], rows.by_vector[d]);
}

VecX ConstraintJacobian::apply(const VecX& dq) const {
  // D dx = -C^T U dq for each direction in equilibrium (eq. 2.61); the change of the branch vectors is C dx.
  const MatX branch_force = dq.asDiagonal() * state_.vectors.leftCols(solved_directions_);
  MatX dx(system_.n_free(), 3);
  dx.leftCols(solved_directions_) = -system_.solve(system_.at_free_nodes(branch_force));
  if (solved_directions_ == 2)
    dx.col(2) = state_.slope_x.cwiseProduct(dx.col(0)) + state_.slope_y.cwiseProduct(dx.col(1));
  const MatX du = system_.along_branches(dx);
  VecX change = by_force_density_ * dq;
  for (int d = 0; d < 3; ++d) change += by_vector_[d] * du.col(d);
  return change;
}

VecX ConstraintJacobian::apply_transposed(const VecX& y) const {
  MatX by_du(columns(), 3);
  for (int d = 0; d < 3; ++d) by_du.col(d) = by_vector_[d].transpose() * y;
  MatX by_dx = system_.at_free_nodes(by_du);
  if (solved_directions_ == 2) {
    by_dx.col(0) += state_.slope_x.cwiseProduct(by_dx.col(2));
    by_dx.col(1) += state_.slope_y.cwiseProduct(by_dx.col(2));
  }
  const MatX adjoint = system_.along_branches(system_.solve(by_dx.leftCols(solved_directions_)));
  return by_force_density_.transpose() * y -
         adjoint.cwiseProduct(state_.vectors.leftCols(solved_directions_)).rowwise().sum();
}

double condition_number(const ConstraintJacobian& jacobian) {
  MatX product(jacobian.rows(), jacobian.rows());
  for (Eigen::Index i = 0; i < jacobian.rows(); ++i)
    product.col(i) = jacobian.apply(jacobian.apply_transposed(VecX::Unit(jacobian.rows(), i)));
  const VecX eigenvalues = Eigen::SelfAdjointEigenSolver<MatX>(product, Eigen::EigenvaluesOnly).eigenvalues();
  const double largest = eigenvalues[eigenvalues.size() - 1];
  const double rounding =
      std::numeric_limits<double>::epsilon() * static_cast<double>(jacobian.rows()) * largest;
  return eigenvalues[0] > rounding ? largest / eigenvalues[0] : std::numeric_limits<double>::infinity();
}

}  // namespace tautline::formfinding
