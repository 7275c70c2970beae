#include <tautline/rod/elastica.hpp>

#include <cmath>

#include <gtest/gtest.h>

#include <tautline/core/error.hpp>

namespace tautline::rod {
namespace {

struct Row {
  double nu, end_y, angle[4], end_x;  // angles at s = 1/4, 1/2, 3/4, 1
};

// Ten digits of an independent computation with 30 digits.
constexpr Row exact[] = {
    {2.5, 0.2037692006, {0.1240675896, 0.2290689392, 0.2990609752, 0.3235974487}, 0.9739635268},
    {3.0, 0.6636293494, {0.4824958117, 0.8805846557, 1.1368274323, 1.2245236055}, 0.6531780574},
    {3.5, 0.7704205570, {0.6503304740, 1.1738843409, 1.5001881042, 1.6095147105}, 0.4334128007}};

// Russkikh & Shklyarchuk (2021), table 1, rows I.
constexpr Row printed[] = {{2.5, 0.2037, {0.1241, 0.2290, 0.2990, 0.3236}, 0},
                           {3.0, 0.6636, {0.4825, 0.8806, 1.1368, 1.2245}, 0},
                           {3.5, 0.7704, {0.6503, 1.1739, 1.5002, 1.6095}, 0}};

TEST(Elastica, HasTheAnglesAndEndOfAComputationWithThirtyDigits) {
  for (const Row& row : exact) {
    const Elastica elastica(row.nu);
    EXPECT_NEAR(elastica.end_y(), row.end_y, 1e-10);
    EXPECT_NEAR(elastica.end_x(), row.end_x, 1e-10);
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(elastica.angle((i + 1) / 4.0), row.angle[i], 1e-10);
  }
}

// Four printed decimals; at nu = 2.5 three of the five are one unit low.
TEST(Elastica, IsThatOfTable1) {
  for (const Row& row : printed) {
    const double tolerance = row.nu == 2.5 ? 7.1e-5 : 5.1e-5;
    const Elastica elastica(row.nu);
    EXPECT_NEAR(elastica.end_y(), row.end_y, tolerance);
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(elastica.angle((i + 1) / 4.0), row.angle[i], tolerance);
  }
}

// K(k) = sqrt(nu)/3 on the second branch: its first third is the whole elastica of nu/9.
TEST(Elastica, OfTheSecondModeRepeatsTheFirst) {
  const Elastica first(3.0), second(27.0, 2);
  EXPECT_NEAR(second.angle(1.0 / 3), first.angle(1), 1e-13);
  EXPECT_NEAR(second.angle(1), -first.angle(1), 1e-13);
  EXPECT_NEAR(second.end_y(), first.end_y() / 3, 1e-14);
  EXPECT_NEAR(second.end_x(), first.end_x(), 1e-14);
}

TEST(Elastica, DoesNotExistBelowBuckling) {
  EXPECT_THROW(Elastica(2.46), ModelError);
  EXPECT_THROW(Elastica(22.2, 2), ModelError);
  EXPECT_NO_THROW(Elastica(22.3, 2));
}

}  // namespace
}  // namespace tautline::rod
