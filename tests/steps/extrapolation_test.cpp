#include "steps/extrapolation.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace tautline::steps {
namespace {

std::vector<double> sampled(const std::vector<double>& size, double limit, double factor, double order) {
  std::vector<double> values;
  for (const double h : size) values.push_back(limit + factor * std::pow(h, order));
  return values;
}

TEST(Extrapolation, RecoversOrderAndLimitOfAPowerLaw) {
  const std::vector<double> size{1.0 / 2, 1.0 / 4, 1.0 / 6, 1.0 / 8};
  for (const double order : {1.0, 2.0, 3.5}) {
    const auto found = extrapolate_three(size, sampled(size, 0.845, 0.3, order));
    ASSERT_TRUE(found);
    EXPECT_NEAR(found.order, order, 1e-9);
    EXPECT_NEAR(found.limit, 0.845, 1e-12);
  }
}

TEST(Extrapolation, RecoversALimitApproachedFromBelow) {
  const std::vector<double> size{0.4, 0.2, 0.1};
  const auto found = extrapolate_three(size, sampled(size, 3.0, -2.0, 2.0));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found.limit, 3.0, 1e-12);
}

TEST(Extrapolation, RefusesWhatDoesNotApproachALimitAndSaysWhy) {
  const std::vector<double> size{0.4, 0.2, 0.1};
  const auto why = [&](const std::vector<double>& value) { return extrapolate_three(size, value).why_not; };
  EXPECT_NE(why({1.0, 0.8, 0.9}).find("up and down"), std::string::npos);
  EXPECT_NE(why({1.0, 0.9, 0.8}).find("too slowly"), std::string::npos) << "as the logarithm of h";
  EXPECT_NE(why({1.0, 0.9, 0.7}).find("too slowly"), std::string::npos) << "diverges";
  EXPECT_NE(why({2.0, 1.0, 0.999}).find("above"), std::string::npos) << "order 10";
  EXPECT_NE(why({2.0, 1.0, 1.0}).find("rounding"), std::string::npos);
  EXPECT_NE(why({2.0, 1.5, std::nan("")}).find("missing"), std::string::npos);
  EXPECT_FALSE(extrapolate_three({0.1, 0.2, 0.4}, sampled({0.1, 0.2, 0.4}, 1, 1, 2)))
      << "coarser and coarser";
}

TEST(Extrapolation, RefusesASeriesThatOnlyItsLastThreePointsMakeSteady) {
  const std::vector<double> size{0.8, 0.4, 0.2, 0.1};
  EXPECT_FALSE(extrapolate_three(size, {1.0, 1.4, 1.1, 1.0}));
  auto value = sampled(size, 1, 1, 2);
  ASSERT_TRUE(extrapolate_three(size, value));
  value[0] = value[1] + 1.5 * (value[1] - value[2]);  // order 0.6, then 2
  const auto found = extrapolate_three(size, value);
  EXPECT_NE(found.why_not.find("from 0.58 to 2.00"), std::string::npos) << found.why_not;
}

TEST(Extrapolation, NeedsThreePoints) {
  EXPECT_FALSE(extrapolate_three({0.4, 0.2}, {1.0, 0.8}));
}

}  // namespace
}  // namespace tautline::steps
