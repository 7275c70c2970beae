#include <tautline/la/direct_solver.hpp>

#include "la/chain.hpp"

namespace tautline::la {
namespace {

using namespace testing_chain;

VecX some_load(int n) {
  VecX b(n);
  for (int i = 0; i < n; ++i) b[i] = std::cos(3.0 * i) + 0.1 * i;
  return b;
}

TEST(DirectSolver, SolvesADefiniteSystem) {
  const MatX k = held_chain(12, 1e5);
  const VecX b = some_load(12);
  const auto matrix = matrix_of(k);
  DirectSolver solver;
  ASSERT_TRUE(solver.factor(matrix));
  Vector x(layout_of(4));
  solver.solve(vector_of(b), x);
  EXPECT_LT((k * dense_of(x) - b).norm(),
            1e-13 * b.norm() * 100);  // condition number of the chain: 4 (n + 1)^2 / pi^2
  EXPECT_EQ(solver.inertia().negative, 0);
  EXPECT_EQ(solver.inertia().null, 0);
}

TEST(DirectSolver, CountsTheNegativeEigenvaluesOfAnIndefiniteMatrix) {
  // Sylvester: K - s I has as many negative pivots as K has eigenvalues below s.
  const int n = 15;
  const MatX k = held_chain(n, 1);
  for (int below = 0; below <= n; ++below) {
    const double lower = below == 0 ? -1 : held_chain_eigenvalue(n, 1, below);
    const double upper = below == n ? 5 : held_chain_eigenvalue(n, 1, below + 1);
    const auto matrix = matrix_of(k - 0.5 * (lower + upper) * MatX::Identity(n, n));
    DirectSolver solver;
    ASSERT_TRUE(solver.factor(matrix));
    EXPECT_EQ(solver.inertia().negative, below);
    EXPECT_EQ(solver.inertia().null, 0);
  }
}

TEST(DirectSolver, SolvesAnIndefiniteSystem) {
  const MatX k = held_chain(15, 1) - 1.1 * MatX::Identity(15, 15);
  const VecX b = some_load(15);
  const auto matrix = matrix_of(k);
  DirectSolver solver;
  ASSERT_TRUE(solver.factor(matrix));
  Vector x(layout_of(5));
  solver.solve(vector_of(b), x);
  EXPECT_LT((k * dense_of(x) - b).norm(), 1e-11 * b.norm());
}

/// Null pivots found, or -1 if the matrix was refused as singular.
int null_pivots(const MatX& dense) {
  const auto matrix = matrix_of(dense);
  DirectSolver solver;
  if (solver.factor(matrix)) return solver.inertia().null;
  EXPECT_FALSE(solver.failure().empty());
  return -1;
}

TEST(DirectSolver, FindsTheRigidBodyMotionOfAFreeChain) {
  for (const double stiffness : {1e-3, 1.0, 1e7}) {
    const int found = null_pivots(free_chain(12, stiffness));
    EXPECT_TRUE(found == 1 || found == -1) << found;
  }
}

TEST(DirectSolver, FindsEveryRigidBodyMotionOfThreeFreeChains) {
  MatX k = MatX::Zero(12, 12);
  for (int i = 0; i < 3; ++i) k.block(4 * i, 4 * i, 4, 4) = free_chain(4, 1 + i);
  const int found = null_pivots(k);
  EXPECT_TRUE(found == 3 || found == -1) << found;
}

TEST(DirectSolver, FindsNoNullPivotInAStiffAndASoftPart) {
  // Nine decades between the springs are ordinary: cables beside cloth.
  MatX k = held_chain(12, 1);
  k.topLeftCorner(6, 6) += 1e9 * held_chain(6, 1);
  EXPECT_EQ(null_pivots(k), 0);
}

TEST(DirectSolver, IsOfUseAgainAfterASingularMatrix) {
  DirectSolver solver;
  auto matrix = matrix_of(free_chain(12, 1));
  solver.factor(matrix);
  const MatX k = held_chain(12, 2);
  fill(matrix, k);
  ASSERT_TRUE(solver.factor(matrix));
  EXPECT_EQ(solver.inertia().null, 0);
  EXPECT_TRUE(solver.failure().empty());
  const VecX b = some_load(12);
  Vector x(layout_of(4));
  solver.solve(vector_of(b), x);
  EXPECT_LT((k * dense_of(x) - b).norm(), 1e-11 * b.norm());
}

TEST(DirectSolver, FactorsAgainWhenTheMatrixHasChanged) {
  auto matrix = matrix_of(held_chain(12, 1));
  DirectSolver solver;
  const VecX b = some_load(12);
  Vector once(layout_of(4)), twice(layout_of(4));
  ASSERT_TRUE(solver.factor(matrix));
  solver.solve(vector_of(b), once);
  fill(matrix, held_chain(12, 2));
  ASSERT_TRUE(solver.factor(matrix));
  solver.solve(vector_of(b), twice);
  EXPECT_LT((dense_of(once) - 2 * dense_of(twice)).norm(), 1e-12 * dense_of(once).norm());
  EXPECT_EQ(solver.timings().factorisations, 2);
  EXPECT_EQ(solver.timings().solves, 2);
}

TEST(DirectSolver, SolvesForManyRightHandSidesAsForEachByItself) {
  const MatX k = held_chain(15, 3) - 2 * MatX::Identity(15, 15);
  const auto matrix = matrix_of(k);
  const auto layout = layout_of(5);
  DirectSolver solver;
  ASSERT_TRUE(solver.factor(matrix));
  MatX b(15, 4);
  for (int j = 0; j < 4; ++j) b.col(j) = some_load(15).array().pow(j + 1);
  const MatX x = solver.solve_many(b.middleRows(3 * layout.first, 3 * layout.local));
  for (int j = 0; j < 4; ++j) {
    Vector single(layout);
    solver.solve(vector_of(b.col(j)), single);
    const VecX own = dense_of(single).segment(3 * layout.first, 3 * layout.local);
    EXPECT_LT((x.col(j) - own).norm(), 1e-12 * dense_of(single).norm());
  }
}

TEST(SymmetricMatrix, MultipliesLikeTheDenseOne) {
  MatX dense = held_chain(12, 2);
  dense(0, 7) = dense(7, 0) = 0.5;
  dense(2, 11) = dense(11, 2) = -3;
  const auto matrix = matrix_of(dense);
  const VecX x = some_load(12);
  Vector y(layout_of(4));
  matrix.multiply(vector_of(x), y);
  EXPECT_LT((dense_of(y) - dense * x).norm(), 1e-14 * x.norm() * dense.norm());
}

TEST(SymmetricMatrix, AddsAMultipleOfAnother) {
  const MatX a = held_chain(12, 2), b = free_chain(12, 3);
  const VecX x = some_load(12);
  Vector y(layout_of(4));
  matrix_of(a).plus(-0.5, matrix_of(b)).multiply(vector_of(x), y);
  EXPECT_LT((dense_of(y) - a * x + 0.5 * b * x).norm(), 1e-13 * x.norm());
}

TEST(SymmetricMatrix, HasAShiftedCopyAndTheLargestDiagonalEntry) {
  MatX dense = held_chain(12, 2);
  dense(8, 8) = -9;
  const auto matrix = matrix_of(dense);
  EXPECT_EQ(matrix.norm_of_diagonal(), 9);
  const VecX x = some_load(12);
  Vector y(layout_of(4));
  matrix.shifted(0.25).multiply(vector_of(x), y);
  EXPECT_LT((dense_of(y) - dense * x - 0.25 * x).norm(), 1e-13 * x.norm());
  matrix.multiply(vector_of(x), y);
  EXPECT_LT((dense_of(y) - dense * x).norm(), 1e-13 * x.norm()) << "the matrix itself stays as it is";
}

TEST(Vector, KeepsTheOwnPartAndGathersAllEverywhere) {
  const VecX dense = some_load(15);
  const Vector vector = vector_of(dense);
  EXPECT_EQ(dense_of(vector), dense);
  const auto layout = layout_of(5);
  EXPECT_EQ(vector.local_size(), 3 * layout.local);
  std::vector<double> own(static_cast<std::size_t>(3 * layout.local));
  vector.read(own);
  for (std::size_t i = 0; i < own.size(); ++i)
    EXPECT_EQ(own[i], dense[3 * layout.first + static_cast<int>(i)]);
  EXPECT_NEAR(vector.norm(), dense.norm(), 1e-14 * dense.norm());
  EXPECT_NEAR(vector.dot(vector), dense.squaredNorm(), 1e-14 * dense.squaredNorm());
}

}  // namespace
}  // namespace tautline::la
