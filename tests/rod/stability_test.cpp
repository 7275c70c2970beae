#include <tautline/rod/stability.hpp>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace tautline::rod {
namespace {

/// A straight rod of length 1 and EI = 1 in m links at an angle, with forces along -X.
RodShape straight(const VecX& reactions, double angle) {
  const int m = static_cast<int>(reactions.size());
  RodShape shape;
  shape.rod = {VecX::Constant(m, 1.0 / m), VecX::Ones(m), {0, 0, angle}};
  shape.reaction = reactions;
  for (int i = 0; i <= m * intervals_per_link; ++i) {
    const double s = static_cast<double>(i) / (m * intervals_per_link);
    shape.curve.push_back({s, s * std::cos(angle), s * std::sin(angle), angle, 0});
  }
  return shape;
}

/// Eigenvalues of -u'' = nu u, u(0) = u'(1) = 0, with hat functions h wide, in closed form.
double discrete_buckling(int mode, double h) {
  const double wave = std::cos((2 * mode - 1) * std::numbers::pi / 2 * h);
  return 6 / (h * h) * (1 - wave) / (2 + wave);
}

TEST(Stability, StraightRodBucklesAtEulersLoads) {
  for (const int m : {1, 3}) {
    const double h = 2.0 / (m * intervals_per_link);
    for (const double nu : {1.0, 2.4, 2.6, 21.0, 24.0}) {
      VecX reactions = VecX::Zero(m);
      reactions[m - 1] = nu;
      const Stability found = judge_stability(straight(reactions, 0), VecX::Zero(m));
      EXPECT_NEAR(found.least, 1 - nu / discrete_buckling(1, h), 1e-12 * nu);
      EXPECT_EQ(found.unstable,
                (nu > std::pow(std::numbers::pi / 2, 2)) + (nu > std::pow(1.5 * std::numbers::pi, 2)));
    }
  }
}

TEST(Stability, PulledRodIsStifferThanAFreeOne) {
  const Stability found = judge_stability(straight(VecX::Constant(1, -10.0), 0), VecX::Zero(1));
  EXPECT_EQ(found.unstable, 0);
  EXPECT_GT(found.least, 1);
}

// Across the force its stiffness works alone, on dX = -integral of the angle: one eigenvalue is
// 1 + slope (1/3 - h^2/12) with hat functions, the others are 1.
TEST(Stability, SlopeOfAForceActsOnTheNodesRadius) {
  const double h = 2.0 / intervals_per_link, flexibility = 1.0 / 3 - h * h / 12;
  for (const double slope : {-2.9, -3.1}) {
    const Stability found =
        judge_stability(straight(VecX::Zero(1), std::numbers::pi / 2), VecX::Constant(1, slope));
    EXPECT_NEAR(found.least, 1 + slope * flexibility, 1e-12);
    EXPECT_EQ(found.unstable, slope < -3.02 ? 1 : 0);
  }
  EXPECT_NEAR(judge_stability(straight(VecX::Zero(1), std::numbers::pi / 2), VecX::Constant(1, 5.0)).least, 1,
              1e-12);
}

}  // namespace
}  // namespace tautline::rod
