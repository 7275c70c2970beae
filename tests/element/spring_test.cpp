#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <tautline/element/spring.hpp>

namespace tautline::element {

namespace {

Mat3 turn(double angle, const Vec3& axis) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

SpringMotion moved(const Vec3& u1, const Mat3& R1, const Vec3& u2, const Mat3& R2) {
  SpringMotion motion;
  motion.u << u1, u2;
  motion.rotation = {R1, R2};
  return motion;
}

const Mat3 I = Mat3::Identity();

}  // namespace

TEST(Spring, ToTheGroundFollowsHookeAlongEachAxis) {
  const SpringProperties properties{{100, 200, 0}, {0, 0, 0}};
  const auto spring =
      evaluate_spring(properties, moved(Vec3::Zero(), I, Vec3(0.1, -0.2, 7), I), Want::tangent);
  EXPECT_DOUBLE_EQ(spring.energy, 100 * 0.01 / 2 + 200 * 0.04 / 2);
  EXPECT_LT((spring.force.segment<3>(6) - Vec3(10, -40, 0)).norm(), 1e-14);
  EXPECT_LT((spring.force.head<3>() - Vec3(-10, 40, 0)).norm(), 1e-14);
  EXPECT_LT((spring.spring_force - Vec3(10, -40, 0)).norm(), 1e-14);
  EXPECT_EQ(spring.spring_moment, Vec3::Zero());
  EXPECT_LT((spring.tangent.block<3, 3>(6, 6) - Mat3(Vec3(100, 200, 0).asDiagonal())).norm(), 1e-13);
}

TEST(Spring, TurnsAboutOneAxisLikeATorsionSpring) {
  // up to almost half a turn, far beyond small angles: m = k theta
  const SpringProperties properties{{0, 0, 0}, {30, 10, 20}};
  for (const double angle : {1e-9, 0.5, 3.1, -3.1}) {
    const auto spring = evaluate_spring(
        properties, moved(Vec3::Zero(), I, Vec3::Zero(), turn(angle, Vec3::UnitZ())), Want::tangent);
    EXPECT_NEAR(spring.force[11], 20 * angle, 1e-13);
    EXPECT_NEAR(spring.force[5], -20 * angle, 1e-13);
    EXPECT_NEAR(spring.spring_moment[2], 20 * angle, 1e-13);
    EXPECT_NEAR(spring.energy, 10 * angle * angle, 1e-13);
    EXPECT_NEAR(spring.tangent(11, 11), 20, 1e-12);
    EXPECT_NEAR(spring.tangent(5, 11), -20, 1e-12);
  }
}

TEST(Spring, AxesTurnWithTheFirstNode) {
  // A quarter turn about z carries the soft x axis to y: pulled along global y only kx is felt.
  const SpringProperties properties{{100, 1e6, 1e6}, {0, 0, 0}};
  const Mat3 quarter = turn(std::acos(-1.) / 2, Vec3::UnitZ());
  const auto spring =
      evaluate_spring(properties, moved(Vec3(1, 1, 1), quarter, Vec3(1, 1.5, 1), quarter), Want::force);
  EXPECT_LT((spring.spring_force - Vec3(50, 0, 0)).norm(), 1e-9);  // 1e6 N/m times the rounding of cos(pi/2)
  EXPECT_LT((spring.force.segment<3>(6) - Vec3(0, 50, 0)).norm(), 1e-9);
}

TEST(Spring, ForceAtTheLeverTurnsTheFirstNode) {
  // The opening along x makes the force (100, 40, 0) N with its first node at the lever (1, 0.2, 0) m: for
  // the forces to balance, the first node takes minus lever x force, 1 * 40 - 0.2 * 100 = 20 N m.
  const SpringProperties properties{{100, 200, 300}, {0, 0, 0}};
  const auto spring = evaluate_spring(properties, moved(Vec3::Zero(), I, Vec3(1, 0.2, 0), I), Want::force);
  EXPECT_LT((spring.force.segment<3>(3) - Vec3(0, 0, -20)).norm(), 1e-13);
  EXPECT_LT(spring.force.tail<3>().norm(), 1e-15);
}

TEST(Spring, CommonMotionOfAnySizeMakesNoForce) {
  const SpringProperties properties{{1e3, 2e3, 3e3}, {30, 10, 20}};
  for (const double angle : {0.1, 2., 3.14, 5.}) {
    const Mat3 Q = turn(angle, Vec3(1, -2, 3));
    const Vec3 u(0.3, 40, -7);
    const auto spring = evaluate_spring(properties, moved(u, Q, u, Q), Want::force);
    EXPECT_LT(spring.force.norm(), 30 * 1e-15);  // rounding of R^T R
    EXPECT_LT(spring.energy, 1e-28);
  }
}

TEST(Spring, TangentOfACommonMotionIsThatOfTheTurnedSpringMatrix) {
  const SpringProperties properties{{1e3, 2e3, 3e3}, {30, 10, 20}};
  const Mat3 Q = turn(2, Vec3(1, -2, 3));
  const auto spring = evaluate_spring(properties, moved(Vec3::Zero(), Q, Vec3::Zero(), Q), Want::tangent);
  const Mat3 k = Q * properties.stiffness.asDiagonal() * Q.transpose();
  const Mat3 c = Q * properties.rotational_stiffness.asDiagonal() * Q.transpose();
  Mat<12> expected = Mat<12>::Zero();
  for (const int i : {0, 6})
    for (const int j : {0, 6}) {
      expected.block<3, 3>(i, j) = (i == j ? 1 : -1) * k;
      expected.block<3, 3>(i + 3, j + 3) = (i == j ? 1 : -1) * c;
    }
  EXPECT_LT((spring.tangent - expected).norm(), 1e-12 * expected.norm());
}

}  // namespace tautline::element
