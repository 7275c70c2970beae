#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <tautline/material/plane_stress.hpp>

namespace tautline::material {

namespace {

PlaneStressResponse elastic(const Mat3& D, const Vec3& green_strain) {
  return plane_stress(D, Vec3::Zero(), Vec3::Zero(), green_strain);
}

const OrthotropicStiffness lamina{5e5, 2e4, 0.25, 1.2e4};

/// D of the lamina whose fibres make the angle with axis 1.
Mat3 off_axis(double angle) {
  const Mat3 T = strain_rotation(angle);
  return T.transpose() * plane_stress_stiffness(lamina) * T;
}

}  // namespace

TEST(PlaneStress, UniaxialStressGivesPoissonContraction) {
  const Mat3 D = plane_stress_stiffness(1e5, 0.3);
  const double strain = 1e-3;
  const auto answer = elastic(D, Vec3(strain, -0.3 * strain, 0));
  EXPECT_NEAR(answer.pk2_resultant[0], 1e5 * strain, 1e-11);
  EXPECT_NEAR(answer.pk2_resultant[1], 0, 1e-11);
  EXPECT_NEAR(answer.energy_per_area, 1e5 * strain * strain / 2, 1e-14);
}

TEST(PlaneStress, SimpleShearMeetsTheShearModulus) {
  const auto answer = elastic(plane_stress_stiffness(1e5, 0.25), Vec3(0, 0, 2e-3));
  EXPECT_NEAR(answer.pk2_resultant[2], 1e5 / (2 * 1.25) * 2e-3, 1e-11);
}

TEST(PlaneStress, PrestressIsTheResultantAtZeroStrain) {
  const Vec3 prestress(3, 4, -1);
  const auto answer = plane_stress(plane_stress_stiffness(1e5, 0.25), prestress, Vec3::Zero(), Vec3::Zero());
  EXPECT_EQ(answer.pk2_resultant, prestress);
  EXPECT_EQ(answer.energy_per_area, 0);
}

TEST(PlaneStress, ResultantIsTheDerivativeOfTheEnergy) {
  const Mat3 D = off_axis(0.3);
  const Vec3 prestress(30, 40, -10), free_strain(1e-3, 2e-3, -1e-3), strain(1e-2, -2e-2, 3e-2);
  const double h = 1e-3;  // the energy is quadratic: central differences are exact up to rounding
  for (int i = 0; i < 3; ++i) {
    const Vec3 step = h * Vec3::Unit(i);
    const double slope = (plane_stress(D, prestress, free_strain, strain + step).energy_per_area -
                          plane_stress(D, prestress, free_strain, strain - step).energy_per_area) /
                         (2 * h);
    EXPECT_NEAR(slope, plane_stress(D, prestress, free_strain, strain).pk2_resultant[i], 1e-10 * D.norm());
  }
}

TEST(PlaneStress, FreeStrainNeedsNoStress) {
  const Vec3 free_strain(1e-3, 2e-3, -1e-3);
  const auto answer = plane_stress(off_axis(0.3), Vec3::Zero(), free_strain, free_strain);
  EXPECT_EQ(answer.pk2_resultant, Vec3::Zero());
  EXPECT_EQ(answer.energy_per_area, 0);
}

TEST(PlaneStress, OrthotropicSheetContractsByItsTwoPoissonRatios) {
  // stress along 1: contraction nu12; along 2: nu21 = nu12 E2/E1
  const Mat3 D = plane_stress_stiffness(lamina);
  const double nu21 = 0.25 * 2e4 / 5e5;
  EXPECT_LT((elastic(D, Vec3(1e-3, -0.25e-3, 0)).pk2_resultant - Vec3(500, 0, 0)).norm(), 1e-10);
  EXPECT_LT((elastic(D, Vec3(-nu21 * 1e-3, 1e-3, 0)).pk2_resultant - Vec3(0, 20, 0)).norm(), 1e-10);
  EXPECT_LT((elastic(D, Vec3(0, 0, 1e-3)).pk2_resultant - Vec3(0, 0, 12)).norm(), 1e-10);
}

TEST(PlaneStress, OffAxisLaminaFollowsClassicalLaminationTheory) {
  // engineering constants of a lamina under tension at an angle to its fibres (Jones 1975, section 2.6)
  const auto [E1, E2, nu12, G12] = lamina;
  for (const double angle : {-0.9, -0.2, 0.1, 0.5, 0.8, 1.3}) {
    const double c = std::cos(angle), s = std::sin(angle);
    const double elongation =
        std::pow(c, 4) / E1 + c * c * s * s * (1 / G12 - 2 * nu12 / E1) + std::pow(s, 4) / E2;
    const double contraction =
        nu12 / E1 * (std::pow(c, 4) + std::pow(s, 4)) - c * c * s * s * (1 / E1 + 1 / E2 - 1 / G12);
    const double shear = (2 / E1 + 2 * nu12 / E1 - 1 / G12) * s * std::pow(c, 3) -
                         (2 / E2 + 2 * nu12 / E1 - 1 / G12) * std::pow(s, 3) * c;
    const Vec3 strain = 100 * Vec3(elongation, -contraction, shear);
    // D is up to 60 times stiffer than 1/elongation: rounding of the sum
    EXPECT_LT((elastic(off_axis(angle), strain).pk2_resultant - Vec3(100, 0, 0)).norm(), 1e-10) << angle;
  }
}

TEST(PlaneStress, RotatedStrainIsThatOfTheTurnedTensor) {
  const double angle = 0.7, c = std::cos(angle), s = std::sin(angle);
  Mat<2> tensor{{3, -1}, {-1, 5}};
  Mat<2> axes{{c, -s}, {s, c}};  // columns
  const Mat<2> turned = axes.transpose() * tensor * axes;
  const Vec3 strain = strain_rotation(angle) * Vec3(3, 5, -2);
  EXPECT_LT((strain - Vec3(turned(0, 0), turned(1, 1), 2 * turned(0, 1))).norm(), 1e-14);
}

}  // namespace tautline::material
