#include <cmath>
#include <tautline/analysis/newton.hpp>

#include "analysis/dense_problem.hpp"
#include "messages.hpp"

namespace tautline::analysis {
namespace {

using namespace testing_problem;
using testing_messages::mentions;

/// Hardening springs x + x^3 in a chain, loaded so that `solution` is in equilibrium.
DenseProblem hardening_chain(const VecX& solution) {
  const MatX chain = la::testing_chain::held_chain(6, 1);
  const auto internal = [chain](const VecX& x) -> VecX { return chain * x + VecX(x.array().cube()); };
  const VecX load = internal(solution);
  return {
      [=](const VecX& x, double lambda) -> VecX { return internal(x) - lambda * load; },
      [=](const VecX& x) -> MatX { return chain + MatX((3 * x.array().square()).matrix().asDiagonal()); }};
}

VecX some_solution() {
  VecX x(6);
  x << 0.8, -0.3, 1.1, 0.5, -0.9, 0.2;
  return x;
}

TEST(Newton, FindsAKnownSolution) {
  auto problem = hardening_chain(some_solution());
  auto work = workspace();
  const auto summary = solve_newton(problem, work, {});
  EXPECT_TRUE(summary.converged());
  EXPECT_LT((problem.point - some_solution()).norm(), 1e-9);
  EXPECT_EQ(summary.newton_iterations(), static_cast<int>(summary.iterations.size()) - 1);
  EXPECT_EQ(summary.iterations.front().increment, 0);
}

TEST(Newton, ConvergesQuadratically) {
  auto problem = hardening_chain(some_solution());
  auto work = workspace();
  const auto summary = solve_newton(problem, work, {});
  // The last residuals above round-off: each the square of the one before, up to a constant.
  std::vector<double> residuals;
  for (const auto& iteration : summary.iterations)
    if (iteration.norms.force > 1e-13) residuals.push_back(std::log(iteration.norms.force));
  ASSERT_GE(residuals.size(), 4u);
  const auto at = [&](std::size_t back) { return residuals[residuals.size() - back]; };
  const double order = (at(1) - at(2)) / (at(2) - at(3));
  EXPECT_NEAR(order, 2, 0.25);
}

TEST(Newton, SolvesALinearProblemInOneIterationAndLooksAtItOnceMore) {
  const MatX k = la::testing_chain::held_chain(6, 10);
  const VecX load = VecX::LinSpaced(6, 1, 6);
  DenseProblem problem([&](const VecX& x, double) -> VecX { return k * x - load; },
                       [&](const VecX&) { return k; });
  auto work = workspace();
  const auto summary = solve_newton(problem, work, {});
  EXPECT_TRUE(summary.converged());
  EXPECT_EQ(summary.newton_iterations(), 2) << "the second shows that nothing moves any more";
  EXPECT_LT((problem.point - k.llt().solve(load)).norm(), 1e-13);
}

TEST(Newton, DoesNothingWhereItStartsInEquilibrium) {
  auto problem = hardening_chain(some_solution());
  problem.point = some_solution();
  auto work = workspace();
  const auto summary = solve_newton(problem, work, {});
  EXPECT_TRUE(summary.converged());
  EXPECT_EQ(summary.newton_iterations(), 0);
  EXPECT_EQ(problem.point, some_solution());
}

TEST(Newton, StatesBothSidesOfTheInequalityThatEndedIt) {
  auto problem = hardening_chain(some_solution());
  problem.reference = 7.25;
  auto work = workspace();
  const auto converged = solve_newton(problem, work, {});
  EXPECT_TRUE(mentions(converged.reason, "of the reference force 7.25 N <= 1e-09"));
  EXPECT_TRUE(mentions(converged.reason, "increment"));
  problem.point.setZero();
  NewtonOptions two;
  two.max_iterations = 2;
  const auto stopped = solve_newton(problem, work, two);
  EXPECT_EQ(stopped.status, NewtonStatus::too_many_iterations);
  EXPECT_EQ(stopped.newton_iterations(), 2);
  EXPECT_TRUE(mentions(stopped.reason, "after 2 iterations the out-of-balance is"));
  EXPECT_TRUE(mentions(stopped.reason, "not below 1e-09"));
}

TEST(Newton, ReportsEveryIteration) {
  auto problem = hardening_chain(some_solution());
  problem.reference = 2;
  auto work = workspace();
  std::vector<double> reported;
  const auto summary = solve_newton(problem, work, {}, [&](int iteration, double residual) {
    EXPECT_EQ(iteration, static_cast<int>(reported.size()));
    reported.push_back(residual);
  });
  ASSERT_EQ(reported.size(), summary.iterations.size());
  for (std::size_t i = 0; i < reported.size(); ++i)
    EXPECT_DOUBLE_EQ(reported[i], summary.iterations[i].norms.force / 2);
}

TEST(Newton, SaysThatTheTangentIsSingular) {
  // Nothing resists the load on the fourth unknown.
  MatX k = MatX::Identity(6, 6);
  k(3, 3) = 0;
  DenseProblem problem([&](const VecX& x, double) -> VecX { return k * x - VecX::Ones(6); },
                       [&](const VecX&) { return k; });
  auto work = workspace();
  const auto summary = solve_newton(problem, work, {});
  EXPECT_EQ(summary.status, NewtonStatus::singular);
  EXPECT_TRUE(mentions(summary.reason, "singular"));
}

TEST(Newton, SaysThatTheTangentOfAFreeChainIsSingular) {
  const MatX k = la::testing_chain::free_chain(6, 100);
  DenseProblem problem([&](const VecX& x, double) -> VecX { return k * x - VecX::Ones(6); },
                       [&](const VecX&) { return k; });
  auto work = workspace();
  auto before = hardening_chain(some_solution());
  solve_newton(before, work, {});
  const auto summary = solve_newton(problem, work, {});
  EXPECT_EQ(summary.status, NewtonStatus::singular) << "also by a solver that was in use before";
  EXPECT_TRUE(mentions(summary.reason, "singular"));
}

TEST(Newton, LeavesAloneWhatNeitherStiffnessNorLoadTouches) {
  // A cable net in a plane has no stiffness across it until it is stretched; loads in the plane are fine all
  // the same.
  MatX k = la::testing_chain::held_chain(6, 10);
  k.row(3).setZero();
  k.col(3).setZero();
  VecX load = VecX::LinSpaced(6, 1, 6);
  load[3] = 0;
  DenseProblem problem([&](const VecX& x, double) -> VecX { return k * x - load; },
                       [&](const VecX&) { return k; });
  auto work = workspace();
  const auto summary = solve_newton(problem, work, {});
  EXPECT_TRUE(summary.converged()) << summary.reason;
  EXPECT_LT((k * problem.point - load).norm(), 1e-12);
}

TEST(Newton, SaysThatTheIterationRunsAway) {
  // Newton's method takes x to -2 x on a cube root.
  auto problem = six_times([](double x, double) { return std::cbrt(x); },
                           [](double x) { return 1 / (3 * std::pow(std::cbrt(x), 2)); });
  problem.point.setConstant(1);
  auto work = workspace();
  const auto summary = solve_newton(problem, work, {});
  EXPECT_EQ(summary.status, NewtonStatus::diverged);
  EXPECT_TRUE(mentions(summary.reason, "runs away"));
  EXPECT_LE(summary.newton_iterations(), 3) << "increments 3, 6, 12 times the size";
}

TEST(Newton, SaysThatTheResidualIsNoNumber) {
  auto problem =
      six_times([](double x, double) { return x == 0 ? -1 : std::nan(""); }, [](double) { return 1; });
  auto work = workspace();
  const auto summary = solve_newton(problem, work, {});
  EXPECT_EQ(summary.status, NewtonStatus::diverged);
  EXPECT_TRUE(mentions(summary.reason, "no longer a number"));
}

TEST(Newton, ShortensAStepThatOvershootsByOrdersOfMagnitude) {
  // From rest the first step of x + 1e6 x^3 = 1001 (solution near 0.1) would go to x = 1001 and a force of
  // 1e15.
  auto problem = six_times([](double x, double) { return x + 1e6 * x * x * x - 1000.1; },
                           [](double x) { return 1 + 3e6 * x * x; });
  problem.size = 1e4;
  problem.reference = 1e3;
  NewtonOptions options;
  options.increment_tolerance = 1e-12;
  auto work = workspace();
  const auto summary = solve_newton(problem, work, options);
  ASSERT_TRUE(summary.converged()) << summary.reason;
  EXPECT_LT(summary.iterations[1].step, 0.1);
  EXPECT_EQ(summary.iterations.back().step, 1) << "near the solution steps are whole";
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(problem.point[i], 0.1, 1e-12);
}

TEST(Newton, BacksOutOfWhereTheResidualIsNoNumber) {
  // log(x) from x = 4: the whole step leads to x = -1.5.
  auto problem = six_times([](double x, double) { return x > 0 ? std::log(x) : std::nan(""); },
                           [](double x) { return 1 / x; });
  problem.point.setConstant(4);
  auto work = workspace();
  const auto summary = solve_newton(problem, work, {});
  ASSERT_TRUE(summary.converged()) << summary.reason;
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(problem.point[i], 1, 1e-9);
}

TEST(Newton, LetsErrorsOfTheProblemThrough) {
  DenseProblem problem([](const VecX&, double) -> VecX { throw std::domain_error("inside out"); },
                       [](const VecX&) -> MatX { return MatX::Identity(6, 6); });
  auto work = workspace();
  EXPECT_THROW(solve_newton(problem, work, {}), std::domain_error);
}

}  // namespace
}  // namespace tautline::analysis
