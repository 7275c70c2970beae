#include <gtest/gtest.h>

#include <cmath>
#include <tautline/element/cable.hpp>

namespace tautline::element {

namespace {

Mat<3, 2> between(const Vec3& a, const Vec3& b) {
  Mat<3, 2> x;
  x << a, b;
  return x;
}

Vec<6> ends(const Vec3& u1, const Vec3& u2) {
  Vec<6> u;
  u << u1, u2;
  return u;
}

const Mat<3, 2> along_x = between(Vec3(1, 2, 3), Vec3(5, 2, 3));  // 4 m

}  // namespace

TEST(Cable, CarriesItsInitialTensionAtZeroDisplacement) {
  const auto cable = evaluate_cable({2e4, 0.005}, along_x, Vec<6>::Zero(), Want::tangent);
  EXPECT_DOUBLE_EQ(cable.tension, 100);
  EXPECT_EQ(cable.force, ends(Vec3(-100, 0, 0), Vec3(100, 0, 0)));
  // W = EA L0 eps^2 / 2 with L0 = 4 / 1.005
  EXPECT_DOUBLE_EQ(cable.energy, 2e4 * 4 / 1.005 * 0.005 * 0.005 / 2);
  // axial stiffness EA / L0, transverse stiffness T / l
  EXPECT_DOUBLE_EQ(cable.tangent(3, 3), 2e4 * 1.005 / 4);
  EXPECT_DOUBLE_EQ(cable.tangent(4, 4), 100. / 4);
  EXPECT_DOUBLE_EQ(cable.tangent(1, 4), -100. / 4);
}

TEST(Cable, StrainIsEngineeringStrainOfTheUnstressedLength) {
  // from 4 m to 6 m with L0 = 5 m: eps = 0.2
  const auto cable = evaluate_cable({100, -0.2}, along_x, ends(Vec3::Zero(), Vec3(2, 0, 0)), Want::force);
  EXPECT_NEAR(cable.tension, 20, 1e-13);
  EXPECT_NEAR(cable.energy, 100 * 5 * 0.04 / 2, 1e-12);
}

TEST(Cable, MidLoadOfTwoCablesMeetsTheClosedForm) {
  const double a = 3, w = 0.4, EA = 500;
  const double length = std::hypot(a, w);
  const Vec<6> u = ends(Vec3::Zero(), Vec3(0, 0, w));
  const auto left = evaluate_cable({EA, 0}, between(Vec3(-a, 0, 0), Vec3::Zero()), u, Want::force);
  const auto right = evaluate_cable({EA, 0}, between(Vec3(a, 0, 0), Vec3::Zero()), u, Want::force);
  const Vec3 load = left.force.tail<3>() + right.force.tail<3>();
  EXPECT_NEAR(load[0], 0, 1e-13);
  EXPECT_NEAR(load[2], 2 * EA * (length / a - 1) * w / length, 1e-13);
}

TEST(Cable, ShortStiffTieKeepsTheDigitsOfItsTension) {
  // 2 cm tie, EA/L = 1e6 N/m, 20 m from the origin, both ends displaced by 0.3 m. Rounding of lengths would
  // leave 1e-16 x 20 m x 1e6 N/m = 2e-9 N; displacement differences leave only the rounding of the tension.
  const Mat<3, 2> x = between(Vec3(12, 15, 3.02), Vec3(12, 15, 3));
  const double length = x(2, 0) - x(2, 1);
  const double EA = 1e6 * length;
  for (const double pull : {0., 1e-13, -1e-12, 1e-10, 1e-7}) {
    const Vec3 u1(0.3, -0.2, 0.1);
    const Vec3 u2 = u1 - Vec3(0, 0, pull);
    const double elongation = u1[2] - u2[2];
    const auto tie = evaluate_cable({EA, 5e-4}, x, ends(u1, u2), Want::force);
    EXPECT_NEAR(tie.tension, EA * (5e-4 + (1 + 5e-4) * elongation / length), 1e-12);
  }
}

TEST(Cable, SwitchesBetweenSlackAndTautAtItsUnstressedLength) {
  const CableProperties properties{1000, 0};
  const auto ready = evaluate_cable(properties, along_x, ends(Vec3::Zero(), Vec3::Zero()), Want::tangent);
  EXPECT_EQ(ready.tension, 0);
  EXPECT_EQ(ready.tangent(3, 3), 250) << "EA/l";
  const auto taut = evaluate_cable(properties, along_x, ends(Vec3::Zero(), Vec3(4e-9, 0, 0)), Want::tangent);
  EXPECT_FALSE(taut.slack);
  EXPECT_NEAR(taut.tension, 1e-6, 1e-14);
  EXPECT_NEAR(taut.tangent(3, 3), 250, 1e-5);
  for (const double shortening : {4e-9, 1.}) {
    const auto slack =
        evaluate_cable(properties, along_x, ends(Vec3::Zero(), Vec3(-shortening, 0, 0)), Want::tangent);
    EXPECT_TRUE(slack.slack);
    EXPECT_EQ(slack.energy, 0);
    EXPECT_EQ(slack.tension, 0);
    EXPECT_EQ(slack.force, Vec<6>::Zero());
    EXPECT_EQ(slack.tangent, Mat<6>::Zero());
  }
}

TEST(Cable, SlackCableWithCoincidentEndsHasNoForce) {
  const Vec<6> u = ends(Vec3(4, 0, 0), Vec3::Zero());
  const auto cable = evaluate_cable({1000, 0.1}, along_x, u, Want::tangent);
  EXPECT_TRUE(cable.slack);
  EXPECT_EQ(cable.force, Vec<6>::Zero());
  EXPECT_EQ(cable.tangent, Mat<6>::Zero());
  EXPECT_EQ(cable_force_by_unstressed_length({1000, 0.1}, along_x, u), Vec<6>::Zero());
}

TEST(Cable, ForceByUnstressedLengthIsItsDerivative) {
  const double EA = 1000, L0 = 3.9;
  const Vec<6> u = ends(Vec3(0.1, 0, 0.2), Vec3(0.2, 0.3, -0.1));
  const auto force = [&](double unstressed) {
    return evaluate_cable({EA, 4 / unstressed - 1}, along_x, u, Want::force).force;
  };
  const double h = 1e-4;  // truncation h^2 / L0^2 = 7e-10 of the derivative
  const Vec<6> difference = (force(L0 + h) - force(L0 - h)) / (2 * h);
  const Vec<6> derivative = cable_force_by_unstressed_length({EA, 4 / L0 - 1}, along_x, u);
  EXPECT_LT((derivative - difference).norm(), 2e-9 * derivative.norm());
  EXPECT_GT(derivative.norm(), 1);
}

TEST(Cable, SlackForceDoesNotDependOnTheUnstressedLength) {
  EXPECT_EQ(cable_force_by_unstressed_length({1000, -0.1}, along_x, Vec<6>::Zero()), Vec<6>::Zero());
}

TEST(Cable, BarPushesWhereACableIsSlack) {
  // Shortened from 4 m to 3 m with L0 = 5 m: eps = -0.4. Material stiffness EA/L0 along, T/l across.
  const CableProperties bar{100, -0.2, true};
  const auto pushed = evaluate_cable(bar, along_x, ends(Vec3::Zero(), Vec3(-1, 0, 0)), Want::tangent);
  EXPECT_NEAR(pushed.tension, -40, 1e-13);
  EXPECT_NEAR(pushed.energy, 100 * 5 * 0.16 / 2, 1e-12);
  EXPECT_FALSE(pushed.slack);
  EXPECT_LT((pushed.force - ends(Vec3(40, 0, 0), Vec3(-40, 0, 0))).norm(), 1e-13);
  EXPECT_NEAR(pushed.tangent(3, 3), 20, 1e-14);
  EXPECT_NEAR(pushed.tangent(4, 4), -40. / 3, 1e-13);
}

TEST(Cable, BarIsStiffAtItsUnstressedLength) {
  const auto bar = evaluate_cable({1000, 0, true}, along_x, Vec<6>::Zero(), Want::tangent);
  EXPECT_EQ(bar.tension, 0);
  EXPECT_FALSE(bar.slack);
  EXPECT_DOUBLE_EQ(bar.tangent(3, 3), 250);
  EXPECT_EQ(bar.tangent(4, 4), 0);
}

TEST(Cable, FlatTwoBarTrussMeetsTheSnapThroughForce) {
  // Two bars over a half span a, apex lowered by w from the height h. Both signs of w pass the flat position,
  // where the force vanishes by symmetry: P = 2 EA (L0 - l)/L0 (h - w)/l.
  const double a = 10, h = 1, EA = 1e4, L0 = std::hypot(a, h);
  for (const double w : {0.4, 0.9, 1., 1.5, 2., 2.3}) {
    const Vec<6> u = ends(Vec3::Zero(), Vec3(0, 0, -w));
    const auto left = evaluate_cable({EA, 0, true}, between(Vec3(-a, 0, 0), Vec3(0, 0, h)), u, Want::force);
    const auto right = evaluate_cable({EA, 0, true}, between(Vec3(a, 0, 0), Vec3(0, 0, h)), u, Want::force);
    const double l = std::hypot(a, h - w);
    EXPECT_NEAR(-left.force[5] - right.force[5], 2 * EA * (L0 - l) / L0 * (h - w) / l, 1e-11) << w;
  }
}

TEST(Cable, BarForceByUnstressedLengthHoldsInCompression) {
  // T = EA (l/L0 - 1): dT/dL0 = -EA l/L0^2 on either side of slackness
  const Vec<6> derivative =
      cable_force_by_unstressed_length({1000, -0.2, true}, along_x, ends(Vec3::Zero(), Vec3(-1, 0, 0)));
  EXPECT_NEAR(derivative[3], -1000 * 3. / 25, 1e-12);
}

TEST(Cable, MassIsThatOfTheUnstressedLength) {
  // the sum over all entries of one direction: the whole mass
  EXPECT_NEAR(cable_mass(0.5, 3)(Eigen::seqN(0, 2, 3), Eigen::seqN(0, 2, 3)).sum(), 1.5, 1e-15);
}

TEST(Cable, MassGivesTheKineticEnergyOfRigidMotion) {
  const Mat<6> mass = cable_mass(0.5, 4);  // 2 kg
  const Vec<6> translation = ends(Vec3(1, 2, 2), Vec3(1, 2, 2));
  EXPECT_NEAR(translation.dot(mass * translation) / 2, 2. * 9 / 2, 1e-13);
  const Vec<6> spin = ends(Vec3(0, -2, 0), Vec3(0, 2, 0));  // 1 rad/s about the middle: m L^2 / 12 / 2
  EXPECT_NEAR(spin.dot(mass * spin) / 2, 2. * 16 / 12 / 2, 1e-13);
}

}  // namespace tautline::element
