// How long Newton's steps are, and where the iteration rests.
#include <gtest/gtest.h>

#include <cmath>
#include <tautline/analysis/newton.hpp>

#include "analysis/dense_problem.hpp"

namespace tautline::analysis {
namespace {

using namespace testing_problem;

/// What counts as an overshoot does not depend on the unit of force.
TEST(Newton, ShortensTheSameStepsInWhateverUnitOfForce) {
  const auto steps = [](double unit) {
    auto problem = six_times([=](double x, double) { return unit * (x + 1e6 * x * x * x - 1000.1); },
                             [=](double x) { return unit * (1 + 3e6 * x * x); });
    problem.size = 1e4;
    problem.reference = 1e3 * unit;
    NewtonOptions options;
    options.increment_tolerance = 1e-12;
    auto work = workspace();
    const auto summary = solve_newton(problem, work, options);
    EXPECT_TRUE(summary.converged()) << unit << ": " << summary.reason;
    std::vector<double> result;
    for (const auto& iteration : summary.iterations) result.push_back(iteration.step);
    return result;
  };
  const auto expected = steps(1);
  for (const double unit : {1e-12, 1e12}) {
    const auto found = steps(unit);
    ASSERT_EQ(found.size(), expected.size()) << unit;
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-9) << unit;
  }
}

/// A step whose end is no number is shortened to a tenth, as often as it takes.
TEST(Newton, BacksOutByOrdersOfMagnitudeWhereTheResidualIsNoNumber) {
  // From x = 0.3 with a tangent a hundred times too soft the step is 70 long; beyond 1.5 there is nothing.
  auto problem = six_times([](double x, double) { return x < 1.5 ? x - 1 : std::nan(""); },
                           [](double x) { return x < 0.5 ? 0.01 : 1.0; });
  problem.point.setConstant(0.3);
  problem.size = 100;
  auto work = workspace();
  const auto summary = solve_newton(problem, work, {});
  ASSERT_TRUE(summary.converged()) << summary.reason;
  EXPECT_NEAR(summary.iterations[1].step, 0.01, 1e-15);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(problem.point[i], 1, 1e-9);
}

/// Without resistance at the start (a flat film under pressure) the step along the free direction is as long
/// as it is; the search finds where the energy stops falling.
TEST(Newton, FindsTheValleyAlongADirectionThatNothingResistsAtTheStart) {
  for (const double load : {1e-3, 1.0, 1e3}) {
    DenseProblem film(
        [=](const VecX& x, double) -> VecX {
          VecX f = 100 * x;
          f[0] = x[0] * x[0] * x[0] - load;
          return f;
        },
        [](const VecX& x) -> MatX {
          MatX k = 100 * MatX::Identity(6, 6);
          k(0, 0) = 3 * x[0] * x[0];
          return k;
        });
    film.size = 1e6;
    film.reference = load;
    auto work = workspace();
    const auto summary = solve_newton(film, work, {});
    ASSERT_TRUE(summary.converged()) << load << ": " << summary.reason;
    EXPECT_NEAR(film.point[0], std::cbrt(load), 1e-6 * std::cbrt(load));
    EXPECT_LE(summary.newton_iterations(), 15) << load;
  }
}

/// The search closes in between the last place before the valley and the first behind it.
TEST(Newton, SearchesBetweenTheEndsOfItsBracket) {
  // From rest the step is 1 long; forces stay at -1 up to 0.15 and grow as (x / 0.19)^12 from there.
  auto problem = six_times([](double x, double) { return std::pow(x / 0.19, 12) - 1; },
                           [](double x) { return x < 0.1 ? 1.0 : 12 * std::pow(x / 0.19, 11) / 0.19; });
  auto work = workspace();
  const auto summary = solve_newton(problem, work, {});
  ASSERT_TRUE(summary.converged()) << summary.reason;
  // At a tenth the force has hardly fallen; a tenth of what is left leads to 0.1 + 0.9 / 10.
  EXPECT_NEAR(summary.iterations[1].step, 0.19, 1e-12);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(problem.point[i], 0.19, 1e-9);
}

/// Without an iteration it rests only where forces balance with a margin of a thousand.
TEST(Newton, RestsAtOnceOnlyWhereForcesAreFarBelowTheTolerance) {
  NewtonOptions options;
  options.force_tolerance = 1e-6;
  for (const double part : {0.5, 0.9, 1.5, 10.0}) {
    auto problem = six_times([=](double x, double) { return x + part * 1e-9 / std::sqrt(6.0); },
                             [](double) { return 1.0; });
    auto work = workspace();
    const auto summary = solve_newton(problem, work, options);
    ASSERT_TRUE(summary.converged()) << summary.reason;
    EXPECT_EQ(summary.newton_iterations() > 0, part > 1) << part;
  }
}

}  // namespace
}  // namespace tautline::analysis
