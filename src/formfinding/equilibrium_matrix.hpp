#pragma once
/// @file
/// The equilibrium matrix of a pin-jointed net and its four subspaces.

#include <vector>

#include <Eigen/SparseCore>

#include <tautline/formfinding/net.hpp>

namespace tautline::formfinding {

/// @brief A t = forces of members with tensions t on the free coordinates of the nodes.
///
/// A node has three free coordinates, those of a guide fewer, a fixed one none.
class EquilibriumMatrix {
 public:
  explicit EquilibriumMatrix(const Net& net);

  int equations() const { return equations_; }
  const Eigen::SparseMatrix<double>& matrix() const { return matrix_; }
  /// Stiffness of force densities on the free coordinates: q (1, -1) for each component.
  Eigen::SparseMatrix<double> geometric(const VecX& force_density) const;
  /// Displacement of each node for a vector of free coordinates.
  Points displacements(const VecX& x) const;
  /// Orthonormal basis of the rigid motions that fixed and guided nodes leave.
  MatX rigid_motions() const;

 private:
  const Net& net_;
  std::vector<MatX> directions_;  // of each node: 3 x free coordinates
  std::vector<int> first_;        // of each node: its first coordinate
  int equations_ = 0;
  Eigen::SparseMatrix<double> matrix_;
};

/// Null spaces of a matrix by rank.
struct NullSpaces {
  MatX right;           ///< orthonormal basis of A t = 0
  MatX left;            ///< orthonormal basis of A^T d = 0
  double smallest = 0;  ///< singular value that counts, over the largest; 0: none counts
  double dropped = 0;   ///< largest singular value that counts as zero, over the largest
};

/// By singular values where both dimensions are at most `dense_limit` or the sparse way leaves doubt, else by
/// sparse QR with a check of its smallest singular value.
NullSpaces null_spaces(const Eigen::SparseMatrix<double>& a, double tolerance, int dense_limit);

}  // namespace tautline::formfinding
