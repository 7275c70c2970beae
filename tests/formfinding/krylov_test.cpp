// LSQR and GMRES against what linear algebra says of small matrices.
#include <gtest/gtest.h>

#include <cmath>
#include <formfinding/gmres.hpp>
#include <formfinding/lsqr.hpp>

namespace tautline::formfinding {
namespace {

/// A matrix by its products.
struct Products {
  MatX matrix;
  VecX apply(const VecX& x) const { return matrix * x; }
  VecX apply_transposed(const VecX& y) const { return matrix.transpose() * y; }
  Eigen::Index columns() const { return matrix.cols(); }
};

MatX diagonal(const std::vector<double>& values) {
  return Eigen::Map<const VecX>(values.data(), static_cast<Eigen::Index>(values.size())).asDiagonal();
}

TEST(Lsqr, TakesAsManyIterationsAsThereAreSingularValues) {
  // Exact arithmetic ends when the Krylov space is full: with as many steps as there are different singular
  // values among those that b has a part of.
  const VecX b = VecX::Ones(4);
  EXPECT_EQ(least_squares(Products{diagonal({2, 2, 2, 2})}, b, 1e-12, 50).iterations, 1);
  EXPECT_EQ(least_squares(Products{diagonal({2, 2, 3, 3})}, b, 1e-12, 50).iterations, 2);
  EXPECT_EQ(least_squares(Products{diagonal({1, 2, 3, 3})}, b, 1e-12, 50).iterations, 3);
  EXPECT_EQ(least_squares(Products{diagonal({1, 2})}, VecX::Zero(2), 1e-12, 50).iterations, 0);
}

TEST(Lsqr, EndsAtTheOptimumOfWhatCannotBeMet) {
  // Rows (1 0), (0 2), and one of zeros: the last component of b is out of reach.
  MatX matrix = MatX::Zero(3, 2);
  matrix(0, 0) = 1;
  matrix(1, 1) = 2;
  for (const double unit : {1e-9, 1.0, 1e9}) {
    const auto found = least_squares(Products{matrix}, unit * Vec3(3, 4, 5), 1e-12, 50);
    EXPECT_LE((found.x - unit * Eigen::Vector2d(3, 2)).norm(), 1e-14 * unit);
    EXPECT_EQ(found.iterations, 2);
  }
}

TEST(Lsqr, FindsTheSolutionOfSmallestNorm) {
  MatX matrix(1, 3);
  matrix << 1, 2, 2;
  const auto found = least_squares(Products{matrix}, VecX::Constant(1, 18), 1e-12, 50);
  EXPECT_LE((found.x - Vec3(2, 4, 4)).norm(), 1e-14);
  EXPECT_EQ(found.iterations, 1);
}

TEST(Lsqr, DampsEachDirectionByItsSingularValue) {
  // x_i = s_i b_i / (s_i^2 + d^2)
  const std::vector<double> s{0.5, 1, 3};
  const Vec3 b(1, -2, 4);
  for (const double d : {0.1, 2.0}) {
    const auto found = least_squares(Products{diagonal(s)}, b, 1e-13, 50, d);
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(
          found.x[i],
          s[static_cast<std::size_t>(i)] * b[i] / (std::pow(s[static_cast<std::size_t>(i)], 2) + d * d),
          1e-12);
  }
}

TEST(Lsqr, StopsAfterTheIterationsAllowed) {
  EXPECT_EQ(least_squares(Products{diagonal({1, 2, 3, 4})}, VecX::Ones(4), 1e-12, 2).iterations, 2);
}

MatX some_matrix(int n) {
  MatX matrix(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) matrix(i, j) = std::sin(1.0 + 3 * i + 1.7 * j * (i + 1)) + (i == j ? 3 : 0);
  return matrix;
}

TEST(Gmres, SolvesWithAsManyProductsAsThereAreUnknowns) {
  for (const int n : {1, 2, 7}) {
    const MatX matrix = some_matrix(n);
    const VecX b = VecX::LinSpaced(n, 1, 3);
    const auto found = gmres([&](const VecX& y) -> VecX { return matrix * y; }, b, 1e-13, n);
    EXPECT_LE((matrix * found.x - b).norm(), 1e-12 * b.norm()) << n;
    EXPECT_EQ(found.iterations, n);
  }
}

/// After k products nothing in the span of b, A b ... leaves less.
TEST(Gmres, IsTheBestOfItsKrylovSpace) {
  const MatX matrix = some_matrix(6);
  const VecX b = VecX::LinSpaced(6, 1, 3);
  MatX images(6, 3);
  VecX power = b;
  for (int k = 0; k < 3; ++k) images.col(k) = power = matrix * power;
  const VecX best = b - images * images.householderQr().solve(b);
  const auto found = gmres([&](const VecX& y) -> VecX { return matrix * y; }, b, 1e-13, 3);
  EXPECT_NEAR((matrix * found.x - b).norm(), best.norm(), 1e-11 * b.norm());
  EXPECT_NEAR(found.residual, best.norm(), 1e-11 * b.norm()) << "told without a product";
}

TEST(Gmres, StopsAtTheToleranceAndWhereNothingIsAsked) {
  const MatX matrix = some_matrix(7);
  const auto product = [&](const VecX& y) -> VecX { return matrix * y; };
  const VecX b = VecX::Ones(7);
  const auto coarse = gmres(product, b, 0.5, 7);
  EXPECT_LT(coarse.iterations, 7);
  EXPECT_LE((matrix * coarse.x - b).norm(), 0.5 * b.norm());
  EXPECT_EQ(gmres(product, VecX::Zero(7), 1e-10, 7).iterations, 0);
  const auto at_once = gmres([](const VecX& y) -> VecX { return 2 * y; }, b, 1e-13, 7);
  EXPECT_EQ(at_once.iterations, 1) << "the space is full";
  EXPECT_LE((at_once.x - b / 2).norm(), 1e-15);
}

}  // namespace
}  // namespace tautline::formfinding
