#include <gtest/gtest.h>

#include <cmath>
#include <tautline/analysis/descent.hpp>

#include "analysis/dense_problem.hpp"
#include "messages.hpp"

namespace tautline::analysis {
namespace {

using namespace testing_problem;
using testing_messages::mentions;

/// Energy (x^2 - 1)^2 / 4: valleys at -1 and 1, a hill at 0.
DenseProblem double_well() {
  auto problem =
      six_times([](double x, double) { return x * x * x - x; }, [](double x) { return 3 * x * x - 1; });
  problem.size = 10;
  return problem;
}

/// Energy sqrt(1 + x^2): from |x| > 1 Newton's method runs away, x -> -x^3.
DenseProblem wide_well() {
  auto problem = six_times([](double x, double) { return x / std::sqrt(1 + x * x); },
                           [](double x) { return std::pow(1 + x * x, -1.5); });
  problem.point.setConstant(3);
  problem.size = 10;
  return problem;
}

TEST(Descent, LeavesTheHillThatNewtonsMethodStaysOn) {
  auto work = workspace();
  auto newton = double_well();
  newton.point.setConstant(0.1);
  ASSERT_TRUE(solve_newton(newton, work, {}).converged());
  EXPECT_NEAR(newton.point[0], 0, 1e-9);
  auto problem = double_well();
  problem.point << 0.1, -0.1, 0.1, -0.1, 0.1, -0.1;
  const auto summary = descend(problem, work, {});
  EXPECT_TRUE(summary.newton.converged());
  EXPECT_GT(summary.steps, 1);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(problem.point[i], i % 2 == 0 ? 1 : -1, 1e-9) << i;
}

TEST(Descent, FindsTheWellThatNewtonsMethodJumpsOver) {
  auto work = workspace();
  auto lost = wide_well();
  EXPECT_FALSE(solve_newton(lost, work, {}).converged());
  auto problem = wide_well();
  EXPECT_TRUE(descend(problem, work, {}).newton.converged());
  EXPECT_LT(problem.point.lpNorm<Eigen::Infinity>(), 1e-8);
}

TEST(Descent, IsNewtonsMethodWhereTheEnergyIsConvex) {
  const MatX k = la::testing_chain::held_chain(6, 100);
  const VecX load = VecX::LinSpaced(6, 1, 2);
  DenseProblem problem([=](const VecX& x, double) -> VecX { return k * x - load; },
                       [=](const VecX&) -> MatX { return k; });
  problem.size = 100;
  auto work = workspace();
  const auto summary = descend(problem, work, {});
  EXPECT_EQ(summary.steps, 1);
  EXPECT_TRUE(summary.newton.converged());
  EXPECT_LT((problem.point - k.ldlt().solve(load)).norm(), 1e-12 * problem.point.norm());
}

/// A valley with a steep wall behind it, which the whole step would run into: energy falls from point to
/// point, and the point is found.
TEST(Descent, StopsBeforeAWallThatTheWholeStepRunsInto) {
  class Recorded : public DenseProblem {
   public:
    explicit Recorded(double wall)
        : DenseProblem(
              [wall](const VecX& x, double) -> VecX {
                return x.array() - 1 + wall * (x.array() - 0.3).max(0).cube();
              },
              [wall](const VecX& x) -> MatX {
                return (1 + 3 * wall * (x.array() - 0.3).max(0).square()).matrix().asDiagonal();
              }),
          wall_(wall) {}
    void accept(const la::Vector& x) override {
      DenseProblem::accept(x);
      energy.push_back(
          (0.5 * (point.array() - 1).square() + wall_ / 4 * (point.array() - 0.3).max(0).square().square())
              .sum());
    }
    std::vector<double> energy;

   private:
    double wall_;
  };
  for (const double wall : {1e3, 1e5, 1e8}) {
    Recorded problem(wall);
    problem.size = 1e3;  // no step is long
    auto work = workspace();
    const auto summary = descend(problem, work, {});
    ASSERT_TRUE(summary.newton.converged()) << summary.newton.reason;
    EXPECT_LE(problem.out_of_balance(), 1e-6);
    EXPECT_NEAR(problem.point[0], 0.3 + std::cbrt((1 - problem.point[0]) / wall), 1e-9);
    for (std::size_t i = 1; i < problem.energy.size(); ++i)
      EXPECT_LE(problem.energy[i], problem.energy[i - 1] * (1 + 1e-9)) << wall << " " << i;
    EXPECT_LE(summary.steps, 20);
  }
}

TEST(Descent, SaysSoWhereNoDampingHelps) {
  auto problem = six_times([](double, double) { return 1.0; }, [](double) { return std::nan(""); });
  auto work = workspace();
  const auto summary = descend(problem, work, {});
  EXPECT_EQ(summary.newton.status, NewtonStatus::singular);
  EXPECT_EQ(summary.steps, 0);
  EXPECT_EQ(problem.point.norm(), 0);
}

TEST(Descent, TellsHowFarItWentWhereNothingHolds) {
  auto problem = six_times([](double x, double) { return -x; }, [](double) { return -1.0; });
  problem.point.setConstant(0.1);
  auto work = workspace();
  const auto summary = descend(problem, work, {});
  EXPECT_FALSE(summary.newton.converged());
  EXPECT_TRUE(mentions(summary.newton.reason, "downhill in energy led 2 times the structure's size away"));
  EXPECT_GT(problem.point[0], 1.9);
}

TEST(Descent, IsTakenByAPathThatKnowsNoEquilibriumYet) {
  auto work = workspace();
  auto lost = wide_well();
  EXPECT_FALSE(follow_path(lost, work, {}).reached);
  EXPECT_NEAR(lost.point[0], 3, 1e-15) << "back where it was";
  auto problem = wide_well();
  const auto summary = follow_path(problem, work, {}, {}, {0, true, {}});
  EXPECT_TRUE(summary.reached);
  EXPECT_GT(summary.descent_steps, 1);
  EXPECT_EQ(summary.points.size(), 1u);
  EXPECT_LT(problem.point.lpNorm<Eigen::Infinity>(), 1e-8);
}

TEST(Descent, IsPreferredByAPathToAnUnstableEquilibrium) {
  auto work = workspace();
  auto problem = double_well();
  problem.point.setConstant(0.1);
  const auto from_rest = follow_path(problem, work, {});
  EXPECT_EQ(from_rest.inertia.negative, 6) << "Newton's method goes to the top of the hill";
  auto lost = double_well();
  lost.point.setConstant(0.1);
  const auto summary = follow_path(lost, work, {}, {}, {0, true, {}});
  EXPECT_TRUE(summary.reached);
  EXPECT_EQ(summary.inertia.negative, 0);
  EXPECT_TRUE(summary.critical.empty());
  EXPECT_NEAR(lost.point[0], 1, 1e-9);
}

}  // namespace
}  // namespace tautline::analysis
