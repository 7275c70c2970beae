// How the search of constrained force density goes and what it tells: choice of the method, relaxed steps,
// scales, lists of what is not met, and demands that make no sense on a surface.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <Eigen/SVD>
#include <cmath>
#include <formfinding/loaded_pair.hpp>
#include <formfinding/nets.hpp>
#include <limits>
#include <tautline/formfinding/constraints.hpp>
#include <tautline/formfinding/force_density.hpp>

namespace tautline::formfinding {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
using Kind = ConstraintKind;

/// Tensions of 5 N, at which it hangs at z = -1.5 m.
ConstrainedNet tensed_pair() {
  ConstrainedNet problem = loaded_pair();
  problem.constraints = {{Kind::tension, "cables", {0, 1}, {5}}};
  return problem;
}

TEST(ConstrainedForm, IsTheSameInWhateverUnitOfForce) {
  for (const double unit : {1e-9, 1.0, 1e9}) {
    ConstrainedNet problem = tensed_pair();
    problem.net.load[0] *= unit;
    problem.constraints[0].value[0] *= unit;
    for (const StepSolver solver : {StepSolver::dense, StepSolver::lsqr, StepSolver::position_newton}) {
      ConstrainedOptions options;
      options.initial_force_density *= unit;
      options.step_solver = solver;
      const ConstrainedResult result = find_form(problem, options);
      ASSERT_TRUE(result.converged) << unit << ": " << result.reason;
      EXPECT_LE((result.nodes[0] - Vec3(0, 0, -1.5)).norm(), 1e-8) << unit;
      EXPECT_LE((result.tension - Eigen::Vector2d(5, 5) * unit).norm(), 1e-7 * unit);
    }
    ForceDensityOptions options;
    options.initial_force_density *= unit;
    for (const auto method : {TensionMethod::step_of_smallest_norm, TensionMethod::position_newton}) {
      options.method = method;
      const auto result = find_tensions(problem.net, Eigen::Vector2d(5, 5) * unit, nullptr, options);
      ASSERT_TRUE(result.converged) << unit << ": " << result.reason;
      EXPECT_LE((result.nodes[0] - Vec3(0, 0, -1.5)).norm(), 1e-8) << unit;
    }
  }
}

/// The step of smallest norm for lengths of a star, from x = (sum of q a + f) / sum of q:
/// dL_i/dq_j = -(a_i - x).(a_j - x) / (L_i sum of q).
VecX newton_step(const Net& net, const VecX& q, const VecX& wanted) {
  const Eigen::Index n = q.size();
  Eigen::Matrix<double, 3, Eigen::Dynamic> arms(3, n);
  for (Eigen::Index i = 0; i < n; ++i) arms.col(i) = net.nodes[static_cast<std::size_t>(i + 1)];
  const Vec3 x = (arms * q + net.load[0]) / q.sum();
  arms.colwise() -= x;
  MatX J(n, n);
  VecX missing(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double length = arms.col(i).norm();
    missing[i] = (wanted[i] - length) / wanted[i];  // rows are scaled by what is wanted
    J.row(i) = -arms.col(i).transpose() * arms / (length * q.sum() * wanted[i]);
  }
  return J.jacobiSvd(Eigen::ComputeFullU | Eigen::ComputeFullV).solve(missing);
}

TEST(ConstrainedForm, RelaxedStepIsAPartOfNewtons) {
  // With the densities far too high the linear step overshoots into nets that push.
  ConstrainedNet problem = tensed_pair();
  const Eigen::Vector2d wanted(2.5, 2.4);
  problem.constraints = {{Kind::length, "cables", {0, 1}, {wanted[0], wanted[1]}}};
  int relaxed = 0;
  for (const double start : {2.0, 4.0, 8.0, 12.0, 16.0, 24.0}) {
    ConstrainedOptions options;
    options.initial_force_density = start;
    options.max_iterations = 1;
    const ConstrainedResult result = find_form(problem, options);
    const VecX q = VecX::Constant(2, start), step = newton_step(problem.net, q, wanted);
    ASSERT_EQ(result.step_relaxation.size(), 1u);
    const double alpha = result.step_relaxation[0];
    const VecX taken = result.force_density - q;
    if (alpha == 1 && (taken - step).norm() > 1e-9 * step.norm()) continue;  // damped
    EXPECT_LE((taken - alpha * step).norm(), 1e-9 * step.norm()) << start;
    relaxed += alpha < 1;
  }
  EXPECT_GT(relaxed, 0);
}

TEST(ConstrainedForm, ListsWhatIsNotMetLargestFirst) {
  // A straight cable: T in both halves, least ((T - 10)/10)^2 + ((T - 12)/12)^2 at T = 2640/244: 0.082 too
  // much and 0.098 too little.
  ConstrainedNet problem;
  problem.net = star({{-1, 0, 0}, {1, 0, 0}});
  const Constraint small{Kind::tension, "small", {0}, {10}}, large{Kind::tension, "large", {1}, {12}};
  for (const auto& constraints : {std::vector{small, large}, std::vector{large, small}}) {
    problem.constraints = constraints;
    const ConstrainedResult result = find_form(problem);
    EXPECT_FALSE(result.converged);
    ASSERT_EQ(result.worst.size(), 2u);
    EXPECT_EQ(result.worst[0].constraint, "large");
    EXPECT_NEAR(result.worst[0].relative, 220.0 / 244 - 1, 1e-5);
    EXPECT_NEAR(result.worst[1].relative, 264.0 / 244 - 1, 1e-5);
    EXPECT_EQ(result.worst[0].wanted, 12);
    ConstrainedOptions options;
    options.n_worst = 1;
    const ConstrainedResult one = find_form(problem, options);
    ASSERT_EQ(one.worst.size(), 1u);
    EXPECT_EQ(one.worst[0].constraint, "large");
  }
}

TEST(ConstrainedForm, OnASurfaceOnlyTheTiesReact) {
  const PlaneSurface plane(1, 0, 0);
  ConstrainedNet problem;
  problem.net = chain(3, {0, 0, 1}, {3, 0, 1});
  const auto fault = [&](Kind kind, int node) {
    problem.constraints = {{kind, "ties", {node}, {1}}};
    return error_of([&] { find_form(problem); });
  };
  const auto nothing = [](const char* direction, int node) {
    return fmt::format("reaction {} of ties: node {} is free in that direction, where nothing reacts",
                       direction, node + 1);
  };
  problem.surface = &plane;
  EXPECT_EQ(fault(Kind::reaction_x, 1), nothing("x", 1));
  EXPECT_EQ(fault(Kind::reaction_y, 2), nothing("y", 2));
  EXPECT_EQ(fault(Kind::reaction_z, 1), "no error");
  EXPECT_EQ(fault(Kind::reaction_x, 0), "no error") << "fixed";
  problem.net.on_surface = {false, true, false, false};
  EXPECT_EQ(fault(Kind::reaction_z, 1), "no error");
  EXPECT_EQ(fault(Kind::reaction_z, 2), nothing("z", 2)) << "it hangs below";
  problem.surface = nullptr;
  EXPECT_EQ(fault(Kind::reaction_z, 1), nothing("z", 1));
}

/// A net of more than 2000 branches with a tension in each.
ConstrainedNet large_net() {
  ConstrainedNet problem;
  problem.net = triangular_net(26, 0.5, Dish(20));
  Constraint tension{Kind::tension, "net", {}, {10}};
  for (int b = 0; b < static_cast<int>(problem.net.branches.size()); ++b) tension.members.push_back(b);
  problem.constraints = {tension};
  return problem;
}

TEST(ConstrainedForm, ChoosesPositionsAsUnknownsWhereTheNetIsLargeAndNothingSpeaksAgainst) {
  ConstrainedNet problem = large_net();
  ASSERT_GE(problem.net.branches.size(), 2000u);
  const ConstrainedResult found = find_form(problem);
  ASSERT_TRUE(found.converged) << found.reason;
  EXPECT_EQ(found.method, "position_newton");
  EXPECT_LE((found.tension.array() - 10).abs().maxCoeff(), 1e-9);

  ConstrainedOptions none;
  none.max_iterations = 0;
  EXPECT_EQ(find_form(problem, none).method, "lsqr") << "did not converge: the other has the last word";
  none.step_solver = StepSolver::position_newton;
  const ConstrainedResult asked = find_form(problem, none);
  EXPECT_EQ(asked.method, "position_newton");
  EXPECT_FALSE(asked.converged);
  EXPECT_NE(asked.reason.find(" > "), std::string::npos) << asked.reason;

  problem.constraints.push_back({Kind::length, "first", {0}, {0.5}});
  none.step_solver = StepSolver::automatic;
  EXPECT_EQ(find_form(problem, none).method, "lsqr") << "a length is asked for";
  none.step_solver = StepSolver::position_newton;
  EXPECT_NE(error_of([&] { find_form(problem, none); }).find("nothing else may be asked for"),
            std::string::npos);
}

TEST(ConstrainedForm, KeepsTheForceDensitiesAsUnknownsForConditionAndPublishedJacobian) {
  const ConstrainedNet problem = large_net();
  ConstrainedOptions condition, published;
  condition.estimate_condition = true;
  published.jacobian = SurfaceJacobian::as_published;
  for (ConstrainedOptions options : {condition, published}) {
    options.max_iterations = 0;
    EXPECT_EQ(find_form(problem, options).method, "lsqr");
  }
  ConstrainedNet small = tensed_pair();
  EXPECT_EQ(find_form(small).method, "dense");
}

TEST(LinearForm, WithoutFreeNodesNothingIsOutOfBalance) {
  Net net = chain(1, {0, 0, 0}, {2, 0, 0});
  const LinearForm form = find_linear_form(net, VecX::Constant(1, 3));
  EXPECT_EQ(form.out_of_balance, 0);
  EXPECT_EQ(form.tension[0], 6);
  EXPECT_EQ(form.negative_directions, 0);
  EXPECT_LE((form.reaction[0] - Vec3(-6, 0, 0)).norm(), 1e-15);
}

TEST(ForceDensity, ConditionIsThatOfTheJacobian) {
  // At x = 0 with q = 10 everywhere, dT_0/dq = (1 - 1/4, 1/4, 0, 0) and, at twice the distance,
  // dT_2/dq = (0, 0, 2 - 1/2, 1/2): G^T G = diag(10/16, 10/4).
  ForceDensityOptions options;
  options.method = TensionMethod::step_of_smallest_norm;
  options.estimate_condition = true;
  options.max_iterations = 0;
  for (const double unit : {1e-6, 1.0, 1e6}) {
    const Net net = star({{-unit, 0, 0}, {unit, 0, 0}, {0, 2 * unit, 0}, {0, -2 * unit, 0}});
    const auto found = find_tensions(net, Eigen::Vector4d(10, nan, 5, nan), nullptr, options);
    EXPECT_NEAR(found.condition_number, 4, 1e-12) << unit;
  }
}

TEST(ForceDensity, ConditionIsInfiniteWhereTensionsDependOnEachOther) {
  // The three pieces of a straight cable carry one tension: rank 1.
  ForceDensityOptions options;
  options.method = TensionMethod::step_of_smallest_norm;
  options.estimate_condition = true;
  options.max_iterations = 0;
  for (const double unit : {1e-6, 1.0, 1e6}) {
    Net net = chain(3, {0, 0, 0}, unit * Vec3(1, 2, 0.3));
    const auto found = find_tensions(net, Vec3(10, 11, 12), nullptr, options);
    EXPECT_EQ(found.condition_number, std::numeric_limits<double>::infinity()) << unit;
  }
}

}  // namespace
}  // namespace tautline::formfinding
