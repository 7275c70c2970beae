// Demands that contradict each other: the net with the least weighted squares, against scipy.optimize on the
// same nets (least_squares over the force densities, equilibrium solved inside) and against statics by hand.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <formfinding/nets.hpp>
#include <limits>
#include <map>
#include <tautline/formfinding/constraints.hpp>
#include <tautline/formfinding/force_density.hpp>

namespace tautline::formfinding {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
using Kind = ConstraintKind;

/// 4 x 4 nodes without the corners, the outer eight fixed on a saddle: 12 branches.
Net small_saddle() {
  Net net;
  std::map<std::pair<int, int>, int> index;
  const auto outer = [](int i) { return i == 0 || i == 3; };
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      if (outer(i) && outer(j)) continue;
      const double x = i - 1.5, y = j - 1.5;
      index[{i, j}] = static_cast<int>(net.nodes.size());
      net.nodes.emplace_back(x, y, 0.3 * x * x - 0.25 * y * y + 0.1 * i);
      net.fixed.push_back(outer(i) || outer(j));
    }
  for (const auto& [place, node] : index)
    for (const auto& step : {std::pair{1, 0}, std::pair{0, 1}}) {
      const auto other = index.find({place.first + step.first, place.second + step.second});
      if (other != index.end() && !(net.fixed[node] && net.fixed[other->second]))
        net.branches.push_back({node, other->second});
    }
  return net;
}

std::vector<int> range(int first, int last) {
  std::vector<int> members;
  for (int b = first; b < last; ++b) members.push_back(b);
  return members;
}

Constraint demand(Kind kind, std::vector<int> members, double value, double weight = 1) {
  return {kind, "all", std::move(members), {value}, {}, {}, weight};
}

/// Every branch 100 N and, four times as important, 0.8 m long.
ConstrainedNet tense_and_short() {
  ConstrainedNet problem;
  problem.net = small_saddle();
  problem.constraints = {demand(Kind::tension, range(0, 12), 100),
                         demand(Kind::length, range(0, 12), 0.8, 4)};
  problem.force_density = VecX::Constant(12, 80);
  return problem;
}

VecX vector_of(const std::vector<double>& values) {
  return Eigen::Map<const VecX>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// scipy's last digits depend on its finite differences: 1e-6 of a force density, 1e-10 of the squares.
void expect_least(const ConstrainedResult& found, double squares, const std::vector<double>& force_density) {
  EXPECT_FALSE(found.converged);
  EXPECT_TRUE(found.in_balance);
  EXPECT_TRUE(found.least_squares_optimum) << found.reason;
  EXPECT_NEAR(found.weighted_squares, squares, 1e-10 * squares);
  EXPECT_LE((found.force_density - vector_of(force_density)).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_LE(found.out_of_balance, 1e-9 * found.tension.maxCoeff());
}

TEST(Compromise, WeightsTensionsAgainstLengths) {
  expect_least(find_form(tense_and_short()), 6.877454780657037,
               {90.60422015, 90.60421882, 94.60031435, 83.76194962, 84.35914103, 83.76194797, 94.60031753,
                92.35269526, 96.35431789, 82.65607091, 96.35431867, 92.35269256});
}

TEST(Compromise, StaysWithinBounds) {
  ConstrainedNet problem = tense_and_short();
  problem.lower = VecX::Constant(12, 84);
  problem.upper = VecX::Constant(12, 90);
  expect_least(find_form(problem), 6.916147770470157, {90, 90, 90, 84, 84, 84, 90, 90, 90, 84, 90, 90});
}

TEST(Compromise, SoftBoundsCountOnlyWhereTheyAreCrossed) {
  ConstrainedNet problem = tense_and_short();
  problem.constraints[1] = {Kind::length, "short", range(0, 12), {}, {}, 1.05, 9};
  expect_least(find_form(problem), 0.3866833366361714,
               {89.31727284, 89.31727187, 96.22291537, 80.47531749, 81.45593628, 80.47531708, 96.22291483,
                93.18903024, 100.45646509, 78.04664572, 100.45646516, 93.18902983});
}

TEST(Compromise, SoftBoundsThatHoldAskForNothing) {
  ConstrainedNet problem = tense_and_short();
  problem.constraints[1] = {Kind::length, "short", range(0, 12), {}, 0.1, 5.0, 9};
  const ConstrainedResult found = find_form(problem);
  EXPECT_TRUE(found.converged) << found.reason;
  EXPECT_LE((found.tension.array() - 100).abs().maxCoeff(), 1e-7);
}

TEST(Compromise, MixesTensionsEqualTensionsUnstressedLengthsAndReactions) {
  ConstrainedNet problem = tense_and_short();
  problem.axial_stiffness = VecX::Constant(12, 2000);
  problem.constraints = {demand(Kind::tension, range(0, 4), 100),
                         {Kind::equal_tension, "equal", range(4, 8), {}},
                         demand(Kind::unstressed_length, range(0, 12), 0.9),
                         demand(Kind::reaction_z, {problem.net.branches[0][0]}, 20, 5)};
  expect_least(find_form(problem), 0.46515669197003195,
               {75.04217329, 94.93380367, 85.10189483, 97.95061523, 82.25221522, 84.76698843, 82.3175453,
                80.17931369, 119.27758721, 67.68034808, 104.16837035, 92.96477375});
}

TEST(Compromise, IsTheSameInOtherUnitsAndAnyOrientation) {
  const ConstrainedResult first = find_form(tense_and_short());
  ConstrainedNet problem = tense_and_short();
  const Mat3 turn = (Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized())).toRotationMatrix();
  for (Vec3& node : problem.net.nodes) node = 1000 * (turn * node) + Vec3(5e3, -2e3, 1e3);  // mm
  problem.constraints[0].value = {0.1};                                                     // kN
  problem.constraints[1].value = {800};
  problem.force_density *= 1e-6;
  const ConstrainedResult other = find_form(problem);
  EXPECT_TRUE(other.least_squares_optimum);
  EXPECT_NEAR(other.weighted_squares, first.weighted_squares, 1e-9 * first.weighted_squares);
  EXPECT_LE((other.force_density * 1e6 - first.force_density).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(Compromise, NoSmallChangeOfForceDensitiesLowersTheSquares) {
  const ConstrainedNet problem = tense_and_short();
  const ConstrainedResult found = find_form(problem);
  const auto squares = [&](const VecX& q) {
    const LinearForm form = find_linear_form(problem.net, q);
    return (form.tension.array() / 100 - 1).square().sum() +
           4 * (form.length.array() / 0.8 - 1).square().sum();
  };
  const double least = squares(found.force_density);
  for (int b = 0; b < 12; ++b)
    for (const double change : {-0.1, 0.1}) {
      VecX q = found.force_density;
      q[b] += change;
      EXPECT_GT(squares(q), least);
    }
}

TEST(Compromise, NamesTheConstraintsByWhatTheyMiss) {
  const ConstrainedResult found = find_form(tense_and_short());
  ASSERT_EQ(found.misses.size(), 2u);
  EXPECT_EQ(found.misses[0].kind, Kind::length);
  EXPECT_EQ(found.misses[0].members, 12);
  EXPECT_EQ(found.misses[0].missed, 12);
  EXPECT_NEAR(found.misses[0].worst.found, 1.15183905, 1e-6);
  EXPECT_GT(found.misses[0].rms, found.misses[1].rms);
}

/// Spoke wheel of n spokes: outer nodes fixed in a circle of 15 m in the plane z = 0, inner rings of 4 m at
/// z = 2 and -2 with masts between. Branches: upper spokes, lower spokes, upper ring, lower ring, masts.
Net wheel(int n) {
  Net net;
  const auto ring = [&](double radius, double z, bool fixed) {
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * M_PI * i / n;
      net.nodes.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
      net.fixed.push_back(fixed);
    }
  };
  ring(15, 0, true);
  ring(4, 2, false);
  ring(4, -2, false);
  for (int k = 1; k <= 2; ++k)
    for (int i = 0; i < n; ++i) net.branches.push_back({i, k * n + i});
  for (int k = 1; k <= 2; ++k)
    for (int i = 0; i < n; ++i) net.branches.push_back({k * n + i, k * n + (i + 1) % n});
  for (int i = 0; i < n; ++i) net.branches.push_back({n + i, 2 * n + i});
  return net;
}

/// @param[in] masts  tension asked of them [N]
ConstrainedNet asked_wheel(int n, double masts) {
  ConstrainedNet problem;
  problem.net = wheel(n);
  problem.constraints = {{Kind::tension, "spokes", range(0, 2 * n), {60000}},
                         {Kind::tension, "rings", range(2 * n, 4 * n), {110000}}};
  if (masts != 0) problem.constraints.push_back({Kind::tension, "masts", range(4 * n, 5 * n), {masts}});
  problem.force_density = VecX::Constant(5 * n, 5000);
  problem.force_density.tail(n).setConstant(-5000);
  return problem;
}

// Equilibrium of an inner node needs T_spoke^2 = (2 T_ring sin(pi/n))^2 + T_mast^2 whatever the height. Least
// squares under this condition by scipy.optimize.minimize. With their force densities held the wheel may
// stand at any height, so that a search over force densities alone finds it flat, its rings fallen on each
// other.
TEST(Compromise, SpokeWheelStandsWhereForceDensitiesAloneLetItFall) {
  const ConstrainedResult found = find_form(asked_wheel(12, -20000));
  EXPECT_TRUE(found.least_squares_optimum) << found.reason;
  EXPECT_NEAR(found.weighted_squares, 0.0004485823769636572, 1e-12);
  EXPECT_NEAR(found.tension[0], 60191.972102596184, 1e-2);
  EXPECT_NEAR(found.tension[30], 109684.9482731, 1e-2);
  EXPECT_NEAR(found.tension[50], -19985.83522066, 1e-2);
  EXPECT_GT(found.length[50], 1);
}

TEST(Compromise, SpokeWheelOfFittingTensionsIsMet) {
  const double ring = 2 * 110000 * std::sin(M_PI / 12);
  const ConstrainedResult found = find_form(asked_wheel(12, -std::sqrt(60000.0 * 60000 - ring * ring)));
  EXPECT_TRUE(found.converged) << found.reason;
  EXPECT_GT(found.length[50], 1);
}

TEST(Compromise, LengthsThatCannotReachUseTheWholeOfTheirFreedom) {
  // Two links of 1 and 2 m between supports 4 m apart: excesses as the squares of the lengths over the
  // weights.
  ConstrainedNet problem;
  problem.net = chain(2, {0, 0, 0}, {4, 0, 0});
  problem.constraints = {demand(Kind::length, {0}, 1, 3), demand(Kind::length, {1}, 2)};
  const ConstrainedResult found = find_form(problem);
  EXPECT_TRUE(found.least_squares_optimum);
  EXPECT_NEAR(found.length[0], 1 + 1.0 / (1 + 4 * 3), 1e-7);
  ASSERT_TRUE(found.short_path);
  EXPECT_NEAR(found.short_path->length, 3, 1e-12);
}

TEST(Compromise, CablesDoNotPushForTheSakeOfADemand) {
  // A node between four points, lifted by 200 N. With 100 N at its sides and 50 N below, the upper member
  // would push with 150 N; as a cable it carries nothing, and the three others share what is missing.
  ConstrainedNet problem;
  problem.net = star({{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}});
  problem.net.load = {{0, 200, 0}, Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  problem.constraints = {{Kind::tension, "sides", {0, 1}, {100}},
                         {Kind::tension, "lower", {2}, {50}},
                         {Kind::length, "lower", {2}, {1}}};
  problem.pulls = {true, true, true, true};
  const ConstrainedResult found = find_form(problem);
  EXPECT_FALSE(found.converged);
  EXPECT_TRUE(found.in_balance);
  EXPECT_GE(found.force_density.minCoeff(), 0);
  EXPECT_NEAR(found.weighted_squares, 0.6206935590509,
              1e-9);  // scipy.optimize.minimize, four force densities >= 0
}

TEST(Compromise, AWeightMustBePositive) {
  ConstrainedNet problem = tense_and_short();
  problem.constraints[1].weight = 0;
  EXPECT_NE(error_of([&] { find_form(problem); }).find("the weight of length of all must be positive"),
            std::string::npos);
}

}  // namespace
}  // namespace tautline::formfinding
