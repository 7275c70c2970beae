#include <cmath>
#include <tautline/analysis/path.hpp>

#include "analysis/dense_problem.hpp"
#include "messages.hpp"

namespace tautline::analysis {
namespace {

using namespace testing_problem;
using testing_messages::mentions;

NewtonOptions few_iterations() {
  NewtonOptions options;
  options.max_iterations = 12;
  return options;
}

/// x + x^3 = 2 lambda, whose solution at the end is 1.
DenseProblem hardening() {
  return six_times([](double x, double lambda) { return x + x * x * x - 2 * lambda; },
                   [](double x) { return 1 + 3 * x * x; });
}

/// x = lambda, of which the problem can only reach `reach(kept)` beyond the point kept last; farther there is
/// no residual.
class ShortSighted : public DenseProblem {
 public:
  explicit ShortSighted(std::function<double(double)> reach)
      : DenseProblem([](const VecX& x, double aim) -> VecX { return x.array() - aim; },
                     [](const VecX& x) -> MatX { return MatX::Identity(x.size(), x.size()); }),
        reach_(std::move(reach)) {}

  void residual(const la::Vector& x, la::Vector& f) override {
    DenseProblem::residual(x, f);
    const double farthest = (point_of(x) - committed).lpNorm<Eigen::Infinity>();
    if (farthest > reach_(committed[0])) {
      const VecX none = VecX::Constant(f.local_size(), std::nan(""));
      f.write(std::span(none.data(), static_cast<std::size_t>(none.size())));
    }
  }
  void restart() override {
    DenseProblem::restart();
    start_ = point;
  }

 private:
  VecX point_of(const la::Vector& x) const { return start_ + dense_of(x); }
  std::function<double(double)> reach_;
  VecX start_ = VecX::Zero(n);
};

TEST(Path, IsTakenInOneStepWhereThatConverges) {
  auto problem = hardening();
  auto work = workspace();
  const auto summary = follow_path(problem, work, {});
  EXPECT_TRUE(summary.reached);
  ASSERT_EQ(summary.points.size(), 1u);
  EXPECT_EQ(summary.lambda(), 1);
  EXPECT_EQ(summary.failed_attempts, 0);
  EXPECT_EQ(summary.newton_iterations, summary.points[0].newton.newton_iterations());
  EXPECT_TRUE(mentions(summary.reason, "lambda = 1 reached in 1 step"));
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(problem.point[i], 1, 1e-9);
  EXPECT_EQ(problem.committed, problem.point);
}

TEST(Path, HalvesAStepThatFails) {
  ShortSighted problem([](double) { return 0.3; });
  auto work = workspace();
  const auto summary = follow_path(problem, work, few_iterations());
  EXPECT_TRUE(summary.reached);
  EXPECT_GE(summary.failed_attempts, 2) << "1 and 1/2 are both too far";
  EXPECT_EQ(summary.points.front().lambda, 0.25);
  EXPECT_EQ(summary.points.back().lambda, 1);
  double before = 0;
  for (const auto& point : summary.points) {
    EXPECT_LE(point.lambda - before, 0.3);
    EXPECT_GT(point.lambda, before);
    before = point.lambda;
  }
  EXPECT_NEAR(problem.point[0], 1, 1e-12);
}

TEST(Path, DoublesItsStepAfterEasyOnes) {
  // Hard going up to 0.2, free beyond.
  ShortSighted problem([](double kept) { return kept < 0.2 ? 0.04 : 10.0; });
  auto work = workspace();
  const auto summary = follow_path(problem, work, few_iterations());
  ASSERT_TRUE(summary.reached);
  const auto& points = summary.points;
  ASSERT_GE(points.size(), 4u);
  EXPECT_NEAR(points.front().lambda, 1.0 / 32, 1e-15);
  const double last_step = points.back().lambda - points[points.size() - 2].lambda;
  EXPECT_GT(last_step, 4 * points.front().lambda);
  EXPECT_EQ(points.back().lambda, 1);
}

TEST(Path, WithoutASolutionStopsBeforeItAndStaysAtTheLastConvergedPoint) {
  // x - x^2 = lambda / 2.4 has no solution beyond lambda = 0.6, where x = 1/2 and the tangent vanishes.
  auto problem = six_times([](double x, double lambda) { return x - x * x - lambda / 2.4; },
                           [](double x) { return 1 - 2 * x; });
  auto work = workspace();
  const NewtonOptions options = few_iterations();
  const auto summary = follow_path(problem, work, options);
  EXPECT_FALSE(summary.reached);
  EXPECT_LE(summary.lambda(), 0.6 + 1e-9);
  EXPECT_GT(summary.lambda(), 0.6 - 4 * options.min_step);
  EXPECT_EQ(problem.lambda, summary.lambda());
  EXPECT_EQ(problem.point, problem.committed);
  EXPECT_LT(problem.out_of_balance(), 1e-8);
  EXPECT_TRUE(mentions(summary.reason, "stopped at lambda = 0."));
  EXPECT_TRUE(mentions(summary.reason, "fell below min_step = 1.00e-03"));
  EXPECT_TRUE(mentions(summary.reason, "the last attempt failed because"));
}

TEST(Path, ThatCannotEvenBeginStaysAtItsStart) {
  ShortSighted problem([](double) { return 0.0; });
  auto work = workspace();
  const auto summary = follow_path(problem, work, few_iterations());
  EXPECT_FALSE(summary.reached);
  EXPECT_TRUE(summary.points.empty());
  EXPECT_EQ(summary.lambda(), 0);
  EXPECT_EQ(problem.lambda, 0);
  EXPECT_EQ(problem.point, VecX::Zero(6));
}

TEST(Path, ReportsTheLambdaItAimsAt) {
  auto problem = hardening();
  auto work = workspace();
  int calls = 0;
  const auto tell = [&](double aim, int iteration, double residual) {
    EXPECT_EQ(aim, 1);
    EXPECT_EQ(iteration, calls++);
    EXPECT_GE(residual, 0);
  };
  follow_path(problem, work, {}, {tell, {}, {}});
  EXPECT_GT(calls, 2);
}

/// -x1 + ... : a saddle with one negative direction.
DenseProblem saddle(double load) {
  const auto signs = [] {
    VecX s = VecX::Ones(6);
    s[2] = -1;
    return s;
  };
  return {
      [=](const VecX& x, double lambda) -> VecX { return signs().cwiseProduct(x).array() - lambda * load; },
      [=](const VecX&) -> MatX { return signs().asDiagonal(); }};
}

TEST(Path, EndsWithTheInertiaOfItsTangent) {
  auto problem = saddle(1);
  auto work = workspace();
  EXPECT_EQ(follow_path(problem, work, {}).inertia.negative, 1);
  auto stable = hardening();
  EXPECT_EQ(follow_path(stable, work, {}).inertia.negative, 0);
}

TEST(Path, EndsWithTheInertiaOfItsTangentEvenIfNothingMoved) {
  auto work = workspace();
  auto stable = hardening();
  follow_path(stable, work, {});
  auto problem = saddle(0);
  const auto summary = follow_path(problem, work, {});
  EXPECT_EQ(summary.newton_iterations, 0);
  EXPECT_EQ(summary.inertia.negative, 1);
}

TEST(Path, IsAtItsLastConvergedPointAfterAnError) {
  bool armed = false;
  DenseProblem problem(
      [&](const VecX& x, double lambda) -> VecX {
        if (armed && lambda > 0.5) throw std::runtime_error("interrupted");
        if (lambda > 0.5) return VecX::Constant(6, std::nan(""));
        return x.array() + x.array().cube() - 2 * lambda;
      },
      [](const VecX& x) -> MatX { return MatX((1 + 3 * x.array().square()).matrix().asDiagonal()); });
  auto work = workspace();
  EXPECT_THROW(follow_path(problem, work, few_iterations(),
                           {[&](double aim, int, double) { armed = armed || aim <= 0.5; }, {}, {}}),
               std::runtime_error);
  EXPECT_EQ(problem.lambda, 0.5);
  EXPECT_EQ(problem.point, problem.committed);
  EXPECT_LT(problem.out_of_balance(), 1e-8);
}

/// Newton's method is given no room, so that the last resort finds the end.
TEST(Path, HasPrescribedUnknownsWhereLambdaHasThemWhoeverFoundTheEnd) {
  for (const double pull : {0.0, 8.0})
    for (const auto method : {LastResort::none, LastResort::descent, LastResort::dynamic_relaxation}) {
      DrivenProblem problem(pull);
      problem.size = 10;  // first pushes of a fiftieth: the problem becomes stiffer on the way
      auto work = workspace();
      NewtonOptions options;
      if (method != LastResort::none) {
        options.max_iterations = 1;
        options.min_step = 0.9;
      }
      std::vector<double> told;
      PathStart start;
      start.last_resort = method;
      const auto summary =
          follow_path(problem, work, options,
                      {{}, [&](const PathPoint& point) { told.push_back(point.lambda); }, {}, {}}, start);
      ASSERT_TRUE(summary.reached) << summary.reason;
      EXPECT_EQ(problem.lambda, 1);
      EXPECT_EQ(problem.point[5], DrivenProblem::way);
      EXPECT_EQ(problem.committed, problem.point);
      for (int i = 0; i < 5; ++i)
        EXPECT_NEAR(problem.point[i] + std::pow(problem.point[i], 3), pull + DrivenProblem::way, 1e-8);
      EXPECT_EQ(told.back(), 1) << "the end is a point of the path as any other";
      EXPECT_EQ(summary.points.back().lambda, 1);
      EXPECT_EQ(summary.last_resort.has_value(), method != LastResort::none);
    }
}

/// A hump between two wells: x^3 - x + lambda / 10 in all unknowns; from the left well a step leaps to the
/// hump.
TEST(Path, DoesNotTakeAnUnstableEquilibriumThatNoPathLeadsTo) {
  class Leaper : public DenseProblem {
   public:
    using DenseProblem::DenseProblem;
    bool predict(Workspace&) override {
      if (lambda - at_ > 0.3) point.setZero();  // a bad first guess of a long step, on the hump
      restart();
      return true;
    }
    void commit() override {
      DenseProblem::commit();
      at_ = lambda;
    }

   private:
    double at_ = 0;
  };
  const auto well = six_times([](double x, double lambda) { return x * x * x - x + lambda / 10; },
                              [](double x) { return 3 * x * x - 1; });
  Leaper problem(well.gradient(), well.hessian());
  problem.point = problem.committed = VecX::Constant(DenseProblem::n, -1);
  problem.restart();
  auto work = workspace();
  const auto summary = follow_path(problem, work, {});
  ASSERT_TRUE(summary.reached) << summary.reason;
  EXPECT_GT(summary.failed_attempts, 0);
  EXPECT_EQ(summary.inertia.negative, 0);
  EXPECT_NEAR(std::pow(problem.point[0], 3) - problem.point[0] + 0.1, 0, 1e-8);
  EXPECT_LT(problem.point[0], -1) << "the well it began in, which moves outwards";
}

}  // namespace
}  // namespace tautline::analysis
