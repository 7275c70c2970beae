#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <tautline/core/expression.hpp>

namespace tautline {
namespace {

struct Formula {
  const char* text;
  double (*value)(double);
  double (*first)(double);
  double (*second)(double);
};

class EachFormula : public testing::TestWithParam<Formula> {};

TEST_P(EachFormula, HasTheValueAndDerivativesOfTheClosedForm) {
  const auto& [text, value, first, second] = GetParam();
  const Expression f(text);
  for (const double x : {0.2, 0.55, 0.9}) {
    EXPECT_NEAR(f(x).value, value(x), 1e-14 * (1 + std::abs(value(x)))) << text << " at " << x;
    EXPECT_NEAR(f(x).first, first(x), 1e-13 * (1 + std::abs(first(x)))) << text << " at " << x;
    EXPECT_NEAR(f(x).second, second(x), 1e-13 * (1 + std::abs(second(x)))) << text << " at " << x;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Expression, EachFormula,
    testing::Values(
        Formula{"2*X^3 - X/4 + 1e-1", [](double x) { return 2 * x * x * x - x / 4 + 0.1; },
                [](double x) { return 6 * x * x - 0.25; }, [](double x) { return 12 * x; }},
        Formula{"-x^2", [](double x) { return -x * x; }, [](double x) { return -2 * x; },
                [](double) { return -2.0; }},
        Formula{"2^x^2", [](double x) { return std::pow(2, x * x); },
                [](double x) { return std::pow(2, x * x) * 2 * x * std::log(2.0); },
                [](double x) {
                  const double l = std::log(2.0);
                  return std::pow(2, x * x) * (4 * x * x * l * l + 2 * l);
                }},
        Formula{"sqrt(1 + X^2)", [](double x) { return std::hypot(1, x); },
                [](double x) { return x / std::hypot(1, x); },
                [](double x) { return std::pow(1 + x * x, -1.5); }},
        Formula{"4*(cosh(X/4) - 1)", [](double x) { return 4 * (std::cosh(x / 4) - 1); },
                [](double x) { return std::sinh(x / 4); }, [](double x) { return std::cosh(x / 4) / 4; }},
        Formula{"sin(pi*X)*exp(-X)", [](double x) { return std::sin(std::numbers::pi * x) * std::exp(-x); },
                [](double x) {
                  const double p = std::numbers::pi;
                  return std::exp(-x) * (p * std::cos(p * x) - std::sin(p * x));
                },
                [](double x) {
                  const double p = std::numbers::pi;
                  return std::exp(-x) * ((1 - p * p) * std::sin(p * x) - 2 * p * std::cos(p * x));
                }},
        Formula{"tan(X)", [](double x) { return std::tan(x); },
                [](double x) { return 1 / std::pow(std::cos(x), 2); },
                [](double x) { return 2 * std::sin(x) / std::pow(std::cos(x), 3); }},
        Formula{"log(X) + atan(X)", [](double x) { return std::log(x) + std::atan(x); },
                [](double x) { return 1 / x + 1 / (1 + x * x); },
                [](double x) { return -1 / (x * x) - 2 * x / std::pow(1 + x * x, 2); }},
        Formula{"asin(X) + 2*acos(X)", [](double x) { return std::asin(x) + 2 * std::acos(x); },
                [](double x) { return -1 / std::sqrt(1 - x * x); },
                [](double x) { return -x / std::pow(1 - x * x, 1.5); }},
        Formula{"tanh(X) + abs(-X) + cos(X)", [](double x) { return std::tanh(x) + x + std::cos(x); },
                [](double x) { return 1 / std::pow(std::cosh(x), 2) + 1 - std::sin(x); },
                [](double x) { return -2 * std::tanh(x) / std::pow(std::cosh(x), 2) - std::cos(x); }}));

TEST(Expression, TellsWhereAFormulaIsWrong) {
  const auto fault = [](const std::string& text) -> std::string {
    try {
      Expression f(text);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(fault("2*"), "a number, X or a function is missing (character 3)");
  EXPECT_EQ(fault("2 X"), "\"X\" does not fit here (character 3)");
  EXPECT_EQ(fault("cosn(X)"), "\"cosn\" is neither X, pi nor a function (character 1)");
  EXPECT_EQ(fault("(X + 1"), "a closing parenthesis is missing (character 7)");
  EXPECT_EQ(fault("sin X"), "sin needs its argument in parentheses (character 5)");
  EXPECT_EQ(fault(""), "a number, X or a function is missing (character 1)");
  EXPECT_EQ(fault("2*1e999"), "a number too large or too small for a computer (character 3)");
  EXPECT_EQ(fault("X + ."), "\".\" does not fit here (character 5)");
}

TEST(Expression, ReadsNestingUpToALimit) {
  const auto nested = [](int depth) {
    const auto n = static_cast<std::size_t>(depth);
    return Expression(std::string(n, '(') + "X" + std::string(n, ')'))(3).value;
  };
  EXPECT_EQ(nested(99), 3);
  EXPECT_THROW(nested(101), std::invalid_argument);
  EXPECT_EQ(Expression(std::string(98, '-') + "X")(3).value, 3);
  for (const char* part : {"-", "sin(", "2^"}) {
    std::string text;
    for (int i = 0; i < 3000; ++i) text += part;
    EXPECT_THROW(Expression(text + "X"), std::invalid_argument) << part;
  }
}

TEST(Expression, AddsManyTerms) {
  std::string text = "X";
  for (int i = 0; i < 4000; ++i) text += "+1";
  EXPECT_EQ(Expression(text)(3).value, 4003);
  EXPECT_THROW(Expression(std::string(20'000, ' ') + "X"), std::invalid_argument);
}

TEST(SpaceFormula, EvaluatesAtAPlace) {
  EXPECT_DOUBLE_EQ(SpaceFormula("20 + 10*x - y^2*z")(Vec3(1, 2, 3)), 18);
  EXPECT_DOUBLE_EQ(SpaceFormula("80*z/sqrt(x^2 + y^2)")(Vec3(3, 4, 2)), 32);
  EXPECT_DOUBLE_EQ(SpaceFormula("5")(Vec3(1, 2, 3)), 5);
}

TEST(SpaceFormula, HasAGradient) {
  const Vec3 slope = SpaceFormula("20 + 10*x - y^2*z").gradient(Vec3(1, 2, 3));
  EXPECT_TRUE(slope.isApprox(Vec3(10, -12, -4), 1e-14)) << slope.transpose();
}

TEST(SpaceFormula, KnowsItsVariables) {
  try {
    SpaceFormula("2*X");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "\"X\" is neither x, y, z, pi nor a function (character 3)");
  }
}

}  // namespace
}  // namespace tautline
