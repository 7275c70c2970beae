#include <tautline/la/symmetric_matrix.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

#include <petscmat.h>

#include "la/check.hpp"

namespace tautline::la {

SymmetricMatrix::SymmetricMatrix(const BlockLayout& layout, const BlockPattern& pattern) : layout_(layout) {
  check(MatCreate(PETSC_COMM_WORLD, &mat_), "MatCreate");
  check(MatSetSizes(mat_, 3 * layout.local, 3 * layout.local, 3 * layout.total, 3 * layout.total),
        "MatSetSizes");
  check(MatSetBlockSize(mat_, 3), "MatSetBlockSize");
  check(MatSetType(mat_, MATSBAIJ), "MatSetType");
  check(MatSeqSBAIJSetPreallocation(mat_, 3, 0, pattern.diagonal.data()), "MatSeqSBAIJSetPreallocation");
  check(MatMPISBAIJSetPreallocation(mat_, 3, 0, pattern.diagonal.data(), 0, pattern.off_diagonal.data()),
        "MatMPISBAIJSetPreallocation");
  check(MatSetOption(mat_, MAT_IGNORE_LOWER_TRIANGULAR, PETSC_TRUE), "MatSetOption");
  check(MatSetOption(mat_, MAT_NO_OFF_PROC_ENTRIES, PETSC_TRUE), "MatSetOption");
  check(MatSetOption(mat_, MAT_SYMMETRIC, PETSC_TRUE), "MatSetOption");
  check(MatSetOption(mat_, MAT_SYMMETRY_ETERNAL, PETSC_TRUE), "MatSetOption");
}

SymmetricMatrix::~SymmetricMatrix() {
  if (mat_ != nullptr) MatDestroy(&mat_);
}

SymmetricMatrix::SymmetricMatrix(SymmetricMatrix&& other) noexcept
    : mat_(std::exchange(other.mat_, nullptr)), layout_(other.layout_) {}

SymmetricMatrix& SymmetricMatrix::operator=(SymmetricMatrix&& other) noexcept {
  std::swap(mat_, other.mat_);
  std::swap(layout_, other.layout_);
  return *this;
}

void SymmetricMatrix::set_zero() {
  check(MatZeroEntries(mat_), "MatZeroEntries");
}

void SymmetricMatrix::add(std::span<const int> blocks, const double* values) {
  const int n = static_cast<int>(blocks.size());
  std::array<int, 64> rows;  // PETSc passes over negative rows
  assert(blocks.size() <= rows.size());
  for (int i = 0; i < n; ++i) {
    const bool own = blocks[i] >= layout_.first && blocks[i] < layout_.first + layout_.local;
    rows[i] = own ? blocks[i] : -1;
  }
  check(MatSetValuesBlocked(mat_, n, rows.data(), n, blocks.data(), values, ADD_VALUES),
        "MatSetValuesBlocked");
}

void SymmetricMatrix::finish() {
  check(MatAssemblyBegin(mat_, MAT_FINAL_ASSEMBLY), "MatAssemblyBegin");
  check(MatAssemblyEnd(mat_, MAT_FINAL_ASSEMBLY), "MatAssemblyEnd");
}

void SymmetricMatrix::multiply(const Vector& x, Vector& y) const {
  check(MatMult(mat_, x.handle(), y.handle()), "MatMult");
}

template <class Visit>
void SymmetricMatrix::for_each_upper(const Visit& visit) const {
  check(MatGetRowUpperTriangular(mat_), "MatGetRowUpperTriangular");
  for (int row = 3 * layout_.first; row < 3 * (layout_.first + layout_.local); ++row) {
    PetscInt n = 0;
    const PetscInt* columns = nullptr;
    const PetscScalar* values = nullptr;
    check(MatGetRow(mat_, row, &n, &columns, &values), "MatGetRow");
    for (PetscInt k = 0; k < n; ++k)
      if (columns[k] >= row) visit(row, columns[k], values[k]);
    check(MatRestoreRow(mat_, row, &n, &columns, &values), "MatRestoreRow");
  }
  check(MatRestoreRowUpperTriangular(mat_), "MatRestoreRowUpperTriangular");
}

std::vector<long double> SymmetricMatrix::multiply_extended(const std::vector<double>& x) const {
  std::vector<long double> y(x.size(), 0.0L);
  for_each_upper([&](int row, int column, double value) {
    y[row] += static_cast<long double>(value) * x[column];
    if (column > row) y[column] += static_cast<long double>(value) * x[row];
  });
  MPI_Allreduce(MPI_IN_PLACE, y.data(), static_cast<int>(y.size()), MPI_LONG_DOUBLE, MPI_SUM,
                PETSC_COMM_WORLD);
  return y;
}

std::vector<double> SymmetricMatrix::absolute_row_sums() const {
  std::vector<double> sums(static_cast<std::size_t>(3 * layout_.total), 0.0);
  for_each_upper([&](int row, int column, double value) {
    sums[row] += std::abs(value);
    if (column > row) sums[column] += std::abs(value);
  });
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM,
                PETSC_COMM_WORLD);
  const auto first = sums.begin() + 3 * layout_.first;
  return {first, first + 3 * layout_.local};
}

std::vector<double> SymmetricMatrix::absolute_row_sums_of_blocks() const {
  auto sums = absolute_row_sums();
  for (std::size_t block = 0; block < sums.size(); block += 3) {
    const double most = std::max({sums[block], sums[block + 1], sums[block + 2], 1e-300});
    std::fill_n(sums.begin() + static_cast<long>(block), 3, most);
  }
  return sums;
}

void SymmetricMatrix::shift(double value) {
  check(MatShift(mat_, value), "MatShift");
}

void SymmetricMatrix::add_diagonal(double factor, const Vector& diagonal) {
  if (factor == 0) return;
  Vector scaled = Vector::like(diagonal);
  scaled.copy(diagonal);
  scaled.scale(factor);
  check(MatDiagonalSet(mat_, scaled.handle(), ADD_VALUES), "MatDiagonalSet");
}

SymmetricMatrix SymmetricMatrix::shifted(double value) const {
  SymmetricMatrix result;
  result.layout_ = layout_;
  check(MatDuplicate(mat_, MAT_COPY_VALUES, &result.mat_), "MatDuplicate");
  result.shift(value);
  return result;
}

SymmetricMatrix SymmetricMatrix::plus(double factor, const SymmetricMatrix& other) const {
  SymmetricMatrix result;
  result.layout_ = layout_;
  check(MatDuplicate(mat_, MAT_COPY_VALUES, &result.mat_), "MatDuplicate");
  check(MatAXPY(result.mat_, factor, other.mat_, SUBSET_NONZERO_PATTERN), "MatAXPY");
  return result;
}

double SymmetricMatrix::norm_of_diagonal() const {
  ::Vec diagonal = nullptr;
  check(MatCreateVecs(mat_, &diagonal, nullptr), "MatCreateVecs");
  check(MatGetDiagonal(mat_, diagonal), "MatGetDiagonal");
  PetscReal value = 0;
  check(VecNorm(diagonal, NORM_INFINITY, &value), "VecNorm");
  check(VecDestroy(&diagonal), "VecDestroy");
  return value;
}

}  // namespace tautline::la
