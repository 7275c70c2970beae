#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <tautline/core/error.hpp>
#include <tautline/reflector/paraboloid.hpp>

namespace tautline::reflector {
namespace {

/// Offset dishes of Belov (2021), section 3, and an axisymmetric one.
const Paraboloid dishes[] = {{12, 8, 1.125}, {12, 5.4, 2.3}, {12, 6, -6}, {3, 0.4, 0.1}};

TEST(Paraboloid, HasThePublishedTiltAndHeight) {
  // Independent evaluation of eqs (3.4)-(3.8); half a unit of its last digit.
  EXPECT_NEAR(dishes[0].tilt() * 180 / M_PI, 24.00401, 5e-6);
  EXPECT_NEAR(dishes[1].tilt() * 180 / M_PI, 37.54294, 5e-6);
  EXPECT_NEAR(dishes[0].height(0, 0), 0.00494, 5e-6);
  EXPECT_NEAR(dishes[1].height(0, 0), 0.12628 - 0.1033, 5e-6);  // that dish is shifted up by 0.1033 m
}

TEST(Paraboloid, LiesOnItsParent) {
  for (const Paraboloid& dish : dishes) {
    for (double x = -1; x <= 1; x += 0.25) {
      for (double y = -1; y <= 1; y += 0.25) {
        const Vec3 aperture = dish.aperture() / 2 * Vec3(x, y, 0) / std::sqrt(2.0);
        const Vec3 point = aperture + Vec3(0, 0, dish.height(aperture.x(), aperture.y()));
        const Vec3 parent = dish.to_parent(point);
        EXPECT_NEAR(parent.z(), parent.head<2>().squaredNorm() / (4 * dish.focal_length()),
                    1e-13 * dish.aperture());
      }
    }
  }
}

TEST(Paraboloid, ParentFrameIsARigidMotionAndKnowsTheAxis) {
  const Vec3 a(0.3, 2, -1), b(-4, 0.1, 0.7);
  for (const Paraboloid& dish : dishes) {
    EXPECT_NEAR((dish.to_parent(a) - dish.to_parent(b)).norm(), (a - b).norm(), 1e-14);
    EXPECT_LE((dish.to_parent(a + dish.axis()) - dish.to_parent(a) - Vec3::UnitZ()).norm(), 1e-14);
  }
}

TEST(Paraboloid, ApertureSpansFromTheClearanceOn) {
  // The rim of the parent's cut-out, a cylinder of diameter D about X_0, is an ellipse that the z axis passes
  // through at its centre; its ends lie on X_A and X_A + D of the parent.
  const Paraboloid& dish = dishes[0];
  const double half_long_axis = 6 / std::cos(dish.tilt());
  EXPECT_NEAR(dish.to_parent({-half_long_axis, 0, dish.height(-half_long_axis, 0)}).x(), 1.125, 1e-12);
  EXPECT_NEAR(dish.to_parent({half_long_axis, 0, dish.height(half_long_axis, 0)}).x(), 13.125, 1e-12);
}

TEST(Paraboloid, AxisymmetricDishIsTheTextbookOne) {
  EXPECT_EQ(dishes[2].tilt(), 0);
  EXPECT_NEAR(dishes[2].height(3, 4), 25.0 / 24, 1e-15);
}

TEST(Paraboloid, SlopeIsTheDerivativeOfTheHeight) {
  const double h = 1e-5;  // central difference: h^2 z''' / 6 below 1e-11, rounding about 1e-11
  for (const Paraboloid& dish : dishes) {
    const double x = 0.31 * dish.aperture(), y = -0.22 * dish.aperture();
    const Vec3 z = dish.height_and_slope(x, y);
    EXPECT_EQ(z[0], dish.height(x, y));
    EXPECT_NEAR(z[1], (dish.height(x + h, y) - dish.height(x - h, y)) / (2 * h), 1e-9);
    EXPECT_NEAR(z[2], (dish.height(x, y + h) - dish.height(x, y - h)) / (2 * h), 1e-9);
  }
}

TEST(Paraboloid, LineThatMissesTheSurfaceIsAnError) {
  EXPECT_THROW(dishes[0].height(0, 1000), ModelError);
  EXPECT_THROW(dishes[0].height(-1000, 0), ModelError);
  EXPECT_THROW(dishes[0].height(std::numeric_limits<double>::quiet_NaN(), 0), ModelError);
}

TEST(Paraboloid, ParametersThatMakeNoDishAreErrors) {
  EXPECT_THROW(Paraboloid(0, 8, 1), ModelError);
  EXPECT_THROW(Paraboloid(12, -1, 1), ModelError);
  EXPECT_THROW(Paraboloid(12, 8, -6.1), ModelError);
  EXPECT_THROW(Paraboloid(12, 8, std::numeric_limits<double>::quiet_NaN()), ModelError);
  EXPECT_NO_THROW(Paraboloid(12, 8, -6));
}

}  // namespace
}  // namespace tautline::reflector
