#pragma once
/// @file
/// Sparse LDL^T of a symmetric matrix for three right-hand sides at a time.

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <tautline/core/types.hpp>
#include <vector>

namespace tautline::formfinding {

/// Row = node, branch or unknown; column = direction. Stored row by row, as it is gathered.
using Coordinates = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// A = L D L^T with a fill-reducing order, without pivoting. The pattern is analysed once.
class SparseFactor {
 public:
  using Entries = std::vector<Eigen::Triplet<double>>;

  /// @param[in] lower  entries of the lower triangle, repeated ones are added; always the same pattern
  /// @return index of the first unknown whose pivot is only rounding of its diagonal entry; -1 if there is
  /// none
  int factorise(int size, const Entries& lower);
  /// A^-1 `right` [size x 3]
  Coordinates solve(const Coordinates& right) const;
  VecX solve(const VecX& right) const;
  int negative_pivots() const;
  int size() const noexcept { return static_cast<int>(matrix_.rows()); }

 private:
  Eigen::SparseMatrix<double> matrix_;  ///< lower triangle
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
  bool analysed_ = false;
};

}  // namespace tautline::formfinding
