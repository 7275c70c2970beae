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
    EXPECT_NEAR(found->order, order, 1e-9);
    EXPECT_NEAR(found->limit, 0.845, 1e-12);
  }
}

TEST(Extrapolation, RecoversALimitApproachedFromBelow) {
  const std::vector<double> size{0.4, 0.2, 0.1};
  const auto found = extrapolate_three(size, sampled(size, 3.0, -2.0, 2.0));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->limit, 3.0, 1e-12);
}

TEST(Extrapolation, RefusesValuesThatTurnBack) {
  EXPECT_FALSE(extrapolate_three({0.4, 0.2, 0.1}, {1.0, 0.8, 0.9}));
}

TEST(Extrapolation, NeedsThreePoints) {
  EXPECT_FALSE(extrapolate_three({0.4, 0.2}, {1.0, 0.8}));
}

}  // namespace
}  // namespace tautline::steps
