#include <tautline/reflector/tuning.hpp>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace tautline::reflector {
namespace {

TEST(BoxMinimum, IsTheSolutionOfTheEquationsWhereNoBoundActs) {
  MatX h(3, 3);
  h << 4, 1, 0, 1, 3, 1, 0, 1, 2;
  const VecX g = VecX::LinSpaced(3, -1, 1);
  const VecX free = -h.ldlt().solve(g);
  const VecX x = minimise_in_box(h, g, VecX::Constant(3, -10), VecX::Constant(3, 10));
  EXPECT_LT((x - free).norm(), 1e-14);
}

// min (x^2 + y^2)/2 + xy/2 - 2x - 2y with x <= 0.5: on the bound, y = 2 - x/2 = 1.75.
TEST(BoxMinimum, StaysOnABoundAndSolvesTheRest) {
  MatX h(2, 2);
  h << 1, 0.5, 0.5, 1;
  const VecX g = VecX::Constant(2, -2);
  VecX upper(2);
  upper << 0.5, 10;
  const VecX x = minimise_in_box(h, g, VecX::Constant(2, -10), upper);
  EXPECT_NEAR(x[0], 0.5, 1e-14);
  EXPECT_NEAR(x[1], 1.75, 1e-14);
}

// min (x^2 + y^2)/2 + x/2 - y/2 from the corner x = y = 0, where x has to leave its upper bound and y its
// lower one.
TEST(BoxMinimum, LeavesTheBoundsOnWhichItBegins) {
  const VecX g = Eigen::Vector2d(0.5, -0.5), lower = Eigen::Vector2d(-3, 0), upper = Eigen::Vector2d(0, 3);
  const VecX x = minimise_in_box(MatX::Identity(2, 2), g, lower, upper);
  EXPECT_NEAR(x[0], -0.5, 1e-15);
  EXPECT_NEAR(x[1], 0.5, 1e-15);
}

// At the minimum every component is either free with no gradient, or on a bound that the gradient pushes
// against.
TEST(BoxMinimum, MeetsTheOptimalityConditionsOfALargeProblem) {
  const int n = 60;
  srand(1);
  const MatX a = MatX::Random(n, n);
  const MatX h = a.transpose() * a + 0.1 * MatX::Identity(n, n);
  const VecX g = 5 * VecX::Random(n);
  const VecX low = VecX::Constant(n, -0.3), high = VecX::Constant(n, 0.2);
  const VecX x = minimise_in_box(h, g, low, high);
  const VecX gradient = h * x + g;
  int bound = 0;
  for (int i = 0; i < n; ++i) {
    if (x[i] <= low[i]) {
      EXPECT_GE(gradient[i], 0);
      ++bound;
    } else if (x[i] >= high[i]) {
      EXPECT_LE(gradient[i], 0);
      ++bound;
    } else {
      EXPECT_NEAR(gradient[i], 0, 1e-9);
    }
  }
  EXPECT_GT(bound, 5);
  EXPECT_LT(bound, n);
}

TEST(RuleOfTuning, ShortensATieByTheHeightOfItsFrontNodeAboveTheSurface) {
  const Paraboloid surface(12, 8, 1.125);
  const double z = surface.height(1, 2);
  const VecX change = rule_change(surface, {Vec3(1, 2, z + 0.003), Vec3(1, 2, z - 0.001)});
  EXPECT_NEAR(change[0], -0.003, 1e-15);
  EXPECT_NEAR(change[1], 0.001, 1e-15);
}

/// A flat patch whose nodes each hang on their own tie: the ideal change is known.
class OwnTies : public testing::Test {
 protected:
  void SetUp() override {
    sample_.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0)};
    for (std::size_t i = 0; i < 4; ++i)
      sample_.positions[i].z() =
          surface_.height(sample_.positions[i].x(), sample_.positions[i].y()) + error_[i];
    sample_.surface_nodes = {0, 1, 2, 3};
    sample_.triangles = {{0, 1, 2}, {1, 3, 2}};
    influence_.nodes = sample_.surface_nodes;
    influence_.displacement = MatX::Zero(12, 4);
    for (int i = 0; i < 4; ++i) influence_.displacement(3 * i + 2, i) = 1;  // a longer tie lets its node rise
    influence_.tension = -100 * MatX::Identity(4, 4);
    influence_.present_tension = VecX::Constant(4, 1.0);
    options_.method = TuningMethod::sensitivity;
    options_.objective = TuningObjective::nodes;
    options_.regularisation = 0;
    options_.tension_min = 0.1;
  }

  Paraboloid surface_{12, 8, -6};
  std::array<double, 4> error_{0.002, -0.001, 0.0, 0.003};
  SurfaceSample sample_;
  TieInfluence influence_;
  TuningOptions options_;
};

// With every node free to move alone, all deviations become equal: the changes differ from -error by a
// constant.
TEST_F(OwnTies, SensitivityMakesTheDeviationsEqual) {
  options_.regularisation = 1e-9;  // the common shift is free and must be tied down
  const VecX change = sensitivity_change(surface_, sample_, influence_, options_);
  for (int i = 1; i < 4; ++i) EXPECT_NEAR(change[i] + error_[i], change[0] + error_[0], 1e-9);
}

// Node 3 wants 3 mm less, 0.3 N more tension; only 0.1 N more is allowed, so its tie stops at 1 mm.
TEST_F(OwnTies, SensitivityKeepsTensionsWithinBounds) {
  options_.regularisation = 1e-9;
  options_.tension_max = 1.1;
  const VecX change = sensitivity_change(surface_, sample_, influence_, options_);
  for (int i = 0; i < 4; ++i) EXPECT_LE(1.0 - 100 * change[i], 1.1 + 1e-12);
}

// A fifth cord in line with the first: the two always carry one tension, which the sum of their lengths
// makes. No tensions that differ can be had; both change by the same, and the deviations become equal as
// before.
TEST_F(OwnTies, SensitivityKnowsTensionsThatCannotBeHad) {
  options_.regularisation = 1e-9;
  influence_.displacement.conservativeResize(12, 5);
  influence_.displacement.col(4) = influence_.displacement.col(0);
  influence_.tension = -100 * MatX::Identity(5, 5);
  for (const int i : {0, 4})
    for (const int j : {0, 4}) influence_.tension(i, j) = -50;
  influence_.present_tension = VecX::Constant(5, 1.0);
  const VecX change = sensitivity_change(surface_, sample_, influence_, options_);
  EXPECT_NEAR(change[0], change[4], 1e-12);
  for (int i = 1; i < 4; ++i) EXPECT_NEAR(change[i] + error_[i], change[0] + change[4] + error_[0], 1e-9);
}

// The error of cords alone, weighted by length: the rule and the measure are one quadratic form.
TEST_F(OwnTies, SensitivityOfANetWithoutClothMakesTheDeviationsEqual) {
  options_.objective = TuningObjective::area;
  options_.regularisation = 1e-9;
  sample_.triangles.clear();
  sample_.lines = {{0, 1}, {1, 3}, {3, 2}, {2, 0}};
  // Between the ends, a cord of length l over z = r^2/4f is l^2/24f above the surface in the mean; the sides
  // are equal, so equal deviations of the nodes are best.
  const VecX change = sensitivity_change(surface_, sample_, influence_, options_);
  for (int i = 1; i < 4; ++i) EXPECT_NEAR(change[i] + error_[i], change[0] + error_[0], 1e-8);
}

TEST_F(OwnTies, SensitivityKeepsToTheLargestChange) {
  options_.regularisation = 1e-9;
  options_.max_change = 5e-4;
  EXPECT_NEAR(sensitivity_change(surface_, sample_, influence_, options_).cwiseAbs().maxCoeff(), 5e-4, 1e-15);
}

}  // namespace
}  // namespace tautline::reflector
