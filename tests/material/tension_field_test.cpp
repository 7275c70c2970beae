#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <tautline/material/plane_stress.hpp>
#include <tautline/material/tension_field.hpp>

namespace tautline::material {

namespace {

const Vec3 zero = Vec3::Zero();
const double pi = std::acos(-1.);

Mat3 turned(const Mat3& D, double angle) {
  const Mat3 T = strain_rotation(angle);
  return T.transpose() * D * T;
}

/// Components 11, 22, 12 of t t, t at `angle` to axis 1.
Vec3 along(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * c, s * s, c * s};
}

Mat3 compliance(const OrthotropicStiffness& s) {
  Mat3 C;
  C << 1 / s.tension_1, -s.poisson_ratio / s.tension_1, 0, -s.poisson_ratio / s.tension_1, 1 / s.tension_2, 0,
      0, 0, 1 / s.shear;
  return C;
}

/// A sheet at a strain.
struct Case {
  Mat3 stiffness;
  Vec3 prestress, free_strain, strain;

  TensionFieldResponse relaxed(const Vec3& step = zero) const {
    return tension_field(stiffness, prestress, free_strain, strain + step);
  }
  PlaneStressResponse elastic(const Vec3& step = zero) const {
    return plane_stress(stiffness, prestress, free_strain, strain + step);
  }
};

/// Orthotropic sheets with ratios of stiffness to 100, any material axes, prestress, free strain and strain.
std::vector<Case> random_cases(int n) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&](double size) -> Vec3 {
    return size * Vec3::NullaryExpr([&] { return uniform(engine); });
  };
  std::vector<Case> cases;
  for (int i = 0; i < n; ++i) {
    const double E1 = 1000, E2 = E1 * std::pow(10, 2 * uniform(engine));
    const double nu12 = 0.6 * uniform(engine) * std::sqrt(E1 / E2),
                 G12 = E2 * (0.55 + 0.45 * uniform(engine));
    const Mat3 D = turned(plane_stress_stiffness({E1, E2, nu12, G12}), 3 * uniform(engine));
    cases.push_back({D, vector(2), vector(1e-3), vector(1e-2)});
  }
  return cases;
}

/// Least energy over strains added by wrinkles normal to the direction at `angle` to axis 1: a convex
/// parabola.
double energy_with_wrinkles(const Case& c, double angle) {
  const Vec3 wrinkle = along(angle).cwiseProduct(Vec3(1, 1, 2));
  const double stiffness = wrinkle.dot(c.stiffness * wrinkle);
  const double amplitude = std::max(0., -wrinkle.dot(c.elastic().pk2_resultant) / stiffness);
  return c.elastic(amplitude * wrinkle).energy_per_area;
}

/// Minimum over directions by trial: 2000 of them, then thirds of the best interval.
double least_energy_by_search(const Case& c) {
  const int n = 2000;
  int best = 0;
  double least = std::numeric_limits<double>::max();
  for (int i = 0; i < n; ++i) {
    const double energy = energy_with_wrinkles(c, i * pi / n);
    if (energy < least) {
      least = energy;
      best = i;
    }
  }
  double low = (best - 1) * pi / n, high = (best + 1) * pi / n;
  for (int i = 0; i < 60; ++i) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    (energy_with_wrinkles(c, a) < energy_with_wrinkles(c, b) ? high : low) =
        energy_with_wrinkles(c, a) < energy_with_wrinkles(c, b) ? b : a;
  }
  return energy_with_wrinkles(c, low);
}

double smaller_principal(const Vec3& N) {
  return (N[0] + N[1]) / 2 - std::hypot((N[0] - N[1]) / 2, N[2]);
}

}  // namespace

TEST(TensionField, TautSheetIsElastic) {
  const Mat3 D = plane_stress_stiffness(1e5, 0.3);
  const Vec3 strain(1e-3, 2e-3, 5e-4);
  const auto answer = tension_field(D, zero, zero, strain);
  const auto elastic = plane_stress(D, zero, zero, strain);
  EXPECT_EQ(answer.state, TensionState::taut);
  EXPECT_EQ(answer.energy_per_area, elastic.energy_per_area);
  EXPECT_EQ(answer.pk2_resultant, elastic.pk2_resultant);
  EXPECT_EQ(answer.tangent, D);
}

TEST(TensionField, UnstressedFlatSheetKeepsItsStiffness) {
  const Mat3 D = plane_stress_stiffness(1e5, 0.3);
  const auto answer = tension_field(D, zero, zero, zero);
  EXPECT_EQ(answer.state, TensionState::taut);
  EXPECT_EQ(answer.tangent, D);
}

TEST(TensionField, ContractionBeyondPoissonsLeavesUniaxialTension) {
  const double Eh = 1e5, strain = 1e-3;
  for (const double lateral : {-0.31, -0.9, -5.}) {
    const auto answer =
        tension_field(plane_stress_stiffness(Eh, 0.3), zero, zero, Vec3(strain, lateral * strain, 0));
    EXPECT_EQ(answer.state, TensionState::wrinkled);
    EXPECT_LT((answer.pk2_resultant - Vec3(Eh * strain, 0, 0)).norm(), 1e-12 * Eh * strain);
    EXPECT_NEAR(answer.energy_per_area, Eh * strain * strain / 2, 1e-12 * Eh * strain * strain);
    EXPECT_NEAR(answer.tangent(0, 0), Eh, 1e-11 * Eh);
    EXPECT_LT(answer.tangent.col(1).norm(), 1e-11 * Eh);
    // the rays turn: N12 = Eh E11 phi, phi = 2 E12/(2 (E11 - E22)), principal axes of the strain
    EXPECT_NEAR(answer.tangent(2, 2), Eh / (2 * (1 - lateral)), 1e-11 * Eh);
  }
}

TEST(TensionField, PureShearIsCarriedByDiagonalTension) {
  // Wagner (1929): tension Eh gamma/2 at 45 degrees, hence shear stiffness Eh/4
  const double Eh = 1e5, gamma = 2e-3;
  const auto answer = tension_field(plane_stress_stiffness(Eh, 0.3), zero, zero, Vec3(0, 0, gamma));
  EXPECT_EQ(answer.state, TensionState::wrinkled);
  EXPECT_LT((answer.pk2_resultant - Eh * gamma / 4 * Vec3(1, 1, 1)).norm(), 1e-12 * Eh * gamma);
  EXPECT_NEAR(answer.energy_per_area, Eh * gamma * gamma / 8, 1e-12 * Eh * gamma * gamma);
  EXPECT_NEAR(answer.tangent(2, 2), Eh / 4, 1e-11 * Eh);
}

TEST(TensionField, ShortenedSheetIsSlack) {
  const Mat3 D = turned(plane_stress_stiffness({1000, 30, 0.2, 20}), 0.4);
  const auto answer = tension_field(D, zero, zero, Vec3(-1e-3, -2e-3, 1e-3));
  EXPECT_EQ(answer.state, TensionState::slack);
  EXPECT_EQ(answer.pk2_resultant, zero);
  EXPECT_EQ(answer.tangent, Mat3::Zero());
  EXPECT_EQ(answer.energy_per_area, 0);
}

TEST(TensionField, PrestressIsLostBeforeTheSheetIsSlack) {
  // prestress n equals a strain n (1 - nu)/Eh in all directions
  const double Eh = 1e5, n = 50, nu = 0.3, strain = n * (1 - nu) / Eh;
  const auto state = [&](double shortening) {
    return tension_field(plane_stress_stiffness(Eh, nu), Vec3(n, n, 0), zero,
                         -shortening * strain * Vec3(1, 1, 0));
  };
  EXPECT_EQ(state(0.999).state, TensionState::taut);
  EXPECT_EQ(state(1.001).state, TensionState::slack);
  EXPECT_NEAR(state(2).energy_per_area, -n * strain, 1e-12 * n * strain);  // 2 n strain/2, given back
}

TEST(TensionField, OrthotropicSheetWrinklesAlongTheTension) {
  // Made from its answer: tension sigma t t at any angle to the material axes, elastic strain C : sigma t t,
  // less wrinkles beta n n. C from E1, E2, nu12, G12 directly. The second sheet is a balanced weave.
  const double sigma = 3;
  for (const auto& sheet : {OrthotropicStiffness{1000, 60, 0.4, 45}, OrthotropicStiffness{500, 500, 0.1, 20}})
    for (const double material : {0., 0.3, -1.1})
      for (double angle = -1.5; angle < 1.6; angle += 0.25)
        for (const double beta : {1e-6, 1e-2, 10.}) {
          const Vec3 tension = sigma * along(angle), elastic = compliance(sheet) * tension;
          const Vec3 wrinkles = beta * along(angle + pi / 2).cwiseProduct(Vec3(1, 1, 2));
          const Vec3 strain = strain_rotation(-material) * (elastic - wrinkles);
          const auto answer =
              tension_field(turned(plane_stress_stiffness(sheet), material), zero, zero, strain);
          EXPECT_EQ(answer.state, TensionState::wrinkled);
          const double rounding = 1e-13 * (1 + beta / elastic.norm());  // strain beta times the stiffness
          EXPECT_LT((answer.pk2_resultant - sigma * along(angle + material)).norm(), sigma * rounding);
          EXPECT_NEAR(answer.energy_per_area, tension.dot(elastic) / 2, tension.dot(elastic) * rounding);
        }
}

TEST(TensionField, EnergyIsTheLeastOverAllWrinkles) {
  int wrinkled = 0;
  for (const Case& c : random_cases(200)) {
    const auto answer = c.relaxed();
    const double scale = c.strain.dot(c.stiffness * c.strain);
    if (answer.state == TensionState::slack) {  // wrinkles in two directions: less than any in one
      EXPECT_LE(answer.energy_per_area, least_energy_by_search(c) + 1e-13 * scale);
      continue;
    }
    EXPECT_NEAR(answer.energy_per_area, least_energy_by_search(c), 1e-12 * scale);
    wrinkled += answer.state == TensionState::wrinkled;
  }
  EXPECT_GT(wrinkled, 50);
}

TEST(TensionField, EnergyIsConvexAndNotAboveTheElasticOne) {
  const auto cases = random_cases(300);
  for (std::size_t i = 0; i + 1 < cases.size(); ++i) {
    const Case& c = cases[i];
    const Vec3 other = cases[i + 1].strain - c.strain;
    const auto at = [&](double share) { return c.relaxed(share * other).energy_per_area; };
    const double scale = c.strain.dot(c.stiffness * c.strain) + other.dot(c.stiffness * other);
    EXPECT_LE(at(0), c.elastic().energy_per_area + 1e-14 * scale);
    for (double share = -0.9; share < 2; share += 0.1)
      EXPECT_LE(at(share), (at(share - 0.1) + at(share + 0.1)) / 2 + 1e-14 * scale);
  }
}

TEST(TensionField, NoPrincipalResultantIsNegative) {
  for (const Case& c : random_cases(300)) {
    const auto answer = c.relaxed();
    EXPECT_GE(smaller_principal(answer.pk2_resultant), -1e-13 * c.stiffness.norm() * c.strain.norm());
    if (answer.state == TensionState::wrinkled) {
      EXPECT_GT(answer.pk2_resultant[0] + answer.pk2_resultant[1], 0);
    }
  }
}

TEST(TensionField, ResultantAndTangentAreDerivatives) {
  // Five-point formula. A step that crosses a switch is left out: there the tangent jumps.
  const double h = 1e-5;
  int wrinkled = 0;
  for (const Case& c : random_cases(300)) {
    const auto answer = c.relaxed();
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(answer.tangent);
    EXPECT_GE(eigen.eigenvalues()[0], -1e-14 * c.stiffness.norm());
    for (int i = 0; i < 3; ++i) {
      const auto at = [&](double step) { return c.relaxed(step * h * Vec3::Unit(i)); };
      if (at(-20).state != answer.state || at(20).state != answer.state) continue;
      const double slope = (8 * (at(1).energy_per_area - at(-1).energy_per_area) -
                            (at(2).energy_per_area - at(-2).energy_per_area)) /
                           (12 * h);
      const Vec3 column =
          (8 * (at(1).pk2_resultant - at(-1).pk2_resultant) - (at(2).pk2_resultant - at(-2).pk2_resultant)) /
          (12 * h);
      EXPECT_NEAR(slope, answer.pk2_resultant[i], 1e-8 * c.stiffness.norm() * c.strain.norm());
      EXPECT_LT((column - answer.tangent.col(i)).norm(), 1e-6 * c.stiffness.norm());
      wrinkled += answer.state == TensionState::wrinkled;
    }
  }
  EXPECT_GT(wrinkled, 200);
}

TEST(TensionField, EnergyAndResultantAreContinuousAcrossTheSwitches) {
  // On lines between random strains: where the label changes, nothing jumps. Between points 1e-9 apart the
  // resultant changes by no more than D times that (the projection on a convex set lengthens nothing).
  int switches[2] = {0, 0};
  const auto cases = random_cases(300);
  for (std::size_t i = 0; i + 1 < cases.size(); ++i) {
    const Case& c = cases[i];
    const Vec3 other = cases[i + 1].strain - c.strain;
    double low = 0, high = 1;
    if (c.relaxed(low * other).state == c.relaxed(high * other).state) continue;
    const TensionState start = c.relaxed().state;
    while (high - low > 1e-9) {
      const double middle = (low + high) / 2;
      (c.relaxed(middle * other).state == start ? low : high) = middle;
    }
    const auto before = c.relaxed(low * other), after = c.relaxed(high * other);
    const double change = c.stiffness.norm() * other.norm() * (high - low);
    EXPECT_LT((after.pk2_resultant - before.pk2_resultant).norm(), 2 * change);
    const double mean_work = (high - low) * other.dot(before.pk2_resultant + after.pk2_resultant) / 2;
    const double rounding = 1e-15 * (c.prestress.dot(c.stiffness.inverse() * c.prestress) +
                                     c.stiffness.norm() * other.squaredNorm());
    EXPECT_NEAR(after.energy_per_area - before.energy_per_area, mean_work,
                change * other.norm() * (high - low) + rounding);
    ++switches[start == TensionState::slack || after.state == TensionState::slack];
  }
  EXPECT_GT(switches[0], 20);
  EXPECT_GT(switches[1], 20);
}

TEST(TensionField, ThermalStrainSlackensAHeldSheet) {
  const double Eh = 1e5, expansion = 1e-4;
  const Mat3 D = plane_stress_stiffness(Eh, 0.3);
  const Vec3 free_strain(expansion, expansion, 0);
  EXPECT_EQ(tension_field(D, zero, free_strain, zero).state, TensionState::slack);
  const auto cooled = tension_field(D, zero, -free_strain, zero);
  EXPECT_EQ(cooled.state, TensionState::taut);
  EXPECT_NEAR(cooled.pk2_resultant[0], Eh * expansion / 0.7, 1e-11);
}

// A side that keeps its length beside one that grows shorter: at the border of wrinkled and slack there is no
// tension, and no direction of it either.
TEST(TensionField, IsSlackWhereThePrincipalStrainIsZero) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> angle(0, pi), size(-12, 0), any(0.05, 0.45);
  for (int i = 0; i < 20000; ++i) {
    const double nu = any(random), shortening = std::pow(10, size(random));
    const double stiffness = 1e6 / (1 - nu * nu);
    Mat3 D;
    D << stiffness, nu * stiffness, 0, nu * stiffness, stiffness, 0, 0, 0, stiffness * (1 - nu) / 2;
    const Vec3 n = along(angle(random));
    const Vec3 strain = -shortening * Vec3(n[0], n[1], 2 * n[2]);
    const auto found = tension_field(D, zero, zero, strain);
    ASSERT_TRUE(found.pk2_resultant.allFinite() && found.tangent.allFinite()) << strain.transpose();
    EXPECT_LE(found.pk2_resultant.norm(), 1e-12 * stiffness * shortening);
  }
}

}  // namespace tautline::material
