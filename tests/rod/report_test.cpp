#include <tautline/rod/report.hpp>

#include <cmath>

#include <gtest/gtest.h>
#include <rod/antennas.hpp>

#include <tautline/rod/cantilever_model.hpp>

namespace tautline::rod {
namespace {

/// A straight rod of two links of 1 m that leaves the meridian Y = 0 at an angle.
RodShape ramp(double angle, double height) {
  RodShape shape;
  shape.rod = {VecX::Ones(2), VecX::Ones(2), {1, height, angle}};
  for (int i = 0; i <= 2 * intervals_per_link; ++i) {
    const double s = static_cast<double>(i) / intervals_per_link;
    shape.curve.push_back({s, 1 + s * std::cos(angle), height + s * std::sin(angle), angle, 0});
  }
  shape.x = VecX(2);
  shape.y = VecX(2);
  for (int k = 0; k < 2; ++k) {
    shape.x[k] = shape.curve[(k + 1) * intervals_per_link].x;
    shape.y[k] = shape.curve[(k + 1) * intervals_per_link].y;
  }
  shape.reaction = VecX::Zero(2);
  return shape;
}

UmbrellaOptions two_links() {
  UmbrellaOptions options;
  options.links = 2;
  options.lengths = {1};
  options.bending_stiffness = {1};
  options.root_radius = 1;
  return options;
}

Umbrella flat_umbrella() {
  return make_umbrella(two_links(), Meridian([](double) { return Jet{}; }));
}

// Distance s sin(a): rms 2 sin(a)/sqrt(3) over 2 m, largest at the end.
TEST(RodErrors, GrowAlongARamp) {
  const double slope = std::sin(-0.01);
  const RodReport report = make_report(flat_umbrella(), ramp(-0.01, 0));
  EXPECT_NEAR(report.along.rms, -2 * slope / std::sqrt(3), 1e-15);
  EXPECT_NEAR(report.along.max, 2 * slope, 1e-15);
  EXPECT_EQ(report.along.max_at, 2);
  EXPECT_NEAR(report.node_error[0], slope, 1e-15);
  EXPECT_NEAR(report.miss_x[1], 2 * (std::cos(0.01) - 1), 1e-15);
}

// Parallel lines 0.01 apart along the normal, at 45 degrees: sqrt(2) times that along the axis.
TEST(RodErrors, AreMeasuredAlongTheNormalAndTheAxis) {
  const Umbrella umbrella = make_umbrella(two_links(), Meridian([](double x) { return Jet{x - 1, 1, 0}; }));
  const RodReport report = make_report(umbrella, ramp(std::atan(1.0), 0.01 * std::sqrt(2)));
  EXPECT_NEAR(report.along.rms, 0.01, 1e-14);
  EXPECT_NEAR(report.along.max, 0.01, 1e-14);
  EXPECT_NEAR(report.along.rms_axial, 0.01 * std::sqrt(2), 1e-14);
}

TEST(RodWarnings, NameCablesThatAreStretchedTooFarPushOrAreSlack) {
  RodShape shape = ramp(0, 0);  // radii 2 and 3; straight ones 1 and 1.5
  shape.reaction << -3, 1;
  const RodReport report = make_report(flat_umbrella(), shape);
  ASSERT_EQ(report.warnings.size(), 3u);
  EXPECT_NE(report.warnings[0].find("node 1 must be pushed outwards with 3 N"), std::string::npos);
  EXPECT_NE(report.warnings[1].find("cable 1 is stretched by 100.0 %"), std::string::npos);
  EXPECT_NE(report.warnings[2].find("cable 2 is stretched by 100.0 %"), std::string::npos);
  EXPECT_TRUE(std::isnan(report.stiffness[0]));

  shape.x << 0.9, 1.5;
  shape.reaction << 3, 0;
  const RodReport slack = make_report(flat_umbrella(), shape);
  ASSERT_EQ(slack.warnings.size(), 1u);
  EXPECT_NE(slack.warnings[0].find("cable 1 is slack"), std::string::npos);
}

// Strains of 0.44 to 1.67 are no strains of a cable: every design of the paper is warned of.
TEST(RodWarnings, EveryCableOfThePaperIsStretchedTooFar) {
  for (const Antenna& antenna : antennas()) {
    const Umbrella umbrella = make_umbrella(options_of(antenna));
    const RodReport report = make_report(umbrella, design_cantilevers(umbrella, {}).shape);
    EXPECT_EQ(static_cast<int>(report.warnings.size()), antenna.links);
  }
}

}  // namespace
}  // namespace tautline::rod
