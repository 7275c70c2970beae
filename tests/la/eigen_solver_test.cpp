#include <tautline/core/error.hpp>
#include <tautline/la/eigen_solver.hpp>

#include "la/chain.hpp"

namespace tautline::la {
namespace {

using namespace testing_chain;

constexpr double tolerance = 1e-10;  // SLEPc is asked for 1e-12 of the transformed eigenvalue

TEST(Vibration, OfAHeldChainHasItsClosedFormFrequencies) {
  const int n = 30;
  const double k = 2e4, m = 3;
  const auto pairs = solve_vibration(matrix_of(held_chain(n, k)), matrix_of(m * MatX::Identity(n, n)), 5);
  ASSERT_EQ(pairs.values.size(), 5u);
  for (int j = 1; j <= 5; ++j) {
    const double exact = held_chain_eigenvalue(n, k, j) / m;
    EXPECT_NEAR(pairs.values[j - 1], exact, tolerance * exact);
    EXPECT_LT(pairs.residuals[j - 1], 1e-9);
  }
}

TEST(Vibration, OfAHeldChainHasSineModesOfUnitModalMass) {
  const int n = 30;
  const double m = 3;
  const auto pairs = solve_vibration(matrix_of(held_chain(n, 2e4)), matrix_of(m * MatX::Identity(n, n)), 4);
  for (int j = 1; j <= 4; ++j) {
    VecX exact(n);
    for (int i = 0; i < n; ++i) exact[i] = std::sin(j * std::numbers::pi * (i + 1) / (n + 1));
    exact /= std::sqrt(m) * exact.norm();
    const VecX mode = dense_of(pairs.vectors[j - 1]);
    EXPECT_NEAR(m * mode.squaredNorm(), 1, 1e-10);
    EXPECT_LT(std::min((mode - exact).norm(), (mode + exact).norm()), 1e-7) << "mode " << j;
  }
}

TEST(Vibration, WithPointsWithoutMassIsThatOfTheSpringsInSeries) {
  // Masses at every other point: two springs in a row between them are one of half the stiffness.
  const int masses = 7, n = 2 * masses + 1;
  const double k = 500, m = 2;
  MatX mass = MatX::Zero(n, n);
  for (int i = 1; i < n; i += 2) mass(i, i) = m;
  const auto pairs = solve_vibration(matrix_of(held_chain(n, k)), matrix_of(mass), 4);
  for (int j = 1; j <= 4; ++j) {
    const double exact = held_chain_eigenvalue(masses, k / 2, j) / m;
    EXPECT_NEAR(pairs.values[j - 1], exact, tolerance * exact);
    EXPECT_LT(pairs.residuals[j - 1], 1e-9);
    const VecX mode = dense_of(pairs.vectors[j - 1]);
    EXPECT_NEAR(mode.dot(mass * mode), 1, 1e-10);
  }
}

TEST(Vibration, IsTheSameWithHeldUnknownsThatHaveStiffnessAndNoMass) {
  const int n = 12;
  MatX stiffness = MatX::Zero(n + 3, n + 3), mass = stiffness;
  stiffness.topLeftCorner(n, n) = held_chain(n, 100);
  stiffness.bottomRightCorner(3, 3) = 1e6 * Mat3::Identity();
  mass.topLeftCorner(n, n).setIdentity();
  const auto pairs = solve_vibration(matrix_of(stiffness), matrix_of(mass), 3);
  for (int j = 1; j <= 3; ++j) {
    const double exact = held_chain_eigenvalue(n, 100, j);
    EXPECT_NEAR(pairs.values[j - 1], exact, tolerance * exact);
    EXPECT_LT(dense_of(pairs.vectors[j - 1]).tail(3).norm(), 1e-10);
  }
}

TEST(Vibration, OfThreeEqualChainsFindsEveryModeThreeTimes) {
  const int n = 9;
  MatX stiffness = MatX::Zero(3 * n, 3 * n);
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) stiffness(3 * i + c, 3 * j + c) = held_chain(n, 10)(i, j);
  const auto pairs = solve_vibration(matrix_of(stiffness), matrix_of(MatX::Identity(3 * n, 3 * n)), 6);
  for (int j = 0; j < 6; ++j) {
    const double exact = held_chain_eigenvalue(n, 10, j / 3 + 1);
    EXPECT_NEAR(pairs.values[j], exact, tolerance * exact) << "mode " << j + 1;
    for (int i = 0; i <= j; ++i)
      EXPECT_NEAR(pairs.vectors[i].dot(pairs.vectors[j]), i == j ? 1 : 0, 1e-10)
          << "modes " << i + 1 << ", " << j + 1;
  }
}

/// n unknowns with the eigenvalues given, in a basis in which nothing is diagonal.
MatX with_eigenvalues(const VecX& values) {
  const auto n = values.size();
  const VecX v = VecX::LinSpaced(n, 1, 3).normalized();
  const MatX q = MatX::Identity(n, n) - 2 * v * v.transpose();
  const MatX k = q * values.asDiagonal() * q.transpose();
  return (k + k.transpose()) / 2;
}

TEST(Vibration, IsCutAnywhereInAClusterOfEqualAndNearlyEqualModes) {
  // Three equal ones, two closer than any count by shifted matrices can tell them apart, and stiff ones whose
  // rounding (1e-16 of the largest) is more than 1e-8 of the softest.
  VecX values(12);
  values << 1, 1, 1, 2, 2 * (1 + 3e-9), 2 * (1 + 1e-8), 2 * (1 + 3e-8), 3, 1e4, 1e6, 1e8, 1e8;
  const auto stiffness = matrix_of(with_eigenvalues(values)), mass = matrix_of(MatX::Identity(12, 12));
  for (int count = 1; count <= 8; ++count) {
    const auto pairs = solve_vibration(stiffness, mass, count);
    ASSERT_EQ(pairs.values.size(), static_cast<std::size_t>(count));
    for (int j = 0; j < count; ++j)
      EXPECT_NEAR(pairs.values[static_cast<std::size_t>(j)], values[j], 1e-6) << j + 1 << " of " << count;
  }
}

TEST(Vibration, GivesAllModesThatThereAre) {
  VecX values(12);
  values << 1, 2, 2, 3, 4, 4, 4, 5, 6, 7, 8, 9;
  const auto pairs =
      solve_vibration(matrix_of(with_eigenvalues(values)), matrix_of(MatX::Identity(12, 12)), 12);
  for (int j = 0; j < 12; ++j)
    EXPECT_NEAR(pairs.values[static_cast<std::size_t>(j)], values[j], tolerance * values[j]);
}

TEST(Vibration, FindsTheModesOnBothSidesOfAShift) {
  const int n = 12;
  const double shift = 0.5 * (held_chain_eigenvalue(n, 1, 5) + held_chain_eigenvalue(n, 1, 6));
  const auto pairs = solve_vibration(matrix_of(held_chain(n, 1)), matrix_of(MatX::Identity(n, n)), 2, shift);
  EXPECT_NEAR(pairs.values[0], held_chain_eigenvalue(n, 1, 5), tolerance);
  EXPECT_NEAR(pairs.values[1], held_chain_eigenvalue(n, 1, 6), tolerance);
}

TEST(Vibration, AskedForMoreModesThanThereAreMassesSaysSo) {
  MatX mass = MatX::Zero(12, 12);
  mass(4, 4) = mass(7, 7) = 1;
  try {
    const auto pairs = solve_vibration(matrix_of(held_chain(12, 1)), matrix_of(mass), 5);
    FAIL() << "found " << pairs.values.size() << " modes of two masses, the last at " << pairs.values.back();
  } catch (const ModelError& error) {
    EXPECT_NE(std::string(error.what()).find("only 2 of the 5 modes asked for exist"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace tautline::la
