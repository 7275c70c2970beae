#include <tautline/rod/meridian.hpp>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <tautline/core/error.hpp>

namespace tautline::rod {
namespace {

/// Length of Y = lambda X^2 from the vertex.
double parabola_length(double lambda, double x) {
  const double slope = 2 * lambda * x;
  return x / 2 * std::hypot(1, slope) + std::asinh(slope) / (4 * lambda);
}

TEST(Meridian, ParabolaHasTheLengthOfTheClosedForm) {
  for (const double lambda : {1.0 / 15, 1.0 / 5, 3.0}) {
    const Meridian parabola = Meridian::parabola(lambda);
    const double exact = parabola_length(lambda, 9) - parabola_length(lambda, 0.25);
    EXPECT_NEAR(parabola.arc_length(0.25, 9), exact, 1e-13 * exact);
    EXPECT_NEAR(parabola.arc_length(9, 0.25), -exact, 1e-13 * exact);
    EXPECT_NEAR(parabola.advance(0.25, exact), 9, 1e-13);
  }
}

// Normal to Y = X^2/4 at X = 2: direction (-1, 1)/sqrt(2).
TEST(Meridian, DistanceIsAlongTheNormal) {
  const Meridian parabola = Meridian::parabola(0.25);
  const double d = 0.3 / std::numbers::sqrt2;
  EXPECT_NEAR(parabola.distance(2 - d, 1 + d), 0.3, 1e-14);
  EXPECT_NEAR(parabola.distance(2 + d, 1 - d), -0.3, 1e-14);
  EXPECT_EQ(parabola.distance(2, 1), 0);
}

TEST(Meridian, TableIsExactForAStraightLine) {
  const Meridian line = Meridian::table({0, 1, 3, 4}, {1, 3, 7, 9});
  for (const double x : {-1.0, 0.0, 0.3, 2.9, 4.0, 5.0}) {
    EXPECT_NEAR(line.at(x).value, 1 + 2 * x, 1e-14);
    EXPECT_NEAR(line.at(x).slope, 2, 1e-14);
  }
  EXPECT_NEAR(line.arc_length(0, 4), 4 * std::sqrt(5), 1e-13);
}

TEST(Meridian, TablePassesThroughItsPointsAndNeverTurnsBack) {
  const std::vector<double> x{0, 1, 2, 3, 4, 5}, y{0, 0, 0.1, 5, 5, 6};
  const Meridian table = Meridian::table(x, y);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(table.at(x[i]).value, y[i], 1e-14);
  for (double at = 0; at < 5; at += 0.01) EXPECT_GE(table.at(at).slope, -1e-14) << at;
}

TEST(Meridian, TableHasTheDerivativesOfItsValues) {
  const Meridian table = Meridian::table({0, 1, 2, 4}, {0, 0.5, 2, 8});
  for (const double x : {0.4, 1.7, 3.1}) {
    const double h = 1e-6;
    EXPECT_NEAR((table.at(x + h).value - table.at(x - h).value) / (2 * h), table.at(x).slope, 1e-9);
    EXPECT_NEAR((table.at(x + h).slope - table.at(x - h).slope) / (2 * h), table.at(x).curvature, 1e-8);
  }
}

TEST(Meridian, TableIsExactForAParabola) {
  const Meridian table = Meridian::table({0, 1, 2.5, 3, 4.5}, {0, 0.1, 0.625, 0.9, 2.025});
  for (double x = 0; x < 4.5; x += 0.1) {
    EXPECT_NEAR(table.at(x).value, 0.1 * x * x, 1e-14);
    EXPECT_NEAR(table.at(x).slope, 0.2 * x, 1e-14);
  }
}

// Cubics between points with slopes of fourth order.
TEST(Meridian, FineTableIsTheCurveItsPointsAreOf) {
  const auto error = [](int n) {
    std::vector<double> x, y;
    for (int i = 0; i <= n; ++i) {
      x.push_back(10.0 * i / n);
      y.push_back(std::cosh(x.back() / 4));
    }
    const Meridian table = Meridian::table(x, y);
    double largest = 0;
    for (double at = 0; at < 10; at += 0.01)
      largest = std::max(largest, std::abs(table.at(at).value - std::cosh(at / 4)));
    return largest;
  };
  EXPECT_NEAR(std::log2(error(20) / error(40)), 4, 0.3);
}

TEST(Meridian, FormulaHasTheDerivativesOfTheClosedForm) {
  const Meridian curve = Meridian::expression("0.5 - X + 2*X^2 + X^3/4");
  const Jet at = curve.at(3);
  EXPECT_NEAR(at.value, 0.5 - 3 + 18 + 6.75, 1e-14);
  EXPECT_NEAR(at.slope, -1 + 12 + 6.75, 1e-14);
  EXPECT_NEAR(at.curvature, 4 + 4.5, 1e-14);
  EXPECT_THROW(Meridian::expression("2*"), ModelError);
}

// (1, 1/2) is as far from y = x^2 as (x, x^2) with 4 x^3 = 2.
TEST(Meridian, FootIsTheNearestPoint) {
  EXPECT_NEAR(Meridian::parabola(1).foot(1, 0.5), std::cbrt(0.5), 1e-13);
}

TEST(Meridian, RefusesATableThatIsNoCurve) {
  EXPECT_THROW(Meridian::table({1}, {1}), ModelError);
  EXPECT_THROW(Meridian::table({0, 1, 1}, {0, 1, 2}), ModelError);
  EXPECT_THROW(Meridian::table({0, 1}, {0, 1, 2}), ModelError);
}

}  // namespace
}  // namespace tautline::rod
