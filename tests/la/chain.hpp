#pragma once
// Chains of springs and masses, whose eigenvalues are known in closed form, as distributed matrices and
// vectors.

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <tautline/core/types.hpp>
#include <tautline/la/session.hpp>
#include <tautline/la/symmetric_matrix.hpp>
#include <tautline/la/vector.hpp>
#include <vector>

namespace tautline::la::testing_chain {

/// Blocks dealt out in equal shares.
inline BlockLayout layout_of(int blocks) {
  const auto begin = [&](int r) { return blocks * r / size(); };
  return {begin(rank()), begin(rank() + 1) - begin(rank()), blocks};
}

/// A full pattern: fine for a few blocks.
inline BlockPattern full_pattern(const BlockLayout& layout) {
  BlockPattern pattern;
  const int last = layout.first + layout.local;
  for (int row = layout.first; row < last; ++row) {
    pattern.diagonal.push_back(last - row);
    pattern.off_diagonal.push_back(layout.total - last);
  }
  return pattern;
}

/// Writes a dense matrix into `matrix`, as elements of one block and of two.
inline void fill(SymmetricMatrix& matrix, const MatX& dense) {
  matrix.set_zero();
  const int blocks = static_cast<int>(dense.rows()) / 3;
  for (int i = 0; i < blocks; ++i) {
    const Mat3 own = dense.block<3, 3>(3 * i, 3 * i);
    matrix.add(std::array{i}, own.data());
    for (int j = 0; j < i; ++j) {
      Mat<6> pair = Mat<6>::Zero();
      pair.topRightCorner<3, 3>() = dense.block<3, 3>(3 * i, 3 * j);
      pair.bottomLeftCorner<3, 3>() = dense.block<3, 3>(3 * j, 3 * i);
      matrix.add(std::array{i, j}, pair.data());
    }
  }
  matrix.finish();
}

inline SymmetricMatrix matrix_of(const MatX& dense) {
  const auto layout = layout_of(static_cast<int>(dense.rows()) / 3);
  SymmetricMatrix matrix(layout, full_pattern(layout));
  fill(matrix, dense);
  return matrix;
}

inline Vector vector_of(const VecX& dense) {
  const auto layout = layout_of(static_cast<int>(dense.size()) / 3);
  Vector vector(layout);
  vector.write(std::span(dense.data() + 3 * layout.first, static_cast<std::size_t>(3 * layout.local)));
  return vector;
}

inline VecX dense_of(const Vector& vector) {
  std::vector<double> all;
  vector.gather(all);
  return Eigen::Map<const VecX>(all.data(), static_cast<Eigen::Index>(all.size()));
}

/// Stiffness of n points joined by n + 1 springs of stiffness k, the outer two to the ground.
inline MatX held_chain(int n, double k) {
  MatX matrix = MatX::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    matrix(i, i) = 2 * k;
    if (i > 0) matrix(i, i - 1) = matrix(i - 1, i) = -k;
  }
  return matrix;
}

/// The same without the springs to the ground.
inline MatX free_chain(int n, double k) {
  MatX matrix = held_chain(n, k);
  matrix(0, 0) = matrix(n - 1, n - 1) = k;
  return matrix;
}

/// Eigenvalue j = 1 ... n of held_chain(n, k).
inline double held_chain_eigenvalue(int n, double k, int j) {
  return 4 * k * std::pow(std::sin(j * std::numbers::pi / (2 * (n + 1))), 2);
}

}  // namespace tautline::la::testing_chain
