#include <gtest/gtest.h>

#include <tautline/la/eigen_solver.hpp>

#include "la/chain.hpp"

namespace tautline::la {
namespace {

using namespace testing_chain;

/// A diagonal A with eigenvalues of both signs beside a chain B, in a basis in which neither is diagonal.
struct Pencil {
  MatX a, b;
  VecX values;
};

Pencil pencil() {
  const int n = 12;
  const MatX b = held_chain(n, 2);
  const MatX root = b.llt().matrixL();
  VecX values = VecX::Zero(n);
  values.head(6) << 5, -4, 3, 3, -2, 1;
  // An orthogonal matrix that mixes all.
  const VecX v = VecX::LinSpaced(n, 1, 3).normalized();
  const MatX q = MatX::Identity(n, n) - 2 * v * v.transpose();
  const MatX a = root * q * values.asDiagonal() * q.transpose() * root.transpose();
  return {(a + a.transpose()) / 2, b, values};
}

TEST(Extreme, FindsTheEigenvaluesFarthestFromZero) {
  const auto p = pencil();
  const auto pairs = solve_extreme(matrix_of(p.a), matrix_of(p.b), 5, Extreme::both);
  ASSERT_EQ(pairs.values.size(), 5u);
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(pairs.values[i], p.values[i], 1e-10) << "the double eigenvalue is found twice";
    EXPECT_LT(pairs.residuals[i], 1e-9);
    const VecX x = dense_of(pairs.vectors[i]);
    EXPECT_NEAR(x.dot(p.b * x), 1, 1e-10);
  }
}

TEST(Extreme, KeepsToTheSideAskedForAndToWhatThereIs) {
  const auto p = pencil();
  const auto low = solve_extreme(matrix_of(p.a), matrix_of(p.b), 4, Extreme::lowest);
  ASSERT_EQ(low.values.size(), 2u) << "only two are negative; zeros are no eigenvalues of interest";
  EXPECT_NEAR(low.values[0], -4, 1e-10);
  EXPECT_NEAR(low.values[1], -2, 1e-10);
  const auto high = solve_extreme(matrix_of(p.a), matrix_of(p.b), 2, Extreme::highest);
  ASSERT_EQ(high.values.size(), 2u);
  EXPECT_NEAR(high.values[0], 5, 1e-10);
  EXPECT_NEAR(high.values[1], 3, 1e-10);
}

TEST(SymmetricMatrix, SumsTheMagnitudesOfItsRows) {
  const MatX dense = held_chain(9, 2) - 7 * MatX::Identity(9, 9);
  const auto sums = matrix_of(dense).absolute_row_sums();
  const VecX exact = dense.cwiseAbs().rowwise().sum();
  const auto layout = layout_of(3);
  for (std::size_t i = 0; i < sums.size(); ++i)
    EXPECT_EQ(sums[i], exact[3 * layout.first + static_cast<int>(i)]);
}

}  // namespace
}  // namespace tautline::la
