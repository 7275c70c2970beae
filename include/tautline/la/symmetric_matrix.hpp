#pragma once
/// @file
/// Distributed symmetric matrix of 3 x 3 blocks, upper triangle stored: RAII over PETSc SBAIJ.

#include <span>
#include <vector>

#include <tautline/la/vector.hpp>

struct _p_Mat;

namespace tautline::la {

/// Number of blocks in each owned block row of the upper triangle: in the rank's own columns, and in later
/// ranks' columns.
struct BlockPattern {
  std::vector<int> diagonal, off_diagonal;
};

class SymmetricMatrix {
 public:
  SymmetricMatrix(const BlockLayout& layout, const BlockPattern& pattern);
  ~SymmetricMatrix();
  SymmetricMatrix(SymmetricMatrix&& other) noexcept;
  SymmetricMatrix& operator=(SymmetricMatrix&& other) noexcept;
  SymmetricMatrix(const SymmetricMatrix&) = delete;
  SymmetricMatrix& operator=(const SymmetricMatrix&) = delete;

  _p_Mat* handle() const noexcept { return mat_; }
  void set_zero();
  /// Adds the rows of a dense symmetric element matrix that this rank owns; `values` is 3n x 3n for n =
  /// blocks.size(). Every rank that owns one of the blocks must add the element.
  void add(std::span<const int> blocks, const double* values);
  void finish();  ///< collective; after the last add
  /// A x in extended precision, whole on every rank: for results that are small differences of large terms.
  /// Collective.
  std::vector<long double> multiply_extended(const std::vector<double>& x) const;
  /// y = A x
  void multiply(const Vector& x, Vector& y) const;
  /// Adds `value` to the diagonal.
  void shift(double value);
  /// Adds `factor` times the entries of `diagonal` to the diagonal.
  void add_diagonal(double factor, const Vector& diagonal);
  /// A copy with `value` added to the diagonal.
  SymmetricMatrix shifted(double value) const;
  /// A copy with `factor` times `other` added, whose pattern must lie within this one's.
  SymmetricMatrix plus(double factor, const SymmetricMatrix& other) const;
  double norm_of_diagonal() const;
  /// Sums of |A_ij| over each of this rank's own rows. Collective.
  std::vector<double> absolute_row_sums() const;
  /// In all three rows of a block the largest of these sums, or a tiny value above zero. Collective.
  std::vector<double> absolute_row_sums_of_blocks() const;

 private:
  SymmetricMatrix() = default;
  /// Calls visit(row, column, value) for this rank's entries on and above the diagonal.
  template <class Visit>
  void for_each_upper(const Visit& visit) const;

  _p_Mat* mat_ = nullptr;
  BlockLayout layout_;
};

}  // namespace tautline::la
