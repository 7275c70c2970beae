#include <gtest/gtest.h>

#include <cmath>
#include <tautline/material/tension_only.hpp>

using tautline::material::axial_law;
using tautline::material::tension_only;

TEST(TensionOnly, IsLinearInTension) {
  const auto answer = tension_only(2e4, 1e-3);
  EXPECT_DOUBLE_EQ(answer.tension, 20.0);
  EXPECT_DOUBLE_EQ(answer.slope, 2e4);
  EXPECT_DOUBLE_EQ(answer.energy_per_length, 0.01);
  EXPECT_FALSE(answer.slack);
}

TEST(TensionOnly, CarriesNothingWhenShortened) {
  for (const double strain : {-1e-15, -0.5}) {
    const auto answer = tension_only(2e4, strain);
    EXPECT_EQ(answer.tension, 0.0);
    EXPECT_EQ(answer.slope, 0.0);
    EXPECT_EQ(answer.energy_per_length, 0.0);
    EXPECT_TRUE(answer.slack);
  }
}

TEST(TensionOnly, IsReadyToPullAtItsUnstressedLength) {
  const auto answer = tension_only(2e4, 0.0);
  EXPECT_EQ(answer.tension, 0.0);
  EXPECT_EQ(answer.slope, 2e4);
  EXPECT_FALSE(answer.slack);
}

TEST(TensionOnly, TensionIsContinuousAtZeroStrain) {
  EXPECT_LT(tension_only(2e4, 1e-18).tension, 1e-13);
  EXPECT_FALSE(tension_only(2e4, 1e-18).slack);
}

TEST(TensionOnly, DoesNotTakeAStrainThatIsNoNumberForSlack) {
  EXPECT_TRUE(std::isnan(tension_only(2e4, std::nan("")).tension));
}

TEST(AxialLaw, OfABarIsTheSameLineOnBothSides) {
  for (const double strain : {2e-3, 1e-15, 0., -1e-15, -2e-3}) {
    const auto answer = axial_law(2e4, strain, true);
    EXPECT_DOUBLE_EQ(answer.tension, 2e4 * strain);
    EXPECT_EQ(answer.slope, 2e4);
    EXPECT_DOUBLE_EQ(answer.energy_per_length, 1e4 * strain * strain);
    EXPECT_FALSE(answer.slack);
  }
}

TEST(AxialLaw, OfACableCarriesTensionOnly) {
  EXPECT_DOUBLE_EQ(axial_law(2e4, 1e-3, false).tension, 20);
  EXPECT_EQ(axial_law(2e4, -1e-3, false).tension, 0);
  EXPECT_TRUE(axial_law(2e4, -1e-3, false).slack);
}
