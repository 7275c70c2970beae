#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <limits>
#include <tautline/element/cable.hpp>
#include <tautline/element/catenary.hpp>
#include <utility>

namespace tautline::element {

namespace {

const Vec3 gravity(0, 0, -9.81);
const double rounding = std::numeric_limits<double>::epsilon();

Mat<3, 2> between(const Vec3& a, const Vec3& b) {
  Mat<3, 2> x;
  x << a, b;
  return x;
}

CatenaryResponse at_rest(const CatenaryProperties& properties, const Vec3& acceleration, const Vec3& a,
                         const Vec3& b) {
  return evaluate_catenary(properties, acceleration, between(a, b), Vec<6>::Zero(), Want::tangent);
}

/// Irvine's elastic catenary, Cable Structures (1981), section 1.3, in his variables: horizontal tension H
/// and vertical reaction V of the upper first end, weight W over the unstressed length L.
struct Irvine {
  double H, V, W, L, EA;

  double across(double s) const {
    const double down = V - W * s / L;
    return H * s / EA + H * L / W * (std::asinh(V / H) - std::asinh(down / H));
  }
  double down(double s) const {
    const double T0 = std::hypot(H, V), T = std::hypot(H, V - W * s / L);
    return W * s / EA * (V / W - s / (2 * L)) + H * L / W * (T0 / H - T / H);
  }
};

}  // namespace

// --- published and closed forms
// --------------------------------------------------------------------------------------------

TEST(Catenary, SagOfALevelSpanIsThatOfCodeAster) {
  // SSNL114 of Code_Aster: span 325 m, L0 = 325 m, then heated, all digits published. Its formula keeps the
  // weight per unstressed length when the length grows.
  const double A = 2.2783e-4, E = 5.7e10, rho = 2844.23, l = 325;
  const auto cold = at_rest({E * A, l, rho * A}, gravity, Vec3(0, 0, 0), Vec3(l, 0, 0));
  EXPECT_NEAR(cold.sag, 6.352161, 5e-7);
  const double hot_length = l * (1 + 2.3e-5 * 39.26);
  const auto hot = at_rest({E * A, hot_length, rho * A}, gravity, Vec3(0, 0, 0), Vec3(l, 0, 0));
  EXPECT_NEAR(hot.sag, 8.195452, 5e-7);
}

TEST(Catenary, CarriesTheReactionsOfIrvinesElasticCatenary) {
  // The chord is made of the reactions, the element finds them again: slack and taut, hanging through and
  // not, steep and stretchy. The rounding of the chord moves the tension by EA times it at most.
  for (const Irvine& c :
       {Irvine{100, 120, 200, 50, 1e5}, Irvine{3, 190, 200, 50, 1e7}, Irvine{5000, 300, 200, 50, 1e5},
        Irvine{20, 900, 200, 50, 1e3}, Irvine{1e-3, 150, 200, 50, 1e8}, Irvine{700, -400, 200, 50, 1e5}}) {
    const Vec3 chord(0.6 * c.across(c.L), 0.8 * c.across(c.L), -c.down(c.L));
    const auto cable = at_rest({c.EA, c.L, c.W / c.L / 9.81}, gravity, Vec3(0, 0, 0), chord);
    // internal force: minus what the support gives at the first end, weight included
    const double tolerance = 20 * rounding * (std::hypot(c.H, c.V) + cable.tangent.norm() * c.L);
    EXPECT_LT((cable.force.head<3>() - Vec3(-0.6 * c.H, -0.8 * c.H, c.V)).norm(), tolerance) << c.H;
    EXPECT_LT((cable.force.tail<3>() - Vec3(0.6 * c.H, 0.8 * c.H, c.W - c.V)).norm(), tolerance) << c.H;
    EXPECT_NEAR(cable.tension_start, std::hypot(c.H, c.V), tolerance);
    EXPECT_NEAR(cable.tension_end, std::hypot(c.H, c.V - c.W), tolerance);
  }
}

TEST(Catenary, ShapeIsIrvines) {
  const Irvine c{100, 120, 200, 50, 1e4};
  const Mat<3, 2> x = between(Vec3(1, 2, 3), Vec3(1 + c.across(c.L), 2, 3 - c.down(c.L)));
  const Points points = catenary_shape({c.EA, c.L, c.W / c.L / 9.81}, gravity, x, Vec<6>::Zero(), 10);
  ASSERT_EQ(points.size(), 11);
  for (int i = 0; i <= 10; ++i)
    EXPECT_LT((points[i] - Vec3(1 + c.across(5. * i), 2, 3 - c.down(5. * i))).norm(), 1e-12);
}

TEST(Catenary, LooseWithoutWeightIsDrawnAlongItsChordInEqualParts) {
  const Points points =
      catenary_shape({1e4, 6, 1}, Vec3::Zero(), between(Vec3(1, 2, 3), Vec3(5, 2, 0)), Vec<6>::Zero(), 4);
  ASSERT_EQ(points.size(), 5);
  for (int i = 0; i <= 4; ++i) EXPECT_LT((points[i] - Vec3(1 + i, 2, 3 - 0.75 * i)).norm(), 1e-15);
}

TEST(Catenary, LoadedIsolatedCableMovesAsPublished) {
  // Problem of Michalos & Birnstiel (1962): span 1000 ft, 3.16 lb/ft, A = 0.85 in^2, E = 19000 ksi, 8 kips at
  // 400 ft, unstressed lengths 412.8837 and 613.0422 ft. Jayaraman & Knudson (1981): under its weight the
  // loaded point is 29.276 m below the supports, the load moves it by (-0.859, -5.626) m.
  const double foot = 0.3048, EA = 19e6 * 0.85, pound_per_foot = 3.16;
  const CatenaryProperties left{EA, 412.8837, pound_per_foot}, right{EA, 613.0422, pound_per_foot};
  const Vec3 down(0, 0, -1);
  const auto loaded = [&](double load) {
    Vec3 x(400, 0, -95);
    for (int i = 0; i < 30; ++i) {
      const auto a = at_rest(left, down, Vec3(0, 0, 0), x);
      const auto b = at_rest(right, down, x, Vec3(1000, 0, 0));
      const Vec3 rest = load * down - a.force.tail<3>() - b.force.head<3>();
      const Vec3 step = (a.tangent.block<3, 3>(3, 3) + b.tangent.block<3, 3>(0, 0)).inverse() * rest;
      x += step * std::min(1., 10 / step.norm());
    }
    return x;
  };
  const Vec3 own = loaded(0), moved = loaded(8000) - own;
  EXPECT_NEAR(own[0] * foot, 121.92, 5e-4);  // half of the last digit published, here and below
  EXPECT_NEAR(own[2] * foot, -29.276, 5e-4);
  EXPECT_NEAR(moved[0] * foot, -0.859, 5e-4);
  EXPECT_NEAR(moved[2] * foot, -5.626, 5e-4);
}

TEST(Catenary, InextensibleCableIsACosh) {
  // level span l: L = 2 a sinh(l/2a), sag = a (cosh(l/2a) - 1), H = w a. Shallow, deep, and a U of depth 10
  // spans.
  for (const double half_over_a : {0.1, 1., 5.}) {
    const double a = 7, l = 2 * a * half_over_a, L = 2 * a * std::sinh(half_over_a);
    const double w = 2 * 9.81, EA = 1e15 * w * a;
    const auto cable = at_rest({EA, L, 2}, gravity, Vec3(0, 0, 0), Vec3(0, l, 0));
    // the stretch of 1e-15 changes the tension of the shallow cable by 3e-13
    EXPECT_NEAR(cable.force[4] / (w * a), 1, 1e-12);
    EXPECT_NEAR(cable.sag / (a * (std::cosh(half_over_a) - 1)), 1, 1e-12);
    EXPECT_NEAR(cable.tension_start / (w * a * std::cosh(half_over_a)), 1, 1e-12);
    EXPECT_NEAR(cable.length / L, 1, 1e-13);  // T/EA, T up to 74 w a
    EXPECT_TRUE(cable.slack);
  }
}

TEST(Catenary, HangsAndStretchesByItsWeightAndALoad) {
  // A cable straight down: elongation w L^2/(2 EA) + P L/EA; stiffness EA/L along, and across the inverse of
  // ln(1 + w L/P)/w + L/EA. From stiff to stretchy.
  const double L = 50, w = 9.81, P = 100;
  for (const double EA : {1e3, 1e6, 1e9}) {
    const double l = L + w * L * L / (2 * EA) + P * L / EA;
    const auto cable = at_rest({EA, L, 1}, gravity, Vec3(1, 2, 3), Vec3(1, 2, 3 - l));
    const double tolerance = 4 * rounding * EA;  // of the chord against EA/L
    EXPECT_NEAR(cable.tension_end, P, tolerance);
    EXPECT_NEAR(cable.tension_start, P + w * L, tolerance);
    EXPECT_NEAR(cable.force[2], P + w * L, tolerance);
    EXPECT_NEAR(cable.force[5], -P, tolerance);
    EXPECT_NEAR(cable.length, l, 1e-13 * l);
    EXPECT_FALSE(cable.slack);
    EXPECT_NEAR(cable.tangent(5, 5) / (EA / L), 1, 1e-10);
    const double across = 1 / (std::log1p(w * L / P) / w + L / EA);
    EXPECT_NEAR(cable.tangent(3, 3) / across, 1, 10 * tolerance / P + 1e-13);
    EXPECT_NEAR(cable.tangent(4, 4) / across, 1, 10 * tolerance / P + 1e-13);
  }
}

TEST(Catenary, HangsDownBothWaysWhereItsEndsAreAbovePlumb) {
  // Inextensible: of length L with the ends l apart in one plumb line, (L + l)/2 hang from the upper end and
  // (L - l)/2 from the lower one; lowering that end by 1 takes the weight of half of it over: stiffness w/2.
  // For l = 0 it is a loop.
  const double L = 10, w = 2 * 9.81;
  for (const double l : {0., 1e-12, 3., 9.99}) {
    const auto cable = at_rest({1e17, L, 2}, gravity, Vec3(1, 2, 3), Vec3(1, 2, 3 - l));
    EXPECT_NEAR(cable.force[2], w * (L + l) / 2, 1e-11);
    EXPECT_NEAR(cable.force[5], w * (L - l) / 2, 1e-11);
    EXPECT_LT(cable.force({0, 1, 3, 4}).norm(), 1e-15 * w * L);
    EXPECT_NEAR(cable.tangent(5, 5), w / 2, 1e-11);
    // across: zero in the limit, but never singular
    EXPECT_GT(cable.tangent(3, 3), 0);
    EXPECT_LT(cable.tangent(3, 3), w / 50);
    EXPECT_GT(cable.tangent(4, 4), 0);
    EXPECT_TRUE(cable.tangent.allFinite());
    // The loop's bottom is L/2 below the middle of the chord and (L + l)/2 below its upper end.
    EXPECT_GE(cable.sag, L / 2 - 1e-12);
    EXPECT_LE(cable.sag, (L + l) / 2);
  }
}

// --- without weight, and almost
// --------------------------------------------------------------------------------------------

TEST(Catenary, WithoutWeightIsTheTensionOnlyCable) {
  const Mat<3, 2> x = between(Vec3(1, -2, 0.5), Vec3(3, 1, 1));
  Vec<6> u;
  u << 0.1, -0.2, 0.05, 0.3, 0.4, -0.2;
  const double L0 = 3.5, EA = 2000;
  const CableProperties properties{EA, (x.col(1) - x.col(0)).norm() / L0 - 1};
  const auto straight = evaluate_cable(properties, x, u, Want::tangent);
  for (const CatenaryProperties& p : {CatenaryProperties{EA, L0, 0}, CatenaryProperties{EA, L0, 1e-20}}) {
    const auto cable = evaluate_catenary(p, gravity, x, u, Want::tangent);
    EXPECT_NEAR(cable.energy, straight.energy, 1e-14 * straight.energy);
    EXPECT_LT((cable.force - straight.force).norm(), 1e-14 * straight.force.norm());
    EXPECT_LT((cable.tangent - straight.tangent).norm(), 1e-14 * straight.tangent.norm());
    EXPECT_NEAR(cable.tension_start, straight.tension, 1e-14 * straight.tension);
    EXPECT_NEAR(cable.sag, 0, 1e-20);
  }
}

TEST(Catenary, SlackWithoutWeightHasNeitherForceNorTangent) {
  for (const Vec3& end : {Vec3(4, 0, 0), Vec3(3, 1, 1), Vec3(0, 0, 0)}) {
    for (const auto& [mass, acceleration] : {std::pair(0., gravity), std::pair(1., Vec3(0, 0, 0))}) {
      const auto cable = at_rest({1e6, 4, mass}, acceleration, Vec3(0, 0, 0), end);
      EXPECT_EQ(cable.energy, 0);
      EXPECT_EQ(cable.force, Vec<6>::Zero());
      EXPECT_EQ(cable.tangent, Mat<6>::Zero());
      EXPECT_EQ(cable.length, 4);
      EXPECT_TRUE(cable.slack);
    }
  }
}

TEST(Catenary, SlackForceAndTangentVanishInProportionToTheWeight) {
  const auto heavy = at_rest({1e12, 5, 1}, gravity, Vec3(0, 0, 0), Vec3(3, 1, 1));
  for (const double mass : {1e-3, 1e-6, 1e-9}) {
    const auto light = at_rest({1e12, 5, mass}, gravity, Vec3(0, 0, 0), Vec3(3, 1, 1));
    // what is not proportional is the stretch, 50 N/EA
    EXPECT_LT((light.force - mass * heavy.force).norm(), 1e-9 * mass * heavy.force.norm());
    EXPECT_LT((light.tangent - mass * heavy.tangent).norm(), 1e-9 * mass * heavy.tangent.norm());
    EXPECT_NEAR(light.sag, heavy.sag, 1e-9);
  }
}

TEST(Catenary, ShortStiffTieKeepsTheDigitsOfItsTension) {
  // As Cable.ShortStiffTieKeepsTheDigitsOfItsTension: the rounding of lengths would leave 2e-9 N. The weight
  // of 2e-13 N does nothing to it.
  const Mat<3, 2> x = between(Vec3(12, 15, 3.02), Vec3(12, 15, 3));
  const double length = x(2, 0) - x(2, 1);
  const double EA = 1e6 * length, L0 = length / 1.0005;
  for (const double mass : {0., 1e-12}) {
    for (const double pull : {0., 1e-13, -1e-12, 1e-10, 1e-7}) {
      const Vec3 u1(0.3, -0.2, 0.1);
      const Vec3 u2 = u1 - Vec3(0, 0, pull);
      Vec<6> u;
      u << u1, u2;
      const auto tie = evaluate_catenary({EA, L0, mass}, gravity, x, u, Want::force);
      const double elongation = (length - L0) + (u1[2] - u2[2]);
      EXPECT_NEAR(tie.tension_end, EA * elongation / L0, 1e-12);
    }
  }
}

TEST(Catenary, AlmostInextensibleTautCableKeepsTheDigitsOfItsTension) {
  // Level, from H = 1e3 to 1e6 weights: elongation/L = H/EA + asinh(x)/x - 1 with x = w L/(2 H), as a series.
  // It is given as a displacement, so that all its digits reach the element.
  const double L = 256, w = 1e-2;
  for (const double EA : {1e9 * w * L, 1e12 * w * L}) {
    for (const double H : {1e3 * w * L, 1e4 * w * L, 1e6 * w * L}) {
      const double x = w * L / (2 * H);
      Vec<6> u = Vec<6>::Zero();
      u[3] = L * (H / EA - x * x / 6 * (1 - 9 * x * x / 20));
      const auto cable = evaluate_catenary({EA, L, w}, Vec3(0, 0, -1), between(Vec3(0, 0, 0), Vec3(L, 0, 0)),
                                           u, Want::force);
      EXPECT_NEAR(cable.force[3] / H, 1, 1e-14) << EA << ' ' << H;
      EXPECT_NEAR(cable.force[5], w * L / 2, 1e-15 * H);
    }
  }
}

TEST(Catenary, LevelUnderWeightIceAndWindHangsInThePlaneOfItsWholeLoad) {
  // sinh(u)/u = L/l = 1.02 at u = 0.3453787954983181: H = w l/(2 u), half of the load at either end
  const double l = 10, L = 10.2, mass = 1.5, u = 0.3453787954983181;
  const Vec3 ice(0, 0, -2), wind(0, 7, 0);
  const auto cable = at_rest({1e15, L, mass, ice + wind}, gravity, Vec3(1, 2, 3), Vec3(1 + l, 2, 3));
  const Vec3 whole = mass * gravity + ice + wind;
  EXPECT_NEAR(cable.force[3], whole.norm() * l / (2 * u), 1e-10 * whole.norm() * l);
  EXPECT_LT((cable.force.segment<2>(1) + L / 2 * whole.tail<2>()).norm(), 1e-12 * whole.norm());
  EXPECT_LT((cable.force.segment<2>(4) + L / 2 * whole.tail<2>()).norm(), 1e-12 * whole.norm());
}

// --- equilibrium, objectivity, energy
// --------------------------------------------------------------------------------------------

namespace {

struct State {
  CatenaryProperties properties;
  Vec3 acceleration;
  Vec3 end;  ///< the first one at (1, 2, 3)
};

const Vec3 start(1, 2, 3);
const std::array<State, 4> states{{{{2000, 4, 0.5}, Vec3(2, -4, -8), Vec3(3.3, 5.4, 3.2)},  // taut
                                   {{2000, 7, 0.5}, Vec3(2, -4, -8), Vec3(3.3, 5.4, 3.2)},  // slack
                                   {{300, 5, 3}, Vec3(0, 0, -10), Vec3(1, 2.5, -2)},        // steep
                                   {{2e5, 9, 1}, Vec3(5, 0, 0), Vec3(1, 2.3, 3)}}};         // a deep U

/// Integral over the unstressed length by Simpson's rule over the shape's points.
template <class F>
auto integral(const State& s, const F& f) {
  const int parts = 2000;
  const Points shape =
      catenary_shape(s.properties, s.acceleration, between(start, s.end), Vec<6>::Zero(), parts);
  const double h = s.properties.unstressed_length / parts;
  auto sum = (f(0., shape[0]) * 1.).eval();
  sum.setZero();
  for (int i = 0; i <= parts; ++i)
    sum += h / 3 * (i == 0 || i == parts ? 1 : i % 2 == 1 ? 4 : 2) * f(h * i, shape[i]);
  return sum;
}

}  // namespace

TEST(Catenary, ForcesAndWeightBalance) {
  for (const State& s : states) {
    const auto cable = at_rest(s.properties, s.acceleration, start, s.end);
    const Vec3 weight = s.properties.mass_per_length * s.properties.unstressed_length * s.acceleration;
    const Vec3 f1 = cable.force.head<3>(), f2 = cable.force.tail<3>();
    EXPECT_LT((f1 + f2 + weight).norm(), 1e-14 * weight.norm());
    const Vec3 moment = integral(s, [&](double, const Vec3& x) -> Vec3 {
      return x.cross(s.properties.mass_per_length * s.acceleration);
    });
    // Simpson's error: at the bottom of the U the tension falls to H = 1.1 N within 0.2 m, 45 steps
    EXPECT_LT((start.cross(f1) + s.end.cross(f2) + moment).norm(), 1e-8 * cable.force.norm());
  }
}

TEST(Catenary, EnergyIsElasticMinusWorkOfTheWeight) {
  for (const State& s : states) {
    const auto cable = at_rest(s.properties, s.acceleration, start, s.end);
    const Vec3 w = s.properties.mass_per_length * s.acceleration;
    const double EA = s.properties.axial_stiffness;
    const Vec<3> sum = integral(s, [&](double at, const Vec3& x) -> Vec3 {
      const double tension = (-cable.force.head<3>() - at * w).norm();
      return Vec3(tension * tension / (2 * EA) - w.dot(x), tension / EA, 0);
    });
    EXPECT_NEAR(cable.energy, sum[0], 1e-8 * std::abs(sum[0]));
    EXPECT_NEAR(cable.length, s.properties.unstressed_length + sum[1], 1e-8);
  }
}

TEST(Catenary, SagIsTheLargestDistanceOfTheShape) {
  for (const State& s : states) {
    const auto cable = at_rest(s.properties, s.acceleration, start, s.end);
    const Points shape =
        catenary_shape(s.properties, s.acceleration, between(start, s.end), Vec<6>::Zero(), 3000);
    const Vec3 g = s.acceleration.normalized(), chord = s.end - start;
    const Vec3 across = (chord - g * g.dot(chord)).normalized();
    double largest = 0;
    for (const Vec3& x : shape) {
      const double part = across.dot(x - start) / across.dot(chord);
      largest = std::max(largest, g.dot(x - start - part * chord));
    }
    EXPECT_NEAR(cable.sag, largest,
                1e-5 * largest);  // points miss the largest by the square of their distance
    EXPECT_GE(cable.sag, largest * (1 - 1e-12));
  }
}

TEST(Catenary, TurnsWithItsEndsAndTheAcceleration) {
  for (const State& s : states) {
    const auto before = at_rest(s.properties, s.acceleration, start, s.end);
    for (const double angle : {0.3, 1.6, 3.14, 4.}) {
      const Mat3 Q = Eigen::AngleAxisd(angle, Vec3(2, -1, 2) / 3).toRotationMatrix();
      const auto after = at_rest(s.properties, Q * s.acceleration, Q * start, Q * s.end);
      Mat<6> QQ = Mat<6>::Zero();
      QQ.topLeftCorner<3, 3>() = QQ.bottomRightCorner<3, 3>() = Q;
      EXPECT_NEAR(after.energy, before.energy, 1e-13 * before.force.norm());
      EXPECT_LT((after.force - QQ * before.force).norm(), 1e-13 * before.tangent.norm());
      EXPECT_LT((after.tangent - QQ * before.tangent * QQ.transpose()).norm(), 1e-11 * before.tangent.norm());
      EXPECT_NEAR(after.sag, before.sag, 1e-12);
    }
  }
}

// --- everywhere
// --------------------------------------------------------------------------------------------

TEST(Catenary, ConvergesFromSlackToTautAndFromLevelToPlumb) {
  // The chord that Irvine's equations give for the end force found, in extended precision, is the chord asked
  // for.
  using Real = long double;
  const double L = 3;
  const auto angles = {
      0., 1e-15, 1e-9, 1e-4, 0.1, 0.8, 1.57, 1.5707963267948966, 2.5, 3.1415926, 3.141592653589793};
  for (const double EA_over_weight : {1e-2, 1., 1e3, 1e6, 1e9, 1e12}) {
    for (const double strain : {-1., -0.999999, -0.5, -1e-3, -1e-7, -1e-12, 0., 1e-12, 1e-9, 1e-4, 0.5, 3.}) {
      for (const double angle : angles) {  // of the chord against the weight
        const double weight = 20, EA = EA_over_weight * weight;
        const Vec3 end = L * (1 + strain) * Vec3(std::sin(angle), 0, -std::cos(angle));
        const auto cable = at_rest({EA, L, weight / L}, Vec3(0, 0, -1), Vec3(0, 0, 0), end);
        ASSERT_TRUE(cable.tangent.allFinite());
        const Real H = -static_cast<Real>(cable.force[0]), w = static_cast<Real>(weight) / L;
        const Real t1 = cable.force[2], t2 = t1 - w * L;
        const Real T1 = std::hypot(H, t1), T2 = std::hypot(H, t2);
        const Real log = H == 0 ? 0 : std::asinh(t1 / std::abs(H)) - std::asinh(t2 / std::abs(H));
        const Real across = H * L / EA + H / w * log;
        const Real down = (t1 + t2) / 2 * L / EA + (T1 - T2) / w;
        // rounding of the force, 1e-15 of it, against a flexibility of at most 50 L/weight
        // difference of logarithms and tensions in extended precision
        const double tolerance =
            2e-13 * L * (1 + cable.tension_start / EA) + 1e-18 * cable.tension_start * L / weight;
        EXPECT_NEAR(across, end[0], tolerance) << EA_over_weight << ' ' << strain << ' ' << angle;
        EXPECT_NEAR(down, -end[2], tolerance) << EA_over_weight << ' ' << strain << ' ' << angle;
      }
    }
  }
}

}  // namespace tautline::element
