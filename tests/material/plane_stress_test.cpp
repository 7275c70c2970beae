#include <gtest/gtest.h>

#include <tautline/material/plane_stress.hpp>

namespace tautline::material {

TEST(PlaneStress, UniaxialStressGivesPoissonContraction) {
  const auto D = plane_stress_stiffness(1e5, 0.3);
  const double strain = 1e-3;
  const auto answer = plane_stress(D, Vec3::Zero(), Vec3(strain, -0.3 * strain, 0));
  EXPECT_NEAR(answer.pk2_resultant[0], 1e5 * strain, 1e-11);
  EXPECT_NEAR(answer.pk2_resultant[1], 0, 1e-11);
  EXPECT_NEAR(answer.energy_per_area, 1e5 * strain * strain / 2, 1e-14);
}

TEST(PlaneStress, SimpleShearMeetsTheShearModulus) {
  const auto D = plane_stress_stiffness(1e5, 0.25);
  const auto answer = plane_stress(D, Vec3::Zero(), Vec3(0, 0, 2e-3));
  EXPECT_NEAR(answer.pk2_resultant[2], 1e5 / (2 * 1.25) * 2e-3, 1e-11);
}

TEST(PlaneStress, PrestressIsTheResultantAtZeroStrain) {
  const auto D = plane_stress_stiffness(1e5, 0.25);
  const Vec3 prestress(3, 4, -1);
  const auto answer = plane_stress(D, prestress, Vec3::Zero());
  EXPECT_EQ(answer.pk2_resultant, prestress);
  EXPECT_EQ(answer.energy_per_area, 0);
}

TEST(PlaneStress, ResultantIsTheDerivativeOfTheEnergy) {
  const auto D = plane_stress_stiffness(7e4, 0.4);
  const Vec3 prestress(30, 40, -10), strain(1e-2, -2e-2, 3e-2);
  const double h = 1e-3;  // the energy is quadratic: central differences are exact up to rounding
  for (int i = 0; i < 3; ++i) {
    const Vec3 step = h * Vec3::Unit(i);
    const double slope = (plane_stress(D, prestress, strain + step).energy_per_area -
                          plane_stress(D, prestress, strain - step).energy_per_area) /
                         (2 * h);
    EXPECT_NEAR(slope, plane_stress(D, prestress, strain).pk2_resultant[i], 1e-10 * 7e4);
  }
}

}  // namespace tautline::material
