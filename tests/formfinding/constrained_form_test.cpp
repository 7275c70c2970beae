// Constrained force density: each kind of constraint against statics done by hand, the operators against
// finite differences, and the sparse step against the dense one.
#include <gtest/gtest.h>

#include <cmath>
#include <formfinding/constraint_search.hpp>
#include <formfinding/loaded_pair.hpp>
#include <formfinding/nets.hpp>
#include <limits>
#include <tautline/formfinding/constraints.hpp>
#include <tautline/formfinding/force_density.hpp>

namespace tautline::formfinding {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
using Kind = ConstraintKind;

void expect_loaded_pair(const ConstrainedResult& result) {
  ASSERT_TRUE(result.converged) << result.reason;
  EXPECT_LE((result.nodes[0] - Vec3(0, 0, -1.5)).norm(), 1e-8);
  EXPECT_LE((result.tension - Eigen::Vector2d(5, 5)).norm(), 1e-7);
  EXPECT_LE(result.out_of_balance, 1e-9);
}

TEST(LinearForm, CompressionMemberPushesTheNodeBeyondItsSupports) {
  // x = (3 x 0 - 1 x 1) / (3 - 1)
  const LinearForm form = find_linear_form(star({{0, 0, 0}, {1, 0, 0}}), Eigen::Vector2d(3, -1));
  EXPECT_NEAR(form.nodes[0].x(), -0.5, 1e-15);
  EXPECT_NEAR(form.tension[1], -1.5, 1e-15);
  EXPECT_EQ(form.negative_directions, 0);
  ASSERT_EQ(form.warnings.size(), 1u);
  EXPECT_EQ(
      form.warnings[0],
      "1 of 2 branches are compression members; the most negative force density is -1 N/m, in branch 2");
}

TEST(LinearForm, IndefinitenessIsCountedInEveryDirection) {
  const LinearForm form = find_linear_form(star({{0, 0, 0}, {1, 0, 0}}), Eigen::Vector2d(1, -3));
  EXPECT_NEAR(form.nodes[0].x(), 1.5, 1e-15);
  EXPECT_EQ(form.negative_directions, 3);
  ASSERT_EQ(form.warnings.size(), 2u);
  EXPECT_NE(form.warnings[1].find("indefinite, with 3 negative eigenvalue(s)"), std::string::npos);
}

TEST(LinearForm, ReactionsBalanceTheLoads) {
  Net net = star({{0, 0, 0}, {4, 0, 0}, {0, 4, 2}});
  net.load = {{4, 0, -8}, Vec3::Zero(), Vec3::Zero(), {1, 2, 3}};
  const LinearForm form = find_linear_form(net, Vec3(1, 2, 1));
  Vec3 sum(5, 2, -5);
  for (int node = 1; node < 4; ++node) sum += form.reaction[node];
  EXPECT_LE(sum.norm(), 1e-14);
}

TEST(Guide, NodeOnALineBalancesAlongIt) {
  // Least of the sum of q |s t - a|^2: s = sum of q a.t / sum of q.
  Net net = star({{0, 1, 0}, {3, 2, 0}});
  net.guides = {{0, Guide::Kind::line, Vec3::Zero(), Vec3(2, 2, 0)}};
  const LinearForm form = find_linear_form(net, Eigen::Vector2d(1, 2));
  EXPECT_LE((form.nodes[0] - Vec3(1, 1, 0) * (11.0 / 6)).norm(), 1e-14);
  EXPECT_LE(form.out_of_balance, 1e-14);
  EXPECT_NEAR(form.reaction[0].dot(Vec3(1, 1, 0)), 0, 1e-14);
  EXPECT_GT(form.reaction[0].norm(), 0.1);
}

TEST(Guide, NodeInAPlaneIsTheProjectionOfTheMean) {
  Net net = star({{0, 1, 0}, {3, 2, 0}});
  const Vec3 normal = Vec3(1, 1, 1).normalized(), point(1, 2, 3), mean(2, 5.0 / 3, 0);
  net.guides = {{0, Guide::Kind::plane, point, 5 * normal}};
  const LinearForm form = find_linear_form(net, Eigen::Vector2d(1, 2));
  EXPECT_LE((form.nodes[0] - (mean - normal * normal.dot(mean - point))).norm(), 1e-14);
}

TEST(Guide, EqualTensionsMeetTheLineLikeReflectedLight) {
  // The mirror image of (2, 2) lies on the straight line from (-1, 1) through (0, 0).
  ConstrainedNet problem;
  problem.net = star({{-1, 1, 0}, {2, 2, 0}});
  problem.net.guides = {{0, Guide::Kind::line, Vec3(7, 0, 0), Vec3::UnitX()}};
  problem.constraints = {{Kind::tension, "rope", {0, 1}, {10}}};
  for (const StepSolver solver : {StepSolver::dense, StepSolver::lsqr, StepSolver::position_newton}) {
    ConstrainedOptions options;
    options.step_solver = solver;
    const ConstrainedResult result = find_form(problem, options);
    ASSERT_TRUE(result.converged) << result.reason;
    EXPECT_LE(result.nodes[0].norm(), 1e-8);
  }
}

TEST(Surfaces, TableReproducesSecondDegreeHeightsAndSlopes) {
  const auto z = [](double x, double y) { return 1 + 2 * x - y + 0.3 * x * x + 0.5 * x * y - 0.7 * y * y; };
  const std::vector<double> x{-1, 0, 0.5, 2, 3}, y{0, 1, 3};
  MatX height(5, 3);
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 3; ++j) height(i, j) = z(x[i], y[j]);
  const TableSurface table(x, y, height);
  for (const auto& [a, b] :
       std::vector<std::pair<double, double>>{{-1, 0}, {-0.3, 0.2}, {1.7, 2.9}, {3, 3}}) {
    const Vec3 found = table.height_and_slope(a, b);
    EXPECT_NEAR(found[0], z(a, b), 1e-13);
    EXPECT_NEAR(found[1], 2 + 0.6 * a + 0.5 * b, 1e-13);
    EXPECT_NEAR(found[2], -1 + 0.5 * a - 1.4 * b, 1e-13);
  }
  EXPECT_EQ(error_of([&] { table.height_and_slope(3.5, 0); }),
            "x = 3.5 m is outside the table of heights, which reaches from -1 to 3 m");
  EXPECT_EQ(error_of([&] {
              TableSurface({0, 0}, {0, 1}, MatX::Zero(2, 2));
            }),
            "the grid lines of the table in x must increase: 0 m follows 0 m");
}

TEST(Surfaces, NodesOffTheSurfaceHangFromThoseOnIt) {
  Net net = chain(3, {0, 0, 0}, {3, 0, 0});
  net.on_surface = {false, true, false, false};
  const PlaneSurface plane(0.5, 0.5, 0);
  const Points nodes = solve_linear(net, Vec3(1, 1, 1), &plane);
  EXPECT_NEAR(nodes[1].z(), 1, 1e-15);
  EXPECT_NEAR(nodes[2].z(), 0.5, 1e-15);
}

TEST(ConstrainedForm, StressedLengthsOfALoadedPair) {
  ConstrainedNet problem = loaded_pair();
  problem.constraints = {{Kind::length, "cables", {0, 1}, {2.5}}};
  expect_loaded_pair(find_form(problem));
}

TEST(ConstrainedForm, UnstressedLengthsOfALoadedPair) {
  // 5 N stretch a cable of EA = 1000 N by 0.5 %.
  ConstrainedNet problem = loaded_pair();
  problem.axial_stiffness = VecX::Constant(2, 1000);
  problem.constraints = {{Kind::unstressed_length, "cables", {0, 1}, {2.5 / 1.005, 2.5 / 1.005}}};
  expect_loaded_pair(find_form(problem));
}

TEST(ConstrainedForm, ReactionsOfALoadedPair) {
  ConstrainedNet problem = loaded_pair();
  problem.constraints = {{Kind::reaction_x, "left", {1}, {-4}}, {Kind::reaction_z, "right", {2}, {3}}};
  expect_loaded_pair(find_form(problem));
}

TEST(ConstrainedForm, OneTensionAndOneLengthOfALoadedPair) {
  ConstrainedNet problem = loaded_pair();
  problem.constraints = {{Kind::tension, "left", {0}, {5}}, {Kind::length, "right", {1}, {2.5}}};
  expect_loaded_pair(find_form(problem));
}

TEST(ConstrainedForm, EqualTensionsMeetAt120Degrees) {
  // Torricelli's point; the one tension prescribed sets the level of all.
  ConstrainedNet problem;
  problem.net = star({{0, 0, 0}, {4, 0, 1}, {1, 3, 0}});
  problem.constraints = {{Kind::equal_tension, "net", {0, 1, 2}, {}}, {Kind::tension, "first", {0}, {7}}};
  const ConstrainedResult result = find_form(problem);
  ASSERT_TRUE(result.converged) << result.reason;
  EXPECT_LE((result.tension.array() - 7).abs().maxCoeff(), 1e-8);
  for (int i = 0; i < 3; ++i) {
    const Vec3 a = (problem.net.nodes[i + 1] - result.nodes[0]).normalized();
    const Vec3 b = (problem.net.nodes[(i + 1) % 3 + 1] - result.nodes[0]).normalized();
    EXPECT_NEAR(a.dot(b), -0.5, 1e-9);
  }
  EXPECT_EQ(result.n_rows, 4);
  EXPECT_EQ(result.rank, 3);  // two differences and one tension
}

TEST(ConstrainedForm, HeldForceDensityStays) {
  // T0 = T1 = 2 q0 q1 / (q0 + q1) for a straight cable of length 2: q1 = 15 and T = 12 give q0 = 10.
  ConstrainedNet problem;
  problem.net = star({{-1, 0, 0}, {1, 0, 0}});
  problem.force_density = Eigen::Vector2d(7, 15);
  problem.held = {false, true};
  problem.constraints = {{Kind::tension, "left", {0}, {12}}};
  const ConstrainedResult result = find_form(problem);
  ASSERT_TRUE(result.converged) << result.reason;
  EXPECT_LE((result.force_density - Eigen::Vector2d(10, 15)).norm(), 1e-8);
}

TEST(ConstrainedForm, BoundedForceDensityStopsAtItsBound) {
  // As above; unbounded both would become 12. With q1 <= 11: q0 = 132 / (22 - 12).
  ConstrainedNet problem;
  problem.net = star({{-1, 0, 0}, {1, 0, 0}});
  problem.constraints = {{Kind::tension, "left", {0}, {12}}};
  problem.upper = Eigen::Vector2d(nan, 11);
  const ConstrainedResult result = find_form(problem);
  ASSERT_TRUE(result.converged) << result.reason;
  EXPECT_LE((result.force_density - Eigen::Vector2d(13.2, 11)).norm(), 1e-8);
}

TEST(ConstrainedForm, BoundsThatForbidTheTargetAreReported) {
  // q0 <= 9 and q1 <= 9 allow 9 N at most.
  ConstrainedNet problem;
  problem.net = star({{-1, 0, 0}, {1, 0, 0}});
  problem.constraints = {{Kind::tension, "left", {0}, {12}}};
  problem.upper = Eigen::Vector2d(9, 9);
  const ConstrainedResult result = find_form(problem);
  EXPECT_FALSE(result.converged);
  EXPECT_TRUE(result.least_squares_optimum);
  EXPECT_NE(result.reason.find("tension of left, branch 1: 12 N wanted, 9 N found"), std::string::npos)
      << result.reason;
}

TEST(ConstrainedForm, LengthsShorterThanTheSupportsAreApartEndAtTheLeastSquares) {
  // L1 + L2 = 2; least ((L1 - 0.6) / 0.6)^2 + ((L2 - 1.2) / 1.2)^2: excesses 0.04 and 0.16.
  ConstrainedNet problem;
  problem.net = chain(2, {0, 0, 0}, {2, 0, 0});
  problem.constraints = {{Kind::length, "short", {0}, {0.6}}, {Kind::length, "long", {1}, {1.2}}};
  const ConstrainedResult result = find_form(problem);
  EXPECT_FALSE(result.converged);
  EXPECT_TRUE(result.least_squares_optimum);
  EXPECT_EQ(result.rank, 1);
  EXPECT_NEAR(result.length[0], 0.64, 1e-6);
  ASSERT_EQ(result.worst.size(), 2u);
  EXPECT_EQ(result.worst[0].constraint, "long");
  EXPECT_NE(result.reason.find("the lengths asked for between two fixed nodes, node 1 and node 3, add up to "
                               "1.8 m, but these are 2 m apart"),
            std::string::npos)
      << result.reason;
}

TEST(ConstrainedForm, JacobianIsTheDerivativeAndItsTransposeTheTranspose) {
  const Dish dish(3);
  Net net = triangular_net(3, 0.8, dish);
  net.load.assign(net.nodes.size(), Vec3(0.1, -0.2, -0.4));
  Net partly = net, otherwise = net, guided = net;
  partly.on_surface.assign(net.nodes.size(), false);
  for (std::size_t i = 0; i < net.nodes.size(); i += 2) partly.on_surface[i] = true;
  otherwise.on_surface = partly.on_surface;
  otherwise.on_surface.flip();
  for (std::size_t b = 0; b < net.branches.size(); b += 2)  // it does not matter where a branch begins
    for (Net* one : {&partly, &otherwise}) std::swap(one->branches[b][0], one->branches[b][1]);
  const int inner = static_cast<int>(net.nodes.size()) / 2;
  guided.guides = {{inner, Guide::Kind::line, Vec3(0.1, 0, 0), Vec3(1, 2, 3)},
                   {inner + 1, Guide::Kind::plane, Vec3(0, 0.7, 0), Vec3(1, -1, 3)}};
  const auto m = static_cast<Eigen::Index>(net.branches.size());
  const VecX EA = VecX::Constant(m, 300);
  const std::vector<Constraint> constraints{{Kind::tension, "a", {0, 5}, {3}},
                                            {Kind::length, "b", {1, 7}, {0.7}},
                                            {Kind::unstressed_length, "c", {2, 9}, {0.6, 0.7}},
                                            {Kind::equal_tension, "d", {10, 11, 12}, {}},
                                            {Kind::reaction_z, "e", {0, 1}, {1}},
                                            {Kind::reaction_x, "f", {2}, {1}}};
  const std::vector<std::pair<const Net*, const Surface*>> cases{
      {&net, nullptr}, {&net, &dish}, {&partly, &dish}, {&otherwise, &dish}, {&guided, nullptr}};
  for (const auto& [shape, surface] : cases) {
    NetSystem system(*shape, surface);
    const auto rows_at = [&](const VecX& q) {
      system.factorise(q);
      const NetState state = system.equilibrium(q);
      ConstraintRows rows;
      for (const auto& constraint : constraints) add_constraint(system, state, constraint, EA, 10, rows);
      return std::pair(state, rows);
    };
    const VecX q = VecX::LinSpaced(m, 3, 8), dq = (VecX::LinSpaced(m, 0, 40).array().sin()).matrix();
    const double h = 1e-5;
    const VecX difference =
        (rows_at(q - h * dq).second.missing() - rows_at(q + h * dq).second.missing()) / (2 * h);
    const auto [state, rows] = rows_at(q);
    const ConstraintJacobian G(system, state, rows);
    EXPECT_LE((G.apply(dq) - difference).norm(), 1e-8 * difference.norm());
    const VecX y = VecX::LinSpaced(G.rows(), -1, 2);
    EXPECT_NEAR(y.dot(G.apply(dq)), dq.dot(G.apply_transposed(y)), 1e-12);
  }
}

/// A hexagonal net with tensions in its inner branches and the lengths that another solution has next to its
/// edge: the mixture that conditions badly.
ConstrainedNet mixed_net(int rings) {
  ConstrainedNet problem;
  problem.net = triangular_net(rings, 0.5, Dish(6));
  problem.net.load.assign(problem.net.nodes.size(), Vec3(0, 0, -0.4));
  const auto m = static_cast<Eigen::Index>(problem.net.branches.size());
  VecX q(m);
  for (Eigen::Index b = 0; b < m; ++b) q[b] = 10 + 2 * std::sin(1.0 * static_cast<double>(b));
  const LinearForm known = find_linear_form(problem.net, q);
  Constraint tension{Kind::tension, "inner", {}, {}}, length{Kind::length, "edge", {}, {}};
  for (int b = 0; b < m; ++b) {
    const auto [i, j] = problem.net.branches[b];
    const bool edge = problem.net.fixed[i] || problem.net.fixed[j];
    Constraint& constraint = edge ? length : tension;
    constraint.members.push_back(b);
    constraint.value.push_back(edge ? known.length[b] : known.tension[b]);
  }
  problem.constraints = {tension, length};
  return problem;
}

TEST(ConstrainedForm, SparseAndDenseStepsFindTheSameShape) {
  const ConstrainedNet problem = mixed_net(4);
  ConstrainedOptions options;
  options.step_solver = StepSolver::dense;
  const ConstrainedResult dense = find_form(problem, options);
  options.step_solver = StepSolver::lsqr;
  const ConstrainedResult sparse = find_form(problem, options);
  ASSERT_TRUE(dense.converged) << dense.reason;
  ASSERT_TRUE(sparse.converged) << sparse.reason;
  EXPECT_EQ(dense.method, "dense");
  EXPECT_EQ(sparse.method, "lsqr");
  EXPECT_LE((dense.force_density - sparse.force_density).norm(), 1e-5 * dense.force_density.norm());
  EXPECT_LE((dense.nodes[30] - sparse.nodes[30]).norm(), 1e-8);
}

TEST(ConstrainedForm, ConditionIsThatOfTheDenseJacobian) {
  // A single node between two supports at distance 1 and q = (a, b): dT0/dq by hand, one row.
  ConstrainedNet problem;
  problem.net = star({{-1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}});
  problem.constraints = {{Kind::tension, "x", {0}, {10}}, {Kind::tension, "y", {2}, {5}}};
  problem.held = {true, false, true, false};
  // x = (q1 - q0) / s, y = (q2 - q3) / s with s the sum, at the start q = 10: dx/dq1 = 1/s, dy/dq3 = -1/s,
  // dx/dq3 = dy/dq1 = 0, hence diag(10/s / 10, 10/s / 5) in scaled rows: condition 4.
  ConstrainedOptions options;
  options.max_iterations = 0;
  EXPECT_NEAR(find_form(problem, options).condition_number, 4, 1e-12);
}

TEST(ConstrainedForm, InputThatMakesNoSenseIsNamed) {
  ConstrainedNet problem = loaded_pair();
  const auto with = [&](std::vector<Constraint> constraints) {
    problem.constraints = std::move(constraints);
    return error_of([&] { find_form(problem); });
  };
  EXPECT_EQ(with({{Kind::length, "ridge", {0}, {-3}}}), "length of ridge must be positive, not -3");
  EXPECT_EQ(with({{Kind::tension, "ridge", {}, {3}}}), "tension of ridge names no cable");
  EXPECT_EQ(with({{Kind::tension, "ridge", {4}, {3}}}), "tension of ridge names branch 5, but the net has 2");
  EXPECT_EQ(with({{Kind::length, "ridge", {0, 1}, {3, 3, 3}}}),
            "length of ridge has 2 members, but 3 values");
  EXPECT_EQ(with({{Kind::unstressed_length, "ridge", {0}, {3}}}),
            "unstressed length of ridge needs the axial stiffness of branch 1");
  EXPECT_EQ(with({{Kind::tension, "ridge", {0, 1}, {3}}, {Kind::tension, "valley", {1}, {4}}}),
            "tension of ridge and tension of valley both set the tension of branch 2");
  EXPECT_EQ(with({{Kind::reaction_x, "top", {0}, {1}}}),
            "reaction x of top: node 1 is free in that direction, where nothing reacts");
  problem.net.branches.push_back({1, 2});
  EXPECT_EQ(with({{Kind::length, "strut", {2}, {3}}}),
            "length of strut: branch 3 shall be 3 m long, but joins two fixed nodes, node 2 and node 3, "
            "which are 4 m "
            "apart");
}

TEST(ConstrainedForm, WantedAndFoundAreToldApart) {
  const auto told = [](double wanted, double found) {
    Deviation deviation;
    deviation.wanted = wanted;
    deviation.found = found;
    return wanted_and_found(deviation);
  };
  EXPECT_EQ(told(20, 19.25), "20 N wanted, 19.25 N found");
  EXPECT_EQ(told(110000, 109999.91), "110000 N wanted, 109999.9 N found");
  EXPECT_EQ(told(110000, 110000.0000004), "110000 N wanted, 110000.0000004 N found");
}

}  // namespace
}  // namespace tautline::formfinding
