#include <tautline/rod/umbrella.hpp>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <rod/antennas.hpp>

#include <tautline/core/error.hpp>

namespace tautline::rod {
namespace {

class TargetOfAntenna : public testing::TestWithParam<Antenna> {};

// The angles theta_k^0 of tables 2, 3, printed with four decimals.
TEST_P(TargetOfAntenna, HasTheTargetAnglesOfThePaper) {
  const Umbrella umbrella = make_umbrella(options_of(GetParam()));
  EXPECT_LT(largest_difference(umbrella.target_angle, GetParam().target_angle), 5.1e-5);
}

INSTANTIATE_TEST_SUITE_P(Paper, TargetOfAntenna, testing::ValuesIn(antennas()));

TEST(Umbrella, StraightRodIsAtItsAngleAndTurnsToTheSlopeOfTheSurface) {
  UmbrellaOptions options = options_of(antennas()[0]);
  options.root_offset = 0.05;
  const Umbrella umbrella = make_umbrella(options);
  EXPECT_NEAR(umbrella.cables.straight_radius[2], (0.25 - 0.05 + 9) * 0.5, 1e-14);
  EXPECT_NEAR(umbrella.root_at(0).x, 0.1, 1e-15);
  EXPECT_NEAR(umbrella.root_at(0).angle, std::numbers::pi / 3, 1e-15);
  EXPECT_EQ(umbrella.root_at(1).x, 0.25);
  EXPECT_NEAR(umbrella.root_at(1).y, 0.0625 / 15, 1e-17);
  EXPECT_NEAR(umbrella.root_at(1).angle, std::atan(0.5 / 15), 1e-16);
}

TEST(Umbrella, OfATableIsThatOfItsFunction) {
  UmbrellaOptions options = options_of(antennas()[0]);
  options.lengths = {2, 3, 1, 4};
  const Umbrella function = make_umbrella(options, Meridian([](double x) {
                                            return Jet{x * x / 15, 2 * x / 15, 2.0 / 15};
                                          }));
  const Umbrella parabola = make_umbrella(options);
  EXPECT_LT((function.target_x - parabola.target_x).norm(), 1e-15);
  options.meridian.kind = MeridianKind::table;
  for (double x = 0; x <= 10; x += 0.5) {
    options.meridian.x.push_back(x);
    options.meridian.y.push_back(x * x / 15);
  }
  EXPECT_LT((make_umbrella(options).target_x - parabola.target_x).norm(), 1e-13);
  options.meridian.x.resize(15);
  options.meridian.y.resize(15);
  EXPECT_THROW(make_umbrella(options), ModelError);  // the table ends before the rod
}

TEST(Cable, PullsOnlyWhenStretched) {
  const CableOptions linear;
  EXPECT_EQ(tension_ratio(linear, -0.1).value, 0);
  EXPECT_EQ(tension_ratio(linear, -0.1).slope, 0);
  EXPECT_EQ(tension_ratio(linear, 0.3).value, 0.3);
  const CableOptions bilinear{CableLaw::bilinear, 0.1, 0.25, 0.05};
  EXPECT_EQ(tension_ratio(bilinear, 0.1).value, 0.1);
  EXPECT_NEAR(tension_ratio(bilinear, 0.3).value, 0.15, 1e-16);
  EXPECT_EQ(tension_ratio(bilinear, 0.3).slope, 0.25);
}

// n cables in a ring: two of them pull with T at pi/n from the tangent.
TEST(Cable, RingPullsItsNodesInwards) {
  Cables cables{6, {}, VecX::Constant(1, 2.0), VecX::Constant(1, 100.0)};
  const Force force = cables.reaction(0, 2.2);
  EXPECT_NEAR(force.value, 100 * 0.1, 1e-13);  // 2 T sin(30 degrees) = T
  EXPECT_NEAR(force.slope, 100 / 2.0, 1e-13);
  EXPECT_NEAR(stiffness_for(cables, VecX::Constant(1, 2.2), VecX::Constant(1, 10.0))[0], 100, 1e-12);
  EXPECT_NEAR(cables.slopes(VecX::Constant(1, 2.2), VecX::Constant(1, 10.0))[0], 50, 1e-12);
}

TEST(Cable, OfAGivenReactionHasTheSlopeOfItsLaw) {
  CableOptions bilinear{CableLaw::bilinear, 0.1, 0.25, 0.05};
  const Cables cables{24, bilinear, VecX::Constant(2, 2.0), VecX::Constant(2, 100.0)};
  const VecX x = (VecX(2) << 2.1, 2.6).finished();  // strains on both sides of the knee
  VecX reactions(2);
  for (int k = 0; k < 2; ++k) reactions[k] = cables.reaction(k, x[k]).value;
  EXPECT_NEAR(cables.reaction(1, 2.6).value, 2 * std::sin(std::numbers::pi / 24) * 100 * 0.15, 1e-13);
  for (int k = 0; k < 2; ++k)
    EXPECT_NEAR(cables.slopes(x, reactions)[k], cables.reaction(k, x[k]).slope, 1e-12);
  EXPECT_LT((stiffness_for(cables, x, reactions) - cables.stiffness).norm(), 1e-12);
}

TEST(Cable, HasNoStiffnessWhereItCannotPull) {
  const Cables cables{6, {}, VecX::Constant(1, 2.0), {}};
  EXPECT_TRUE(std::isnan(stiffness_for(cables, VecX::Constant(1, 1.9), VecX::Constant(1, 10.0))[0]));
  EXPECT_TRUE(std::isnan(stiffness_for(cables, VecX::Constant(1, 2.2), VecX::Constant(1, -10.0))[0]));
}

TEST(Umbrella, RefusesOptionsThatMakeNone) {
  const auto refuses = [](auto change) {
    UmbrellaOptions options = options_of(antennas()[0]);
    change(options);
    EXPECT_THROW(make_umbrella(options), ModelError);
  };
  refuses([](UmbrellaOptions& o) { o.rods = 2; });
  refuses([](UmbrellaOptions& o) { o.links = 0; });
  refuses([](UmbrellaOptions& o) { o.lengths = {}; });
  refuses([](UmbrellaOptions& o) { o.lengths = {1, 2}; });
  refuses([](UmbrellaOptions& o) { o.bending_stiffness[2] = 0; });
  refuses([](UmbrellaOptions& o) { o.root_offset = 0.3; });
  refuses([](UmbrellaOptions& o) { o.straight_angle = 90; });
  refuses([](UmbrellaOptions& o) { o.cable.second_slope = 0; });
}

}  // namespace
}  // namespace tautline::rod
