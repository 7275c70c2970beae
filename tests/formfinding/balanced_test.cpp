#include <gtest/gtest.h>

#include <cmath>
#include <formfinding/nets.hpp>
#include <tautline/formfinding/balanced.hpp>
#include <tautline/formfinding/force_density.hpp>

namespace tautline::formfinding {
namespace {

/// One free node at the origin, branches to supports at distances 1, 2 along x and 1, 1 along y.
Net cross() {
  Net net = star({{1, 0, 0}, {-2, 0, 0}, {0, 1, 0}, {0, -1, 0}});
  net.nodes[0] = Vec3::Zero();
  return net;
}

VecX tensions(const Net& net, const VecX& q) {
  VecX t(q.size());
  for (Eigen::Index b = 0; b < q.size(); ++b) {
    const auto [i, j] = net.branches[static_cast<std::size_t>(b)];
    t[b] = q[b] * (net.nodes[j] - net.nodes[i]).norm();
  }
  return t;
}

TEST(BalancedNet, KeepsTensionsThatBalance) {
  const VecX wanted = (VecX(4) << 10, 10, 7, 7).finished();
  EXPECT_LE((tensions(cross(), balancing_force_densities(cross(), wanted)) - wanted).norm(), 1e-9);
}

TEST(BalancedNet, SharesADifferenceByLeastSquares) {
  // T_1 = T_2 = T least far from 10 and 20: (T/10 - 1)/10 + (T/20 - 1)/20 = 0 gives T = 12.
  const VecX wanted = (VecX(4) << 10, 20, 5, 5).finished();
  BalancedOptions options;
  options.balance_weight = 1e5;  // leaves 1e-10 of what is out of balance
  const VecX t = tensions(cross(), balancing_force_densities(cross(), wanted, {}, nullptr, options));
  EXPECT_NEAR(t[0], 12, 1e-7);
  EXPECT_NEAR(t[1], 12, 1e-7);
  EXPECT_NEAR(t[2], 5, 1e-7);
}

TEST(BalancedNet, LoadsAreCarried) {
  Net net = cross();
  net.load.assign(net.nodes.size(), Vec3::Zero());
  net.load[0] = Vec3(0, 3, 0);  // T_4 = T_3 + 3 about 10 each: 8.5 and 11.5
  BalancedOptions options;
  options.balance_weight = 1e5;
  const VecX t = tensions(net, balancing_force_densities(net, VecX::Constant(4, 10), {}, nullptr, options));
  EXPECT_NEAR(t[2], 8.5, 2e-6);
  EXPECT_NEAR(t[3], 11.5, 2e-6);
}

TEST(BalancedNet, HeldBranchesKeepWhatIsWanted) {
  const VecX wanted = (VecX(4) << 10, 20, 5, 5).finished();
  BalancedOptions options;
  options.balance_weight = 1e5;
  const VecX t = tensions(
      cross(), balancing_force_densities(cross(), wanted, {true, false, false, false}, nullptr, options));
  EXPECT_EQ(t[0], 10);
  EXPECT_NEAR(t[1], 10, 1e-6);
}

TEST(BalancedNet, NoBranchIsPressed) {
  Net net = star({{1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {2, 0, 0}});  // nothing pulls towards -x
  net.nodes[0] = Vec3::Zero();
  BalancedOptions options;
  options.least_part = 0.1;
  options.rounds = 1;
  const VecX t = tensions(net, balancing_force_densities(net, VecX::Constant(4, 10), {}, nullptr, options));
  EXPECT_NEAR(t[0], 1, 1e-12);
  EXPECT_NEAR(t[3], 1, 1e-12);
}

TEST(BalancedNet, StraightLinesInPlanStayWhereTheyAreDrawn) {
  // A lattice of straight lines is in balance in plan with one horizontal pull in all cords, wherever the
  // surface has them: the found net is the drawn one.
  const Dish dish(6);
  Net net = triangular_net(5, 0.5, dish);
  const Points flat = solve_linear(net, VecX::Constant(net.branches.size(), 10), &dish);
  net.nodes = flat;
  VecX wanted(net.branches.size());
  for (std::size_t b = 0; b < net.branches.size(); ++b) {
    const auto [i, j] = net.branches[b];
    const Vec3 u = flat[j] - flat[i];
    wanted[b] = 10 * u.norm() / u.head<2>().norm();
  }
  const VecX q = balancing_force_densities(net, wanted, {}, &dish);
  const Points found = solve_linear(net, q, &dish);
  for (std::size_t i = 0; i < flat.size(); ++i) EXPECT_LE((found[i] - flat[i]).norm(), 1e-12);
}

TEST(BalancedNet, WhatMakesNoSenseIsRefused) {
  EXPECT_THROW(balancing_force_densities(cross(), VecX::Zero(4)), ModelError);
  Net point = cross();
  point.nodes[0] = point.nodes[1];
  EXPECT_THROW(balancing_force_densities(point, VecX::Ones(4)), ModelError);
  Net guided = cross();
  guided.guides.push_back({0, GuideKind::line, Vec3::Zero(), Vec3::UnitX()});
  EXPECT_THROW(balancing_force_densities(guided, VecX::Ones(4)), ModelError);
}

}  // namespace
}  // namespace tautline::formfinding
