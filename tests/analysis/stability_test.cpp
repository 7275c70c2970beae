// Modes, shares of the load and critical points of small problems whose eigenvalues are known.
#include <gtest/gtest.h>

#include <cmath>
#include <tautline/analysis/stability.hpp>

#include "analysis/bordered.hpp"
#include "analysis/dense_problem.hpp"
#include "messages.hpp"

namespace tautline::analysis {
namespace {

using namespace testing_problem;
using testing_messages::mentions;

TEST(LoadShare, IsTheCosineBetweenModeAndLoadMeasuredByTheWeights) {
  // Where displacements are measured by w, forces are by 1 / w: a mode x with x w x = 1 and a load q make
  // x q / sqrt(sum q^2 / w).
  VecX w(6), q(6);
  w << 4, 4, 1, 1, 0.25, 0.25;
  q << 2, 0, 3, 0, 0, 1;
  const double size = std::sqrt(4.0 / 4 + 9.0 / 1 + 1.0 / 0.25);
  const auto share = [&](const VecX& mode, const VecX& load) {
    return load_share(vector_of(mode / std::sqrt(mode.dot(w.cwiseProduct(mode)))), vector_of(load),
                      vector_of(w));
  };
  EXPECT_NEAR(share(q.cwiseQuotient(w), q), 1, 1e-14) << "the load's own response to the weights";
  EXPECT_NEAR(share(VecX::Unit(6, 2), q), 3 / size, 1e-14);
  EXPECT_NEAR(share(VecX::Unit(6, 0), q), 2 / 2 / size, 1e-14);
  EXPECT_NEAR(share(VecX::Unit(6, 5), q), 1 / 0.5 / size, 1e-14);
  EXPECT_EQ(share(VecX::Unit(6, 1), q), 0);
  EXPECT_EQ(share(VecX::Unit(6, 2), VecX::Zero(6)), 0) << "no load works on nothing";
}

TEST(LoadShare, LeavesOutWhatHasNoWeight) {
  const VecX w = (VecX(6) << 1, 1, 0, 0, 1, 1).finished(), q = (VecX(6) << 3, 0, 100, 0, 0, 4).finished();
  EXPECT_NEAR(load_share(vector_of(VecX::Unit(6, 0)), vector_of(q), vector_of(w)), 3.0 / 5, 1e-14);
}

/// A problem with the given eigenvalues that change with lambda.
class Spectrum : public DenseProblem {
 public:
  using Values = std::function<VecX(double lambda)>;
  explicit Spectrum(Values values)
      : DenseProblem([](const VecX& x, double) -> VecX { return x; },
                     [this](const VecX&) -> MatX { return values_(lambda).asDiagonal(); }),
        values_(std::move(values)) {}

 private:
  Values values_;
};

TEST(SoftestMode, HasTheUnitOfTheWeights) {
  Spectrum problem([](double) -> VecX { return (VecX(6) << 4, 2, 0.5, 3, 1, 5).finished(); });
  problem.size = 10;  // weights of 1/100
  auto work = workspace();
  la::Vector weights(problem.layout());
  problem.weights(1, weights);
  count_negative(problem, work);
  const auto soft = softest_mode(problem, work.solver, weights);
  EXPECT_NEAR(soft.eigenvalue, 0.5 * 100, 1e-8);
  EXPECT_NEAR(std::abs(dense_of(soft.mode)[2]), 10, 1e-5) << "x d x = 1";
}

/// Where an eigenvalue crosses zero, however it bends on the way: the secant alone would creep.
/// The way along lambda of a problem that is solved everywhere.
auto along(Spectrum& problem) {
  return [&problem](double t) -> std::optional<double> {
    problem.set_lambda(t);
    return t;
  };
}

TEST(CriticalPoint, IsFoundHoweverTheEigenvalueBends) {
  for (const double at : {0.3, 0.9, 0.97}) {
    for (const double power : {1.0, 3.0, 25.0}) {
      for (const bool mirrored : {false, true}) {
        const auto soft = [=](double t) {
          return mirrored ? std::pow(1 - t, power) - std::pow(1 - at, power)
                          : std::pow(at, power) - std::pow(t, power);
        };
        Spectrum problem([=](double lambda) -> VecX {
          VecX values = VecX::LinSpaced(6, 2, 3);
          values[4] = soft(lambda) / soft(0);
          return values;
        });
        auto work = workspace();
        problem.set_lambda(0);
        const auto go = along(problem);
        double behind = 0;
        const auto found = find_critical_point(problem, work, {go, 0, 1, 0}, behind);
        ASSERT_TRUE(found);
        // 1e-10 of the eigenvalue at the start is null; over the slope of the curve that is how far it may
        // lie
        const double slope = std::abs((soft(at + 1e-6) - soft(at - 1e-6)) / 2e-6 / soft(0));
        EXPECT_NEAR(found->lambda, at, 2e-10 / slope + 1e-10) << power << mirrored;
        EXPECT_LT(std::abs(found->eigenvalue), 1e-6);
        EXPECT_EQ(found->negative_before, 0);
        EXPECT_EQ(found->negative_after, 1);
        EXPECT_GE(behind, at - 1e-9);
      }
    }
  }
}

TEST(CriticalPoint, IsTheFirstOfSeveral) {
  Spectrum problem([](double lambda) -> VecX {
    VecX values = VecX::LinSpaced(6, 2, 3);
    values[1] = 0.2 - lambda;
    values[4] = 0.6 - lambda;
    return values;
  });
  auto work = workspace();
  problem.set_lambda(0);
  const auto go = along(problem);
  double behind = 0;
  const auto found = find_critical_point(problem, work, {go, 0, 2, 0}, behind);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->lambda, 0.2, 1e-9);
  EXPECT_EQ(found->negative_after, 1);
  EXPECT_NEAR(std::abs(dense_of(found->mode)[1]), 1, 1e-6);
}

TEST(CriticalPoint, IsNotThereWhereThePathCannotBeFollowed) {
  Spectrum problem([](double) -> VecX { return VecX::LinSpaced(6, 2, 3); });
  auto work = workspace();
  double behind = 0;
  const auto go = [](double) -> std::optional<double> { return std::nullopt; };
  EXPECT_FALSE(find_critical_point(problem, work, {go, 0, 1, 0}, behind));
}

TEST(Bordered, MeetsAPlaneAndASphere) {
  // x = lambda in each of six unknowns.
  auto problem = six_times([](double x, double lambda) { return x - lambda; }, [](double) { return 1.0; });
  problem.size = 10;
  const la::Vector weights = vector_of(VecX::Constant(6, 2));
  auto work = workspace();
  Increment step{la::Vector(problem.layout()), 0.5};
  auto summary = solve_bordered(problem, work, SphereCondition(weights, 4, 3), 0, step, {});
  ASSERT_TRUE(summary.converged()) << summary.reason;
  EXPECT_NEAR(step.lambda, 3 / 4.0, 1e-12) << "2 * 6 l^2 + 4 l^2 = 9";
  problem.point.setZero();
  problem.restart();
  problem.set_lambda(0);
  Increment other{la::Vector(problem.layout()), 3};  // a guess that meets the plane
  summary = solve_bordered(problem, work, PlaneCondition(vector_of(VecX::Unit(6, 3)), 2, 6), 0, other, {});
  ASSERT_TRUE(summary.converged()) << summary.reason;
  EXPECT_NEAR(other.lambda, 2, 1e-12) << "l + 2 l = 6";
}

TEST(Bordered, SaysWhereTheTangentIsSingularAndWhereTheResidualIsNoNumber) {
  auto work = workspace();
  const la::Vector weights = vector_of(VecX::Ones(6));
  DenseProblem flat([](const VecX&, double lambda) -> VecX { return VecX::Constant(6, -lambda); },
                    [](const VecX&) -> MatX { return MatX::Constant(6, 6, std::nan("")); });
  Increment step{la::Vector(flat.layout()), 0.1};
  auto summary = solve_bordered(flat, work, SphereCondition(weights, 1, 1), 0, step, {});
  EXPECT_EQ(summary.status, NewtonStatus::singular) << summary.reason;
  EXPECT_TRUE(mentions(summary.reason, "singular on the way"));
  auto nowhere = six_times([](double, double) { return std::nan(""); }, [](double) { return 1.0; });
  Increment there{la::Vector(nowhere.layout()), 0.1};
  summary = solve_bordered(nowhere, work, SphereCondition(weights, 1, 1), 0, there, {});
  EXPECT_FALSE(summary.converged());
  EXPECT_TRUE(mentions(summary.reason, "no longer a number"));
}

}  // namespace
}  // namespace tautline::analysis
