#include <gtest/gtest.h>

#include <cmath>
#include <tautline/analysis/arc_length.hpp>
#include <tautline/analysis/stability.hpp>

#include "analysis/dense_problem.hpp"
#include "messages.hpp"

namespace tautline::analysis {
namespace {

using namespace testing_problem;
using testing_messages::mentions;

/// A shallow two-bar truss, x0 = deflection over rise: lambda = 3 sqrt(3) / 2 x0 (1 - x0) (2 - x0) with
/// limits of +-1 at x0 = 1 -+ 1 / sqrt(3). The other unknowns are springs that the load pulls, too.
DenseProblem truss(double others = 0.3) {
  const double scale = 1.5 * std::sqrt(3.0);
  return {[=](const VecX& x, double lambda) {
            VecX f = x;
            for (int i = 1; i < f.size(); ++i) f[i] -= others * lambda;
            f[0] = scale * x[0] * (1 - x[0]) * (2 - x[0]) - lambda;
            return f;
          },
          [=](const VecX& x) {
            MatX k = MatX::Identity(x.size(), x.size());
            k(0, 0) = scale * (2 - 6 * x[0] + 3 * x[0] * x[0]);
            return k;
          }};
}

/// Euler's column as a rigid bar on a spring, x0 its angle: sin x0 lambda = x0 + eps; and five springs that
/// the load compresses. It bifurcates at lambda = 1; on the branch x0 = 10 x1 sin x0.
DenseProblem column(double eps = 0) {
  return {[=](const VecX& x, double lambda) {
            VecX f = x;
            for (int i = 1; i < f.size(); ++i) f[i] -= 0.1 * lambda;
            f[0] = x[0] - eps - 10 * x[1] * std::sin(x[0]);
            // From the energy x0^2/2 - eps x0 + 10 x1 (cos x0 - 1) + ..., with x1 held to lambda / 10.
            f[1] += 10 * (std::cos(x[0]) - 1);
            return f;
          },
          [=](const VecX& x) {
            MatX k = MatX::Identity(x.size(), x.size());
            k(0, 0) = 1 - 10 * x[1] * std::cos(x[0]);
            k(0, 1) = k(1, 0) = -10 * std::sin(x[0]);
            return k;
          }};
}

ArcLengthOptions steps_of(double first) {
  ArcLengthOptions options;
  options.first_step = first;
  return options;
}

TEST(ArcLength, PassesBothLimitPointsOfATruss) {
  for (const auto constraint : {ArcConstraint::cylindrical, ArcConstraint::spherical}) {
    auto problem = truss();
    auto work = workspace();
    auto options = steps_of(0.1);
    options.constraint = constraint;
    options.load_factor = 2;
    const auto summary = follow_arc(problem, work, {}, options);
    EXPECT_TRUE(summary.reached) << summary.reason;
    EXPECT_EQ(problem.lambda, 2) << "the end is met exactly";
    ASSERT_EQ(summary.critical.size(), 2u);
    for (const int i : {0, 1}) {
      const auto& point = summary.critical[static_cast<std::size_t>(i)];
      EXPECT_EQ(point.kind, CriticalPoint::Kind::limit);
      EXPECT_NEAR(point.lambda, i == 0 ? 1 : -1, 1e-12)
          << "the closed form; an error of 1e-6 in x0 gives 1e-12";
      EXPECT_EQ(point.negative_before, i);
      EXPECT_EQ(point.negative_after, 1 - i);
      problem.return_to(*point.kept);
      EXPECT_NEAR(problem.point[0], 1 + (i == 0 ? -1 : 1) / std::sqrt(3.0), 1e-6);
    }
    for (const auto& point : summary.points) EXPECT_LE(point.negative_directions, 1);
  }
}

TEST(ArcLength, SnapsBack) {
  // Soft springs in series with the truss: the loaded end's motion x0 + others * lambda turns back.
  auto problem = truss(3);
  auto work = workspace();
  auto options = steps_of(0.05);
  options.largest_step = 2;
  options.load_factor = 1.5;
  std::vector<double> way;
  const auto note = [&](const PathPoint&) { way.push_back(problem.point[0] + problem.point[1]); };
  const auto summary = follow_arc(problem, work, {}, options, {}, {{}, note, {}});
  EXPECT_TRUE(summary.reached);
  int turns = 0;
  for (std::size_t i = 2; i < way.size(); ++i) turns += (way[i] - way[i - 1]) * (way[i - 1] - way[i - 2]) < 0;
  EXPECT_EQ(turns, 2);
  for (std::size_t i = 0; i < summary.points.size(); ++i) EXPECT_LE(std::abs(summary.points[i].lambda), 1.5);
}

TEST(ArcLength, EndsWhereTheMotionWatchedIsMet) {
  auto problem = truss();
  auto work = workspace();
  auto options = steps_of(0.1);
  options.load_factor = 5;
  options.displacement = 0.9;
  const auto summary = follow_arc(problem, work, {}, options,
                                  Watch{vector_of(VecX::Unit(6, 0)), [&] { return problem.point[0]; }});
  EXPECT_TRUE(summary.reached);
  EXPECT_NEAR(problem.point[0], 0.9, 1e-12);
  EXPECT_NEAR(summary.lambda(), 1.5 * std::sqrt(3.0) * 0.9 * 0.1 * 1.1, 1e-9);
}

TEST(ArcLength, TellsABifurcationFromALimitAndGoesOnAlongThePath) {
  auto problem = column();
  auto work = workspace();
  auto options = steps_of(0.3);
  options.load_factor = 1.7;
  const auto summary = follow_arc(problem, work, {}, options);
  EXPECT_TRUE(summary.reached);
  ASSERT_EQ(summary.critical.size(), 1u);
  const auto& point = summary.critical.front();
  EXPECT_EQ(point.kind, CriticalPoint::Kind::bifurcation);
  EXPECT_NEAR(point.lambda, 1, 1e-9);
  EXPECT_NEAR(point.load_share, 0, 1e-9);
  EXPECT_NEAR(std::abs(dense_of(point.mode)[0]), 1, 1e-9);
  EXPECT_NEAR(problem.point[0], 0, 1e-9) << "the straight column stays on its path";
  EXPECT_EQ(summary.points.back().negative_directions, 1);
}

TEST(ArcLength, TurnsOntoABranch) {
  auto problem = column();
  auto work = workspace();
  auto options = steps_of(0.3);
  options.branch = 1;
  options.max_points = 12;
  options.load_factor = 1.4;
  const auto summary = follow_arc(problem, work, {}, options);
  EXPECT_TRUE(summary.reached) << summary.reason;
  EXPECT_GT(std::abs(problem.point[0]), 0.005);
  // On the branch moments balance: x0 = 10 x1 sin x0.
  EXPECT_NEAR(problem.point[0], 10 * problem.point[1] * std::sin(problem.point[0]), 1e-8);
}

/// On a straight path the first guess is in equilibrium wherever it is: it has to be where the path shall
/// end.
TEST(ArcLength, EndsExactlyOnAStraightPath) {
  for (const double end : {0.37, 1.0, 5.3}) {
    auto problem =
        six_times([](double x, double lambda) { return x - 3 * lambda; }, [](double) { return 1.0; });
    auto work = workspace();
    auto options = steps_of(0.3);
    options.load_factor = end;
    const auto summary = follow_arc(problem, work, {}, options);
    ASSERT_TRUE(summary.reached) << summary.reason;
    EXPECT_NEAR(problem.lambda, end, 1e-14 * end);
    EXPECT_NEAR(problem.point[0], 3 * end, 1e-13 * end);

    auto watched =
        six_times([](double x, double lambda) { return x - 3 * lambda; }, [](double) { return 1.0; });
    options.load_factor = 10;
    options.displacement = end;
    const auto there = follow_arc(watched, work, {}, options,
                                  Watch{vector_of(VecX::Unit(6, 0)), [&] { return watched.point[0]; }});
    ASSERT_TRUE(there.reached) << there.reason;
    EXPECT_NEAR(watched.point[0], end, 1e-13 * end);
    EXPECT_NEAR(watched.lambda, end / 3, 1e-13 * end);
  }
}

/// Where the first step asked for on the branch leads out of all that is defined, a shorter one is tried.
TEST(ArcLength, TurnsOntoABranchByAShorterStepWhereTheFirstLeadsNowhere) {
  const auto inner = column();
  DenseProblem problem(
      [inner](const VecX& x, double lambda) -> VecX {
        return std::abs(x[0]) < 0.5 ? inner.gradient()(x, lambda) : VecX::Constant(6, std::nan("")).eval();
      },
      inner.hessian());
  auto work = workspace();
  auto options = steps_of(0.3);
  options.branch = 1;
  options.branch_step = 1;
  options.max_points = 8;
  options.load_factor = 1.2;
  const auto summary = follow_arc(problem, work, {}, options);
  ASSERT_EQ(summary.critical.size(), 1u) << summary.reason;
  EXPECT_FALSE(mentions(summary.reason, "no branch")) << summary.reason;
  EXPECT_GT(std::abs(problem.point[0]), 0.1);
  EXPECT_NEAR(problem.point[0], 10 * problem.point[1] * std::sin(problem.point[0]), 1e-8);
}

TEST(ArcLength, StopsAtACriticalPointIfAsked) {
  auto problem = truss();
  auto work = workspace();
  auto options = steps_of(0.1);
  options.load_factor = 2;
  options.stop_at_critical = 1;
  const auto summary = follow_arc(problem, work, {}, options);
  EXPECT_TRUE(summary.reached);
  EXPECT_TRUE(mentions(summary.reason, "critical point 1"));
  EXPECT_NEAR(problem.point[0], 1 - 1 / std::sqrt(3.0), 1e-6);
  EXPECT_EQ(problem.point, problem.committed);
}

TEST(ArcLength, IsTakenUpAgainAtAnyPointAndGoesTheSameWay) {
  auto options = steps_of(0.05);
  options.largest_step = 2;
  options.load_factor = 1.5;
  auto work = workspace();
  auto problem = truss(3);
  std::vector<VecX> places;
  const auto whole = follow_arc(problem, work, {}, options, {},
                                {{}, [&](const PathPoint&) { places.push_back(problem.point); }, {}});
  ASSERT_EQ(whole.critical.size(), 2u) << "up to a limit, back and up again";
  for (const std::size_t k : {std::size_t{2}, whole.points.size() / 2, whole.points.size() - 3}) {
    auto again = truss(3);
    again.point = places[k];
    again.restart();
    const PathStart start{whole.points[k].lambda, false, whole.points[k].arc};
    const auto rest = follow_arc(again, work, {}, options, {}, {}, start);
    ASSERT_EQ(rest.points.size(), whole.points.size() - k - 1) << k;
    for (std::size_t i = 0; i < rest.points.size(); ++i)
      EXPECT_NEAR(rest.points[i].lambda, whole.points[k + 1 + i].lambda, 1e-10) << k << ' ' << i;
    EXPECT_EQ(rest.reason, whole.reason) << "points are counted from the beginning";
    EXPECT_LT((again.point - problem.point).norm(), 1e-10);
    EXPECT_EQ(rest.critical.size() + static_cast<std::size_t>(whole.points[k].arc->critical), 2u);
  }
}

TEST(ArcLength, MovesPrescribedUnknownsWithLambda) {
  for (const double pull : {0.0, 8.0})
    for (const auto constraint : {ArcConstraint::cylindrical, ArcConstraint::spherical})
      for (const double weight : {1.0, 0.0}) {  // 0: a metric that sees no motion of the free unknowns
        DrivenProblem problem(pull);
        problem.weight = weight;
        problem.drive_weight = weight > 0 ? 1 : 1e-3;
        auto work = workspace();
        auto options = steps_of(0.1);
        options.constraint = constraint;
        const auto summary = follow_arc(problem, work, {}, options);
        ASSERT_TRUE(summary.reached) << summary.reason;
        EXPECT_NEAR(problem.lambda, 1, 1e-14);
        EXPECT_NEAR(problem.point[5], DrivenProblem::way, 1e-14);
        for (int i = 0; i < 5; ++i)
          EXPECT_NEAR(problem.point[i] + std::pow(problem.point[i], 3), pull + DrivenProblem::way, 1e-8);
      }
}

TEST(ArcLength, GoesByLambdaWhereNothingMoves) {
  class Stressed : public DenseProblem {
   public:
    using DenseProblem::DenseProblem;
    bool changes_at_rest() override { return true; }
  } problem([](const VecX& x, double) -> VecX { return x; },
            [](const VecX& x) -> MatX { return MatX::Identity(x.size(), x.size()); });
  auto work = workspace();
  const auto summary = follow_arc(problem, work, {}, {});
  EXPECT_TRUE(summary.reached) << summary.reason;
  EXPECT_EQ(problem.lambda, 1);
}

/// A metric that sees nothing at all makes lengths of zero: it must end all the same.
TEST(ArcLength, EndsWhereStepsHaveNoLength) {
  DrivenProblem problem(1);
  problem.weight = problem.drive_weight = 0;
  auto work = workspace();
  const auto summary = follow_arc(problem, work, {}, {});
  EXPECT_FALSE(summary.reached);
}

TEST(ArcLength, OfLoadsThatMoveNothingSaysSo) {
  DenseProblem problem([](const VecX& x, double) -> VecX { return x; },
                       [](const VecX& x) -> MatX { return MatX::Identity(x.size(), x.size()); });
  auto work = workspace();
  const auto summary = follow_arc(problem, work, {}, {});
  EXPECT_FALSE(summary.reached);
  EXPECT_TRUE(mentions(summary.reason, "move nothing"));
}

TEST(Stability, APathByLoadFindsTheBifurcationsThatItPasses) {
  // Stiffnesses 1 - lambda / k of unknowns that nothing pulls.
  double at = 0;
  DenseProblem problem(
      [](const VecX& x, double lambda) {
        VecX f(6);
        for (int i = 0; i < 6; ++i) f[i] = (1 - (i < 2 ? 3.0 - i : 0.1) * lambda) * x[i];
        f[5] = x[5] - lambda;
        return f;
      },
      [&](const VecX&) -> MatX {
        MatX k = MatX::Identity(6, 6);
        for (int i = 0; i < 5; ++i) k(i, i) = 1 - (i < 2 ? 3.0 - i : 0.1) * at;
        return k;
      });
  auto work = workspace();
  class Follower : public DenseProblem {
   public:
    Follower(const DenseProblem& base, double& at_tangent) : DenseProblem(base), at_(at_tangent) {}
    void tangent(la::SymmetricMatrix& k) override {
      at_ = lambda;
      DenseProblem::tangent(k);
    }

   private:
    double& at_;
  } follower(problem, at);
  const auto summary = follow_path(follower, work, {});
  EXPECT_TRUE(summary.reached);
  EXPECT_EQ(summary.points.back().negative_directions, 2);
  ASSERT_EQ(summary.critical.size(), 2u);
  EXPECT_NEAR(summary.critical[0].lambda, 1.0 / 3, 1e-9);
  EXPECT_NEAR(summary.critical[1].lambda, 0.5, 1e-9);
  for (const auto& point : summary.critical) EXPECT_EQ(point.kind, CriticalPoint::Kind::bifurcation);
  EXPECT_EQ(follower.lambda, 1) << "the search leaves the problem at the end of the path";
}

TEST(Stability, FindsTheEigenvalueNearestToZero) {
  VecX values(6);
  values << 4, 2, -0.5, 3, 1, 5;
  DenseProblem problem([=](const VecX& x, double) -> VecX { return values.cwiseProduct(x); },
                       [=](const VecX&) -> MatX { return values.asDiagonal(); });
  auto work = workspace();
  la::Vector weights(problem.layout());
  problem.weights(1, weights);
  EXPECT_EQ(count_negative(problem, work), 1);
  const auto soft = softest_mode(problem, work.solver, weights);
  EXPECT_NEAR(soft.eigenvalue, -0.5, 1e-10);
  EXPECT_NEAR(std::abs(dense_of(soft.mode)[2]), 1, 1e-6);
}

}  // namespace
}  // namespace tautline::analysis
