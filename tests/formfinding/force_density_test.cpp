#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <cmath>
#include <formfinding/nets.hpp>
#include <limits>
#include <tautline/core/error.hpp>
#include <tautline/formfinding/force_density.hpp>

namespace tautline::formfinding {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(ForceDensity, SingleNodeIsTheWeightedMeanOfItsSupports) {
  // Sum of q_i (a_i - x) + f = 0, solved by hand.
  Net net = star({{0, 0, 0}, {4, 0, 0}, {0, 4, 2}});
  EXPECT_LE((solve_linear(net, Vec3(1, 2, 1))[0] - Vec3(2, 1, 0.5)).norm(), 1e-15);
  net.load = {{4, 0, -8}, Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  EXPECT_LE((solve_linear(net, Vec3(1, 2, 1))[0] - Vec3(3, 1, -1.5)).norm(), 1e-15);
}

TEST(ForceDensity, ChainUnderLoadSolvesTheTridiagonalSystem) {
  // Nodes 1 and 2 between 0 and 3; q = 1, 2, 1, load 10 down on node 1: 3 z1 - 2 z2 = -10, -2 z1 + 3 z2 = 0.
  Net net;
  net.nodes = {{0, 0, 0}, Vec3::Zero(), Vec3::Zero(), {3, 0, 0}};
  net.fixed = {true, false, false, true};
  net.branches = {{0, 1}, {2, 1}, {2, 3}};
  net.load = {Vec3::Zero(), {0, 0, -10}, Vec3::Zero(), Vec3::Zero()};
  const Points nodes = solve_linear(net, Vec3(1, 2, 1));
  EXPECT_NEAR(nodes[1].z(), -6, 1e-14);
  EXPECT_NEAR(nodes[2].z(), -4, 1e-14);
  EXPECT_NEAR(nodes[1].x(), 6.0 / 5, 1e-14);
  EXPECT_NEAR(nodes[2].x(), 9.0 / 5, 1e-14);
  EXPECT_EQ(nodes[3], net.nodes[3]);
}

TEST(ForceDensity, EqualDensitiesOnATriangularNetLieOnTheParaboloid) {
  // Six neighbours at distance s about any point: sum of z_j - z_i = 6 s^2 / 4f, hence the load 3 q s^2 / 2f.
  const double f = 6, s = 0.5, q = 7;
  const Dish dish(f);
  for (const int rings : {6, 12}) {
    Net net = triangular_net(rings, s, dish);
    net.load.assign(net.nodes.size(), Vec3(0, 0, -3 * q * s * s / (2 * f)));
    for (const Vec3& node : solve_linear(net, VecX::Constant(net.branches.size(), q)))
      EXPECT_NEAR(node.z(), dish.height(node.x(), node.y()), 1e-13);
  }
}

TEST(ForceDensity, ResidualOnTheSurfaceIsTheForceOfTheTies) {
  // Targets taken from the equal-density net: the ties must pull every free node down by 3 q s^2 / 2f.
  const double f = 6, s = 0.5, q = 7;
  const Dish dish(f);
  const Net net = triangular_net(4, s, dish);
  const Points nodes = solve_linear(net, VecX::Constant(net.branches.size(), q), &dish);
  VecX target(net.branches.size());
  for (std::size_t b = 0; b < net.branches.size(); ++b)
    target[b] = q * (nodes[net.branches[b][0]] - nodes[net.branches[b][1]]).norm();
  const ForceDensityResult result = find_tensions(net, target, &dish, {});
  ASSERT_TRUE(result.converged) << result.reason;
  for (std::size_t node = 0; node < nodes.size(); ++node) {
    EXPECT_LE((result.nodes[node] - nodes[node]).norm(), 1e-9);
    if (!net.fixed[node]) {
      EXPECT_NEAR(result.residual_z[node], -3 * q * s * s / (2 * f), 1e-8);
    }
  }
}

TEST(ForceDensity, TensionsInTheRatioThreeFourFiveMeetAtARightAngle) {
  // A free node in space, no surface: forces 3, 4, 5 N close a right triangle, whatever the lengths.
  const Mat3 turn = Eigen::AngleAxisd(0.9, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const Vec3 place(0.3, -0.2, 0.5);
  const Net net = star({place + 1.3 * turn.col(0), place + 0.7 * turn.col(1),
                        place - 2.1 * (0.6 * turn.col(0) + 0.8 * turn.col(1))});
  const ForceDensityResult result = find_tensions(net, Vec3(3, 4, 5), nullptr, {});
  ASSERT_TRUE(result.converged) << result.reason;
  EXPECT_LE((result.nodes[0] - place).norm(), 1e-9);
  EXPECT_LE((result.force_density - Vec3(3 / 1.3, 4 / 0.7, 5 / 2.1)).norm(), 1e-8);
  EXPECT_LE(result.out_of_balance, 1e-9);
}

TEST(ForceDensity, LoadOnTwoCablesHangsAtTheSineOfItsShare) {
  // Supports at x = +-a, load P, tension T: sin(angle) = P / 2T.
  const double a = 2, P = 6, T = 5;
  Net net = star({{-a, 0, 0}, {a, 0, 0}});
  net.load = {{0, 0, -P}, Vec3::Zero(), Vec3::Zero()};
  const ForceDensityResult result = find_tensions(net, Eigen::Vector2d(T, T), nullptr, {});
  ASSERT_TRUE(result.converged) << result.reason;
  EXPECT_LE((result.nodes[0] - Vec3(0, 0, -a * 0.75)).norm(), 1e-9);
}

TEST(ForceDensity, FreeBranchesChangeByTheStepOfSmallestNorm) {
  // Newton with the dense pseudo-inverse, its Jacobian from x = sum(q a) / sum(q):
  // dT_i/dq_j = delta_ij L_i - q_i (a_i - x).(a_j - x) / (L_i sum q).
  const Points supports{{1, 0, 0.2}, {0, 1.5, -0.1}, {-1, 0.1, 0}, {0.2, -1.2, 0.4}, {-0.4, 0.3, 2}};
  const std::vector<double> wanted{4, 5, 6};
  VecX q = VecX::Constant(5, 10);
  for (int k = 0; k < 30; ++k) {
    Eigen::Matrix<double, 3, 5> arms;
    for (int i = 0; i < 5; ++i) arms.col(i) = supports[i];
    const Vec3 x = arms * q / q.sum();
    arms.colwise() -= x;
    Mat<3, 5> J;
    Vec3 missing;
    for (int i = 0; i < 3; ++i) {
      const double L = arms.col(i).norm();
      missing[i] = wanted[i] - q[i] * L;
      J.row(i) = -q[i] / (L * q.sum()) * arms.col(i).transpose() * arms;
      J(i, i) += L;
    }
    q += J.jacobiSvd(Eigen::ComputeFullU | Eigen::ComputeFullV).solve(missing);
  }
  VecX target(5);
  target << 4, 5, 6, nan, nan;
  const ForceDensityResult result = find_tensions(star(supports), target, nullptr, {});
  ASSERT_TRUE(result.converged) << result.reason;
  EXPECT_LE((result.force_density - q).norm(), 1e-7);
  for (const double alpha : result.step_relaxation) EXPECT_EQ(alpha, 1);
}

TEST(ForceDensity, RankDeficientTensionsOfAStraightCableAreFound) {
  // Both halves of a straight cable always carry the same tension: the Jacobian has rank one.
  const Net net = star({{0, 0, 0}, {1, 0, 0}});
  const ForceDensityResult result = find_tensions(net, Eigen::Vector2d(10, 10), nullptr, {});
  ASSERT_TRUE(result.converged) << result.reason;
  EXPECT_LE((result.force_density - Eigen::Vector2d(20, 20)).norm(), 1e-8);
}

TEST(ForceDensity, ImpossibleTensionsEndWithAReasonAndNoException) {
  const Net net = star({{0, 0, 0}, {1, 0, 0}});
  const ForceDensityResult result = find_tensions(net, Eigen::Vector2d(10, 12), nullptr, {});
  EXPECT_FALSE(result.converged);
  EXPECT_NE(result.reason.find("largest tension error 1 N > 1.2e-09 N"), std::string::npos) << result.reason;
}

TEST(ForceDensity, WithoutFreeNodesTensionOverLengthIsTheDensity) {
  Net net;
  net.nodes = {{0, 0, 0}, {2, 0, 0}};
  net.fixed = {true, true};
  net.branches = {{0, 1}};
  const ForceDensityResult result = find_tensions(net, VecX::Constant(1, 5), nullptr, {});
  ASSERT_TRUE(result.converged);
  EXPECT_NEAR(result.force_density[0], 2.5, 1e-12);
}

TEST(ForceDensity, WithoutTargetsTheLinearShapeIsKept) {
  const Net net = star({{0, 0, 0}, {4, 0, 0}, {0, 4, 2}});
  const ForceDensityResult result = find_tensions(net, VecX::Constant(3, nan), nullptr, {});
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.iterations, 0);
  EXPECT_LE((result.nodes[0] - Vec3(4, 4, 2) / 3).norm(), 1e-15);
}

TEST(ForceDensity, EveryIterationIsRecordedAndReported) {
  const Net net = star({{1, 0, 0.2}, {0, 1.5, -0.1}, {-1, 0.1, 0}, {0.2, -1.2, 0.4}});
  std::vector<std::pair<int, double>> seen;
  const ForceDensityResult result = find_tensions(net, Eigen::Vector4d(4, 5, nan, nan), nullptr, {},
                                                  [&](int k, double error) { seen.emplace_back(k, error); });
  const auto n = static_cast<std::size_t>(result.iterations);
  ASSERT_GT(n, 1u);
  EXPECT_EQ(seen.size(), n);
  EXPECT_EQ(result.constraint_residual.size(), n + 1);
  EXPECT_EQ(result.constraint_residual_norm.size(), n + 1);
  EXPECT_EQ(result.coordinate_norm.size(), n);
  EXPECT_EQ(result.step_relaxation.size(), n);
  EXPECT_EQ(seen.back().second, result.constraint_residual.back());
  EXPECT_LE((result.coordinate_norm.back() - result.nodes[0].cwiseAbs()).norm(), 1e-15);
}

TEST(ForceDensity, StopsAfterTheIterationsAllowed) {
  ForceDensityOptions options;
  options.max_iterations = 1;
  const Net net = star({{1, 0, 0.2}, {0, 1.5, -0.1}, {-1, 0.1, 0}, {0.2, -1.2, 0.4}});
  const ForceDensityResult result = find_tensions(net, Eigen::Vector4d(4, 5, nan, nan), nullptr, options);
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.reason.rfind("stopped after 1 iteration", 0), 0u) << result.reason;
}

TEST(ForceDensity, NodeThatHangsOnNothingIsNamed) {
  Net net = star({{0, 0, 0}, {1, 0, 0}});
  net.nodes.resize(5, Vec3::Zero());
  net.fixed.resize(5, false);
  net.branches.push_back({3, 4});
  EXPECT_EQ(error_of([&] { solve_linear(net, Vec3(1, 1, 1)); }), "node 4 is not connected to any fixed node");
  EXPECT_EQ(error_of([&] { find_tensions(net, Vec3(1, 1, 1), nullptr, {}); }),
            "node 4 is not connected to any fixed node");
}

TEST(ForceDensity, NodeWhoseDensitiesCancelIsNamed) {
  const Net net = star({{0, 0, 0}, {1, 0, 0}});
  EXPECT_NE(error_of([&] { solve_linear(net, Eigen::Vector2d(1, -1)); }).find("around node 1 cancel"),
            std::string::npos);
}

TEST(ForceDensity, InputThatMakesNoSenseIsRefused) {
  const Net net = star({{0, 0, 0}, {1, 0, 0}});
  EXPECT_EQ(error_of([&] { find_tensions(net, Eigen::Vector2d(10, -1), nullptr, {}); }),
            "the target tension of branch 2 must be positive, not -1 N");
  EXPECT_EQ(error_of([&] { find_tensions(net, Vec3(1, 1, 1), nullptr, {}); }),
            "the net has 2 branches, but 3 target tensions");
  EXPECT_EQ(error_of([&] { solve_linear(net, Vec3(1, 1, 1)); }),
            "the net has 2 branches, but 3 force densities");
  Net broken = net;
  broken.branches[1] = {0, 7};
  EXPECT_EQ(error_of([&] { solve_linear(broken, Eigen::Vector2d(1, 1)); }),
            "branch 2 joins nodes 1 and 8, but the net has 3 nodes");
}

}  // namespace
}  // namespace tautline::formfinding
