#include <gtest/gtest.h>

#include <cmath>
#include <tautline/analysis/relaxation.hpp>

#include "analysis/dense_problem.hpp"

namespace tautline::analysis {
namespace {

using namespace testing_problem;

TEST(Relaxation, SettlesInTheMinimumOfAQuadratic) {
  const MatX k = la::testing_chain::held_chain(6, 100);
  const VecX load = VecX::LinSpaced(6, 1, 2);
  DenseProblem problem([=](const VecX& x, double) -> VecX { return k * x - load; },
                       [=](const VecX&) -> MatX { return k; });
  problem.reference = load.norm();
  auto work = workspace();
  const auto summary = relax(problem, work, {});
  EXPECT_TRUE(summary.settled);
  EXPECT_GT(summary.peaks, 1);
  EXPECT_LT((problem.point - k.ldlt().solve(load)).norm(), 1e-2 * problem.point.norm()) << "1e-4 of the load";
  EXPECT_TRUE(solve_newton(problem, work, {}).converged());
  EXPECT_LT((problem.point - k.ldlt().solve(load)).norm(), 1e-9 * problem.point.norm());
}

TEST(Relaxation, FindsTheWellThatNewtonsMethodJumpsOver) {
  // sqrt(1 + x^2) has its minimum at 0; from |x| > 1 Newton's method runs away: x -> -x^3.
  auto problem = six_times([](double x, double) { return x / std::sqrt(1 + x * x); },
                           [](double x) { return std::pow(1 + x * x, -1.5); });
  problem.point.setConstant(3);
  auto work = workspace();
  EXPECT_FALSE(solve_newton(problem, work, {}).converged());
  problem.point.setConstant(3);
  const auto summary = relax(problem, work, {});
  EXPECT_TRUE(summary.settled);
  EXPECT_TRUE(solve_newton(problem, work, {}).converged());
  EXPECT_NEAR(problem.point[0], 0, 1e-9);
}

TEST(Relaxation, SaysWhenItsStepsWereTooFew) {
  auto problem = six_times([](double x, double) { return x - 1; }, [](double) { return 1.0; });
  auto work = workspace();
  RelaxationOptions options;
  options.max_steps = 1;
  const auto summary = relax(problem, work, options);
  EXPECT_FALSE(summary.settled);
  EXPECT_EQ(summary.steps, 1);
  EXPECT_GT(summary.residual, options.tolerance);
}

}  // namespace
}  // namespace tautline::analysis
