#include <formfinding/sparse_factor.hpp>

#include <cmath>

namespace tautline::formfinding {

int SparseFactor::factorise(int size, const Entries& lower) {
  matrix_.resize(size, size);
  matrix_.setFromTriplets(lower.begin(), lower.end());
  if (size == 0) return -1;
  if (!analysed_) solver_.analyzePattern(matrix_);
  analysed_ = true;
  solver_.factorize(matrix_);
  // A pivot is what elimination leaves of a diagonal entry; below rounding of that entry it is noise. In
  // order of elimination, as the solver stops at the first zero.
  const VecX pivots = solver_.vectorD();
  for (int k = 0; k < size; ++k) {
    const int i = solver_.permutationPinv().indices()[k];
    if (!(std::abs(pivots[k]) > 1e-14 * std::abs(matrix_.coeff(i, i)))) return i;
  }
  return -1;
}

Coordinates SparseFactor::solve(const Coordinates& right) const {
  // All three columns in one pass over L: the factor is read from memory, the columns stay in cache. The
  // nested expression is L without the ones on its diagonal.
  const int n = size();
  if (n == 0) return right;
  Coordinates x = solver_.permutationP() * right;
  const auto& L = solver_.matrixL().nestedExpression();
  using Iterator = Eigen::SparseMatrix<double>::InnerIterator;
  for (int j = 0; j < n; ++j) {
    const Eigen::RowVector3d xj = x.row(j);
    for (Iterator entry(L, j); entry; ++entry) x.row(entry.index()) -= entry.value() * xj;
  }
  const VecX pivots = solver_.vectorD();
  for (int j = n - 1; j >= 0; --j) {
    Eigen::RowVector3d xj = x.row(j) / pivots[j];
    for (Iterator entry(L, j); entry; ++entry) xj -= entry.value() * x.row(entry.index());
    x.row(j) = xj;
  }
  return solver_.permutationPinv() * x;
}

VecX SparseFactor::solve(const VecX& right) const {
  return size() > 0 ? VecX(solver_.solve(right)) : right;
}

int SparseFactor::negative_pivots() const {
  return size() > 0 ? static_cast<int>((solver_.vectorD().array() < 0).count()) : 0;
}

}  // namespace tautline::formfinding
