#include <formfinding/jacobian.hpp>

#include <Eigen/Eigenvalues>
#include <limits>

namespace tautline::formfinding {

ConstraintJacobian::ConstraintJacobian(const NetSystem& system, const NetState& state,
                                       const ConstraintRows& rows)
    : system_(system), state_(state), centred_(rows.centred) {
  const auto fill = [&](auto& matrix, const ConstraintRows::Entries& entries) {
    matrix.resize(static_cast<Eigen::Index>(rows.value.size()), system.n_branches());
    matrix.setFromTriplets(entries.begin(), entries.end());
  };
  fill(by_force_density_, rows.by_force_density);
  for (int d = 0; d < 3; ++d) fill(by_vector_[d], rows.by_vector[d]);
}

VecX ConstraintJacobian::without_held(VecX dq) const {
  for (std::size_t b = 0; b < held_.size(); ++b)
    if (held_[b]) dq[static_cast<Eigen::Index>(b)] = 0;
  return dq;
}

VecX ConstraintJacobian::centre(VecX rows) const {
  for (const auto& [first, count] : centred_)
    rows.segment(first, count).array() -= rows.segment(first, count).mean();
  return rows;
}

VecX ConstraintJacobian::apply(const VecX& all_dq) const {
  // D dx = -C^T U dq for each direction in equilibrium (eq. 2.61); the change of the branch vectors is C dx.
  const VecX dq = without_held(all_dq);
  const Coordinates force = -system_.at_free_nodes(dq.asDiagonal() * state_.vectors);
  const Coordinates du = system_.along_branches(system_.respond(state_, force));
  VecX change = by_force_density_ * dq;
  for (int d = 0; d < 3; ++d) change += by_vector_[d] * du.col(d);
  return centre(std::move(change));
}

VecX ConstraintJacobian::apply_transposed(const VecX& all_rows) const {
  const VecX y = centre(all_rows);
  Coordinates by_du(columns(), 3);
  for (int d = 0; d < 3; ++d) by_du.col(d) = by_vector_[d].transpose() * y;
  const Coordinates by_dx = system_.at_free_nodes(by_du);
  const Coordinates adjoint = system_.along_branches(system_.respond_transposed(state_, by_dx));
  return without_held(by_force_density_.transpose() * y -
                      adjoint.cwiseProduct(state_.vectors).rowwise().sum());
}

MatX ConstraintJacobian::dense() const {
  MatX matrix(rows(), columns());
  for (Eigen::Index i = 0; i < rows(); ++i) matrix.row(i) = apply_transposed(VecX::Unit(rows(), i));
  return matrix;
}

double condition_number(const ConstraintJacobian& jacobian) {
  const MatX matrix = jacobian.dense();
  const VecX eigenvalues =
      Eigen::SelfAdjointEigenSolver<MatX>(matrix * matrix.transpose(), Eigen::EigenvaluesOnly).eigenvalues();
  const double largest = eigenvalues[eigenvalues.size() - 1];
  const double rounding =
      std::numeric_limits<double>::epsilon() * static_cast<double>(jacobian.rows()) * largest;
  return eigenvalues[0] > rounding ? largest / eigenvalues[0] : std::numeric_limits<double>::infinity();
}

}  // namespace tautline::formfinding
