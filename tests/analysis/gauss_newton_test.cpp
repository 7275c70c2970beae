#include <tautline/analysis/gauss_newton.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace tautline::analysis {
namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();

/// Residuals given as a function of the parameters; the state is the parameters themselves.
class FunctionProblem : public InverseProblem {
 public:
  std::function<VecX(const VecX&)> function;
  std::function<MatX(const VecX&)> derivative;
  std::function<bool(const VecX&)> reachable = [](const VecX&) { return true; };
  VecX point, kept;

  bool move_to(const VecX& parameters) override {
    if (!reachable(parameters)) return false;
    point = parameters;
    return true;
  }
  void keep() override { kept = point; }
  void restore() override { point = kept; }
  VecX residual() override { return function(point); }
  MatX jacobian() override { return derivative(point); }
};

Box free_box(int n) {
  return {VecX::Constant(n, -no_limit), VecX::Constant(n, no_limit)};
}

GaussNewtonSummary solve(FunctionProblem& problem, const VecX& start, const Box& box) {
  problem.point = start;
  GaussNewtonOptions options;
  options.tolerance = 1e-10;
  return solve_inverse(problem, start, box, options);
}

FunctionProblem rosenbrock() {
  FunctionProblem problem;
  problem.function = [](const VecX& p) { return Vec<2>(10 * (p[1] - p[0] * p[0]), 1 - p[0]); };
  problem.derivative = [](const VecX& p) {
    MatX j(2, 2);
    j << -20 * p[0], 10, -1, 0;
    return j;
  };
  return problem;
}

TEST(BoundedLeastSquares, StopsAtTheBounds) {
  const MatX j = MatX::Identity(2, 2);
  const Box box{VecX::Zero(2), VecX::Ones(2)};
  const VecX at = VecX::Constant(2, 0.5);
  const VecX found = bounded_least_squares(j, at - Vec<2>(3, -2), at, at, box, 1e-10);
  EXPECT_NEAR(found[0], 1, 1e-14);
  EXPECT_NEAR(found[1], 0, 1e-14);
}

// (x + y - 2)^2 + (x - y - 4)^2 is least at (3, -1); on y = 0 at x = 3.
TEST(BoundedLeastSquares, SlidesAlongABound) {
  MatX j(2, 2);
  j << 1, 1, 1, -1;
  const Box box{Vec<2>(-no_limit, 0), VecX::Constant(2, no_limit)};
  const VecX at = Vec<2>(-5, 7);
  const VecX found = bounded_least_squares(j, j * at - Vec<2>(2, 4), at, at, box, 1e-10);
  EXPECT_NEAR(found[0], 3, 1e-13);
  EXPECT_NEAR(found[1], 0, 1e-13);
}

// The way to the minimum (1, 2) leads along the bound x = 0 that was met first.
TEST(BoundedLeastSquares, LeavesABoundAgain) {
  MatX j(2, 2);
  j << 1, 0, 3, 1;
  const Box box{VecX::Zero(2), VecX::Constant(2, 10)};
  const VecX at = VecX::Zero(2);
  const VecX found = bounded_least_squares(j, j * at - Vec<2>(1, 5), at, at, box, 1e-10);
  EXPECT_NEAR(found[0], 1, 1e-13);
  EXPECT_NEAR(found[1], 2, 1e-13);
}

TEST(BoundedLeastSquares, TakesTheNearestOfManySolutions) {
  const MatX j = MatX::Ones(1, 3);
  const VecX at = Vec<3>(5, -2, 0), preferred = Vec<3>(1, 2, 3);
  const VecX found =
      bounded_least_squares(j, j * at - VecX::Constant(1, 3), at, preferred, free_box(3), 1e-10);
  EXPECT_LT((found - Vec<3>(0, 1, 2)).norm(), 1e-13);
}

TEST(SolveInverse, FindsTheRootOfRosenbrocksResiduals) {
  auto problem = rosenbrock();
  const auto found = solve(problem, Vec<2>(-1.2, 1), free_box(2));
  EXPECT_EQ(found.status, GaussNewtonStatus::met) << found.reason;
  EXPECT_LT((found.parameters - Vec<2>(1, 1)).norm(), 1e-9);
  EXPECT_EQ(found.rank, 2);
}

// With x <= 0.5 the sum of squares is least at (0.5, 0.25), where the first residual vanishes.
TEST(SolveInverse, KeepsToTheBox) {
  auto problem = rosenbrock();
  const auto found = solve(problem, Vec<2>(-1.2, 1), {VecX::Constant(2, -no_limit), Vec<2>(0.5, no_limit)});
  EXPECT_EQ(found.status, GaussNewtonStatus::least_squares) << found.reason;
  EXPECT_EQ(found.parameters[0], 0.5);
  EXPECT_NEAR(found.parameters[1], 0.25, 1e-9);
}

// The point of y = x^2 nearest to (1, 1/2) has 4 x^3 = 2.
TEST(SolveInverse, ChangesAsLittleAsItCan) {
  FunctionProblem problem;
  problem.function = [](const VecX& p) { return VecX::Constant(1, p[1] - p[0] * p[0]); };
  problem.derivative = [](const VecX& p) { return MatX(Eigen::RowVector2d(-2 * p[0], 1)); };
  const auto found = solve(problem, Vec<2>(1, 0.5), free_box(2));
  EXPECT_EQ(found.status, GaussNewtonStatus::met) << found.reason;
  const double x = std::cbrt(0.5);
  EXPECT_LT((found.parameters - Vec<2>(x, x * x)).norm(), 1e-6);
  EXPECT_EQ(found.rank, 1);
}

TEST(SolveInverse, MinimisesWhatCannotBeMet) {
  FunctionProblem problem;
  problem.function = [](const VecX& p) { return Vec<2>(p[0] * p[0] - 1, p[0] * p[0] - 3); };
  problem.derivative = [](const VecX& p) { return MatX(Vec<2>(2 * p[0], 2 * p[0])); };
  const auto found = solve(problem, VecX::Constant(1, 3), free_box(1));
  EXPECT_EQ(found.status, GaussNewtonStatus::least_squares) << found.reason;
  EXPECT_NEAR(found.parameters[0], std::sqrt(2), 1e-7);
  EXPECT_NEAR(found.residual.norm(), std::sqrt(2), 1e-12);
}

// Newton's step for log(x / 2) from 8 leads below zero, where nothing is.
TEST(SolveInverse, TakesAPartOfAStepThatLeadsNowhere) {
  FunctionProblem problem;
  problem.function = [](const VecX& p) { return VecX::Constant(1, std::log(p[0] / 2)); };
  problem.derivative = [](const VecX& p) { return MatX::Constant(1, 1, 1 / p[0]); };
  problem.reachable = [](const VecX& p) { return p[0] > 0; };
  const auto found = solve(problem, VecX::Constant(1, 8), free_box(1));
  EXPECT_EQ(found.status, GaussNewtonStatus::met) << found.reason;
  EXPECT_LT(found.iterations.front().step, 1);
  EXPECT_NEAR(found.parameters[0], 2, 1e-9);
}

TEST(SolveInverse, SaysWhereItIsStuckAndStaysThere) {
  auto problem = rosenbrock();
  problem.reachable = [](const VecX&) { return false; };
  const auto found = solve(problem, Vec<2>(-1.2, 1), free_box(2));
  EXPECT_EQ(found.status, GaussNewtonStatus::stuck);
  EXPECT_NE(found.reason.find("no part of the step"), std::string::npos) << found.reason;
  EXPECT_EQ(problem.point, Vec<2>(-1.2, 1));
}

// A derivative that is wrong makes the changes shrink by 0.7 from one iteration to the next: with all targets
// met they count as rounding, with targets missed they go on.
TEST(SolveInverse, EndsWhereAllIsMetAndChangesShrinkNoMore) {
  FunctionProblem problem;
  problem.function = [](const VecX& p) { return VecX::Constant(1, p[0] - 1); };
  problem.derivative = [](const VecX&) { return MatX::Constant(1, 1, 1 / 0.3); };
  GaussNewtonOptions options;
  options.tolerance = 2;
  options.step_tolerance = 1e-12;
  problem.point = VecX::Zero(1);
  const auto met = solve_inverse(problem, VecX::Zero(1), free_box(1), options);
  EXPECT_EQ(met.status, GaussNewtonStatus::met);
  EXPECT_EQ(met.iterations.size(), 2u);
  options.tolerance = 0.3;
  problem.point = VecX::Zero(1);
  const auto later = solve_inverse(problem, VecX::Zero(1), free_box(1), options);
  EXPECT_EQ(later.status, GaussNewtonStatus::met);
  // 0.7^4 = 0.24 is the first below 0.3; the one after it tells that the changes shrink no more
  EXPECT_EQ(later.iterations.size(), 6u);
  EXPECT_NEAR(later.parameters[0], 1 - std::pow(0.7, 5), 1e-12);
}

TEST(SolveInverse, KnowsWhatNothingMoves) {
  FunctionProblem problem;
  problem.function = [](const VecX& p) { return Vec<2>(p[0] - 4, 1); };
  problem.derivative = [](const VecX&) { return MatX(Vec<2>(1, 0)); };
  const auto found = solve(problem, VecX::Zero(1), free_box(1));
  EXPECT_EQ(found.status, GaussNewtonStatus::least_squares);
  EXPECT_NEAR(found.parameters[0], 4, 1e-12);
  EXPECT_EQ(found.influence[1], 0);
}

}  // namespace
}  // namespace tautline::analysis
