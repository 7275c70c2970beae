#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <tautline/formfinding/self_stress.hpp>

namespace tautline::formfinding {
namespace {

using std::numbers::pi;

/// A net with its members named by what they are.
struct Structure {
  Net net;
  SelfStressWish wish;

  int node(const Vec3& at) {
    net.nodes.push_back(at);
    net.fixed.push_back(false);
    return static_cast<int>(net.nodes.size()) - 1;
  }
  int member(int i, int j, bool cable) {
    net.branches.push_back({i, j});
    wish.pulls_only.push_back(cable);
    return static_cast<int>(net.branches.size()) - 1;
  }
  /// Turned about a skew axis, moved and scaled: nothing may depend on where a structure is drawn.
  Structure moved(double scale) const {
    const Mat3 turn = Eigen::AngleAxisd(1.1, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
    Structure result = *this;
    for (Vec3& at : result.net.nodes) at = scale * (turn * at) + scale * Vec3(7, -3, 11);
    return result;
  }
  double force_density(const SelfStressResult& found, int b) const {
    const auto [i, j] = net.branches[static_cast<std::size_t>(b)];
    return found.tension[b] /
           (net.nodes[static_cast<std::size_t>(j)] - net.nodes[static_cast<std::size_t>(i)]).norm();
  }
};

/// Two triangles of radius 1 at distance h: sides pull, struts push; the twist is that from the foot of a
/// side cable to its head.
Structure prism(double twist, double h) {
  Structure s;
  for (int k = 0; k < 6; ++k) {
    const double angle = 2 * pi * (k % 3) / 3 + (k < 3 ? 0 : twist);
    s.node(Vec3(std::cos(angle), std::sin(angle), k < 3 ? 0 : h));
  }
  for (int k = 0; k < 3; ++k) s.member(k, (k + 1) % 3, true);
  for (int k = 0; k < 3; ++k) s.member(3 + k, 3 + (k + 1) % 3, true);
  for (int k = 0; k < 3; ++k) s.member(k, 3 + k, true);
  for (int k = 0; k < 3; ++k) s.member(k, 3 + (k + 1) % 3, false);
  s.wish.group = {{6, 7, 8}};
  s.wish.tension = {1000};
  return s;
}

TEST(SelfStress, TriangularPrismAtThirtyDegrees) {
  for (const double scale : {1.0, 1e-3, 1e4}) {
    const auto s = prism(pi / 6, 1.7).moved(scale);
    const auto found = find_self_stress(s.net, s.wish);
    EXPECT_EQ(found.states, 1);
    EXPECT_EQ(found.mechanisms, 1);
    EXPECT_EQ(found.rigid, 6);
    ASSERT_TRUE(found.found);
    EXPECT_TRUE(found.stable);
    const double side = s.force_density(found, 6);
    EXPECT_NEAR(found.tension[6], 1000, 1e-8);
    for (int b = 0; b < 6; ++b) EXPECT_NEAR(s.force_density(found, b) / side, 1 / std::sqrt(3), 1e-10);
    for (int b = 9; b < 12; ++b) EXPECT_NEAR(s.force_density(found, b) / side, -1, 1e-10);
    EXPECT_LT(found.out_of_balance, 1e-9 * 1000);
  }
}

TEST(SelfStress, PrismOffItsTwistHasNone) {
  const auto s = prism(pi / 6 + pi / 180, 1.7);
  const auto found = find_self_stress(s.net, s.wish);
  EXPECT_EQ(found.states, 0);
  EXPECT_EQ(found.mechanisms, 0);
  EXPECT_FALSE(found.found);
  EXPECT_GT(found.smallest, 1e-4);
  const auto near = find_self_stress(prism(pi / 6 + pi / 1800, 1.7).net, s.wish);
  EXPECT_NEAR(found.smallest / near.smallest, 10, 0.2);  // it vanishes with the distance from the twist
}

/// The other twist at which there is a state, that of the mirror image, presses the sides.
TEST(SelfStress, PrismTwistedTheOtherWayPushesItsCables) {
  const auto s = prism(pi / 6 + pi, 1.7);
  const auto found = find_self_stress(s.net, s.wish);
  EXPECT_EQ(found.states, 1);
  EXPECT_FALSE(found.found);
  EXPECT_EQ(found.wrong.size(), 6U);
}

TEST(SelfStress, ExpandedOctahedron) {
  Structure s;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-0.5, 0.5})
      for (const double end : {-1.0, 1.0}) {
        Vec3 at = Vec3::Zero();
        at[axis] = end;
        at[(axis + 2) % 3] = side;
        s.node(at);
      }
  for (int i = 0; i < 12; i += 2) s.member(i, i + 1, false);
  for (int i = 0; i < 12; ++i)
    for (int j = i + 1; j < 12; ++j)
      if (std::abs(
              (s.net.nodes[static_cast<std::size_t>(i)] - s.net.nodes[static_cast<std::size_t>(j)]).norm() -
              std::sqrt(1.5)) < 1e-12)
        s.member(i, j, true);
  ASSERT_EQ(s.net.branches.size(), 30U);  // struts over cables 2 / sqrt(1.5) = 1.63299
  const auto found = find_self_stress(s.moved(3).net, s.wish);
  EXPECT_EQ(found.states, 1);
  EXPECT_EQ(found.mechanisms, 1);
  EXPECT_EQ(found.rigid, 6);
  ASSERT_TRUE(found.found);
  EXPECT_TRUE(found.stable);
  EXPECT_FALSE(found.scaled);
  for (int b = 0; b < 6; ++b) EXPECT_NEAR(found.tension[b], -std::sqrt(6), 1e-10);
  for (int b = 6; b < 30; ++b) EXPECT_NEAR(found.tension[b], 1, 1e-10);
}

/// Edges that pull keep the square plane, diagonals that pull let it fold.
TEST(SelfStress, SquareWithDiagonals) {
  for (const bool edges_pull : {true, false}) {
    Structure s;
    for (int k = 0; k < 4; ++k) s.node(Vec3(k == 1 || k == 2 ? 2 : 0, k > 1 ? 2 : 0, 0));
    for (int k = 0; k < 4; ++k) s.member(k, (k + 1) % 4, edges_pull);
    s.member(0, 2, !edges_pull);
    s.member(1, 3, !edges_pull);
    s.wish.group = {{0, 1, 2, 3}};
    s.wish.tension = {edges_pull ? 50.0 : -50.0};
    const auto found = find_self_stress(s.moved(1).net, s.wish);
    EXPECT_EQ(found.states, 1);
    EXPECT_EQ(found.mechanisms, 1);
    ASSERT_TRUE(found.found);
    const double sign = edges_pull ? 1 : -1;
    for (int b = 0; b < 4; ++b) EXPECT_NEAR(found.tension[b], sign * 50, 1e-9);
    for (int b = 4; b < 6; ++b) EXPECT_NEAR(found.tension[b], -sign * 50 * std::sqrt(2), 1e-9);
    EXPECT_EQ(found.stable, edges_pull);
    // Corners up and down in turn by 1/2: 4 edges of force density 25 N/m.
    EXPECT_NEAR(found.least_stiffness, sign * 4 * 25, 1e-8);
  }
}

/// Rim of 12 bars, two hub nodes with an axle, upper and lower spokes.
TEST(SelfStress, SpokeWheel) {
  constexpr int n = 12;
  constexpr double radius = 5, half = 0.8, tension = 2000;
  Structure s;
  for (int k = 0; k < n; ++k) s.node(radius * Vec3(std::cos(2 * pi * k / n), std::sin(2 * pi * k / n), 0));
  const int top = s.node(Vec3(0, 0, half)), bottom = s.node(Vec3(0, 0, -half));
  for (int k = 0; k < n; ++k) s.member(k, (k + 1) % n, false);
  for (int k = 0; k < n; ++k) s.member(k, top, true);
  for (int k = 0; k < n; ++k) s.member(k, bottom, true);
  s.member(top, bottom, false);
  s.wish.group.emplace_back();
  for (int b = n; b < 3 * n; ++b) s.wish.group.back().push_back(b);
  s.wish.tension = {tension};
  const auto found = find_self_stress(s.moved(1).net, s.wish);
  ASSERT_TRUE(found.found);
  const double length = std::hypot(radius, half);
  for (int b = n; b < 3 * n; ++b) EXPECT_NEAR(found.tension[b], tension, 1e-6);
  for (int b = 0; b < n; ++b)
    EXPECT_NEAR(found.tension[b], -2 * tension * radius / length / (2 * std::sin(pi / n)), 1e-6);
  EXPECT_NEAR(found.tension[3 * n], -n * tension * half / length, 1e-6);
}

/// A plane net of straight cables between fixed ends: each line a state, each crossing a mechanism across the
/// plane and, within it, none; the sparse way finds what singular values find.
TEST(SelfStress, PlaneNetBySparseFactors) {
  constexpr int n = 9;
  Structure s;
  for (int i = 0; i <= n + 1; ++i)
    for (int j = 0; j <= n + 1; ++j) s.node(Vec3(i, 1.3 * j, 0));
  const auto at = [&](int i, int j) { return i * (n + 2) + j; };
  for (int i = 0; i <= n + 1; ++i)
    for (int j = 0; j <= n + 1; ++j)
      s.net.fixed[static_cast<std::size_t>(at(i, j))] = i == 0 || j == 0 || i == n + 1 || j == n + 1;
  for (int i = 1; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      s.member(at(i, j), at(i, j + 1), true);
      s.member(at(j, i), at(j + 1, i), true);
    }
  for (const int dense_limit : {1000, 0}) {
    const auto found = find_self_stress(s.net, s.wish, {1e-6, dense_limit});
    EXPECT_EQ(found.states, 2 * n);
    EXPECT_EQ(found.mechanisms, n * n);
    EXPECT_EQ(found.rigid, 0);
    ASSERT_TRUE(found.found);
    EXPECT_TRUE(found.stable);
    for (int b = 0; b < found.tension.size(); ++b) EXPECT_NEAR(found.tension[b], 1, 1e-9);
    // Force densities 1 N over 1 m and over 1.3 m on a square of n crossings.
    const double least = 4 * std::pow(std::sin(pi / (2 * (n + 1))), 2) * (1 + 1 / 1.3);
    EXPECT_NEAR(found.least_stiffness, least, 1e-9);
  }
}

/// Three cables from a node to three fixed ones in its plane on one side: some would have to push.
TEST(SelfStress, CablesToOneSideWouldHaveToPush) {
  Structure s;
  s.node(Vec3::Zero());
  for (const Vec3& end : {Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}) {
    s.net.fixed[static_cast<std::size_t>(s.node(end))] = true;
    s.member(0, static_cast<int>(s.net.nodes.size()) - 1, true);
  }
  const auto found = find_self_stress(s.net, s.wish);
  EXPECT_EQ(found.states, 1);
  EXPECT_FALSE(found.found);
  EXPECT_FALSE(found.wrong.empty());
}

/// A state with a member that no state can stress; and one more state, of bars alone, that stays out of it.
TEST(SelfStress, LooseMemberAndBarsBeside) {
  Structure s;
  for (int k = 0; k < 4; ++k) s.node(Vec3(k == 1 || k == 2 ? 2 : 0, k > 1 ? 2 : 0, 0));
  for (int k = 0; k < 4; ++k) s.member(k, (k + 1) % 4, true);
  s.member(0, 2, false);
  s.member(1, 3, false);
  const int loose = s.member(0, s.node(Vec3(-1, -1, 0)), true);
  const int first = s.node(Vec3(10, 0, 0));
  for (const Vec3& more : {Vec3(12, 0, 0), Vec3(12, 2, 0), Vec3(10, 2, 0)}) s.node(more);
  const int bar = s.member(first, first + 1, false);
  for (int k = 1; k < 4; ++k) s.member(first + k, first + (k + 1) % 4, false);
  s.member(first, first + 2, false);
  s.member(first + 1, first + 3, false);
  s.wish.group = {{0, 1, 2, 3}};
  s.wish.tension = {50};
  const auto found = find_self_stress(s.net, s.wish);
  EXPECT_EQ(found.states, 2);
  ASSERT_TRUE(found.found);
  EXPECT_EQ(found.unstressed, std::vector<int>{loose});
  EXPECT_NEAR(found.tension[0], 50, 1e-9);
  EXPECT_NEAR(found.tension[bar], 0, 1e-9);
}

}  // namespace
}  // namespace tautline::formfinding
