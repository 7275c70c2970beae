#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "assembly/dense.hpp"
#include "assembly/models.hpp"

namespace tautline::assembly {
namespace {

using namespace testing_models;
using std::numbers::pi;

element::BeamSection rod() {
  return {1e6, 2e3, 3e3, 1e3, 0, 0, 2, 0, 0};
}

/// A beam 0-1, and a beam 2-3 that hangs on node 1 by `link` at node 2.
model::Model two_beams(const Vec3& arm, model::Link link) {
  model::Model model;
  model.nodes = {{0, 0, 0}, {1, 0, 0}, Vec3(1, 0, 0) + arm, Vec3(2, 0.3, 0.1) + arm};
  const int group = add_beam_group(model, "rod");
  model.groups[group].beam = rod();
  add_beam(model, group, 0, 1);
  add_beam(model, group, 2, 3);
  link.leader = 1;
  link.follower = 2;
  model.links.push_back(link);
  return model;
}

/// A state that the links allow, up to `size` metres and radians away.
model::State moved_state(const System& system, double size = 0.2) {
  return system.kinematics().moved(model::State::reference(system.model()), some_increments(system, size));
}

/// With dead loads and pressure present.
void expect_consistent_tangent(model::Model model, const Boundary& boundary, double size = 0.2) {
  System system(std::move(model));
  system.begin_stage(boundary);
  system.set_lambda(1);
  system.set_state(moved_state(system, size));
  expect_tangent_is_derivative_of_residual(system);
}

Boundary clamped_with_loads() {
  return {{support({0}, clamped)}, {load(3, {30, -20, 50}, {0, 0, 0}), load(2, {10, 40, -20}, {0, 0, 0})}};
}

TEST(Links, TangentOfARigidArmIsTheDerivativeOfTheResidual) {
  expect_consistent_tangent(two_beams({0.2, 0.5, -0.3}, {}), clamped_with_loads());
}

TEST(Links, TangentOfABallJointAtTheEndOfAnArmIsTheDerivativeOfTheResidual) {
  model::Link ball;
  ball.rotation_free = true;
  expect_consistent_tangent(two_beams({0.2, 0.5, -0.3}, ball), clamped_with_loads());
}

TEST(Links, TangentOfAHingeIsTheDerivativeOfTheResidual) {
  model::Link hinge;
  hinge.hinge = {Vec3(0.6, 0, 0.8)};
  expect_consistent_tangent(two_beams({0, 0, 0}, hinge), clamped_with_loads());
}

TEST(Links, TangentOfAUniversalJointOnAnArmIsTheDerivativeOfTheResidual) {
  model::Link joint;
  joint.hinge = {Vec3(0, 1, 0), Vec3(0, 0, 1)};
  expect_consistent_tangent(two_beams({0.1, 0.2, 0.3}, joint), clamped_with_loads());
}

/// A moment whose direction stays does work on turns about axes that turn with others.
TEST(Links, TangentOfADeadMomentBehindAUniversalJointIsTheDerivativeOfTheResidual) {
  model::Link joint;
  joint.hinge = {Vec3(0, 1, 0), Vec3(0, 0, 1)};
  expect_consistent_tangent(two_beams({0.1, 0.2, 0.3}, joint),
                            {{support({0}, clamped)}, {load(2, Vec3::Zero(), {300, -200, 500})}});
}

TEST(Links, TangentOfAChainIsTheDerivativeOfTheResidual) {
  model::Link hinge;
  hinge.hinge = {Vec3(0, 1, 0)};
  auto model = two_beams({0.1, 0.2, 0.3}, hinge);
  model.nodes.emplace_back(1.5, 0.9, 0.4);  // node 4, rigid on node 2, carries a beam to node 5
  model.nodes.emplace_back(1.9, 1.6, 0.2);
  add_beam(model, 0, 4, 5);
  model.links.push_back({2, 4, false, {}, -1});
  auto boundary = clamped_with_loads();
  boundary.loads.push_back(load(5, {5, 10, -15}));
  boundary.loads.push_back(load(4, {-15, 10, 5}));
  expect_consistent_tangent(model, boundary);
}

TEST(Links, AFollowerStaysAtItsPlaceOnTheLeader) {
  System system(two_beams({0.2, 0.5, -0.3}, {}));
  const auto state = moved_state(system);
  const Vec3 arm = Vec3(0.2, 0.5, -0.3);
  const auto x = model::positions(system.model(), state);
  EXPECT_LT((x[2] - x[1] - state.rotation[1] * arm).norm(), 1e-15);
  EXPECT_LT((state.rotation[2] - state.rotation[1]).norm(), 1e-15);
}

TEST(Links, AHingeKeepsItsAxisInBothParts) {
  model::Link hinge;
  const Vec3 axis(0.6, 0, 0.8);
  hinge.hinge = {axis};
  System system(two_beams({0, 0, 0}, hinge));
  const auto state = moved_state(system);
  EXPECT_LT((state.rotation[2] * axis - state.rotation[1] * axis).norm(), 1e-15);
  EXPECT_GT((state.rotation[2] - state.rotation[1]).norm(), 0.05);
}

TEST(Links, ALoadOnAnArmReachesTheSupportWithItsMoment) {
  System system(two_beams({0, 0.5, 0}, {}));
  Boundary boundary{{support({0}, clamped)}, {load(2, {0, 0, 3})}};
  solve(system, boundary);
  const auto reactions = system.reactions();
  const auto x = model::positions(system.model(), system.state());
  EXPECT_LT((reactions.force[0] + Vec3(0, 0, 3)).norm(), 1e-9);
  EXPECT_LT((reactions.moment[0] + x[2].cross(Vec3(0, 0, 3))).norm(), 1e-8);
}

TEST(Links, RingsAreRefused) {
  auto model = two_beams({0, 0, 1}, {});
  model.links.push_back({2, 1, false, {}, -1});
  EXPECT_THROW(model::links_in_order(model), ModelError);
}

/// Beams, a facet and a cable in space, tied to each other at random by arms, ball joints, hinges, linear
/// constraints and a cyclic pair; loads on every node and pressure on the facet.
struct Tied {
  model::Model model;
  Boundary boundary;
};

Tied tied_at_random(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  const auto vector = [&] { return Vec3(any(random), any(random), any(random)); };
  constexpr int n_beams = 5, n_nodes = 2 * n_beams + 3;
  Tied result;
  auto& model = result.model;
  for (int i = 0; i < n_nodes; ++i)
    model.nodes.push_back(Vec3(2.0 * (i / 2), 1.5 * (i % 2), 0) + 0.4 * vector());
  std::vector<bool> follows(n_nodes, false);
  for (int beam = 1; beam < n_beams; ++beam) {  // each hangs on one before it
    if (below(4) == 0) continue;
    model::Link link{below(2 * beam), 2 * beam + below(2), false, {}, 0};
    const int kind = below(4);
    link.rotation_free = kind == 1;
    for (int axis = 2; axis <= kind; ++axis) link.hinge.push_back(vector().normalized());
    if (below(2) == 0) model.nodes[link.follower] = model.nodes[link.leader];
    follows[link.follower] = true;
    model.links.push_back(link);
  }
  const int rods = add_beam_group(model, "rods");
  model.groups[rods].beam = rod();
  for (int beam = 0; beam < n_beams; ++beam) add_beam(model, rods, 2 * beam, 2 * beam + 1);
  const int cloth = add_membrane_group(model, "cloth"), rope = add_cable_group(model, "rope", 1e4);
  model.groups[rope].kind = model::ElementKind::bar;  // no kink where it goes slack
  const int first = 2 * n_beams;
  model.membranes.push_back({{first, below(first), first + 1}, cloth, Vec3(300, 200, 0)});
  add_cable(model, rope, first + 2, below(first), 0.02);
  add_cable(model, rope, first + 2, first, 0.02);
  const auto owner = [&](int from) {  // a node that follows nothing
    int node = from + below(n_nodes - from);
    while (follows[node]) node = from + below(n_nodes - from);
    return node;
  };
  const auto follows_link = follows;
  if (below(2) == 0) {
    const int leader = owner(1), follower = owner(1);
    const bool leads = std::any_of(model.links.begin(), model.links.end(),
                                   [&](const model::Link& link) { return link.leader == leader; });
    if (leader != follower && !leads) {
      model.cyclic_pairs.push_back(
          {leader, follower, Eigen::AngleAxisd(0.8, vector().normalized()).toRotationMatrix()});
      follows[follower] = true;
    }
  }
  std::vector<int> taken{0};
  for (int i = 0; i < 3; ++i) {  // each node follows those of smaller number
    const int node = owner(2);
    if (std::find(taken.begin(), taken.end(), node) != taken.end()) continue;
    taken.push_back(node);
    model::LinearConstraint constraint;
    constraint.terms.push_back({node, below(3), 0.5 + 0.4 * any(random)});
    for (int k = 0; k < 2; ++k) {
      int other = below(node);
      while (follows_link[other]) other = below(node);
      constraint.terms.push_back({other, below(3), any(random)});
    }
    model.constraints.push_back(constraint);
  }
  result.boundary.supports = {support({0}, clamped)};
  for (int i = 1; i < n_nodes; ++i)
    result.boundary.loads.push_back(
        load(i, 30 * vector(), model.rotational_nodes()[i] ? vector() : Vec3(Vec3::Zero())));
  model::Load gas;
  gas.on = {"cloth"};
  gas.pressure = 4000;
  result.boundary.loads.push_back(gas);
  return result;
}

/// Whether the constraints make no ring through the cyclic pair.
bool is_possible(const Tied& tied) {
  try {
    System system(tied.model);
  } catch (const ModelError&) {
    return false;
  }
  return true;
}

TEST(Links, TangentOfAnyMixtureOfTiesIsTheDerivativeOfTheResidual) {
  int met = 0;
  for (unsigned seed = 0; met < 60; ++seed) {
    ASSERT_LT(seed, 80U);
    const auto tied = tied_at_random(seed);
    if (!is_possible(tied)) continue;
    ++met;
    SCOPED_TRACE(seed);
    expect_consistent_tangent(tied.model, tied.boundary, 0.05);  // chains of arms add up
    if (HasFailure()) return;
  }
}

TEST(Links, AnyMixtureOfTiesHoldsInAMovedState) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const auto tied = tied_at_random(seed);
    if (!is_possible(tied)) continue;
    System system(tied.model);
    system.begin_stage(tied.boundary);
    const auto state = moved_state(system);
    const auto x = model::positions(tied.model, state);
    for (const auto& link : tied.model.links) {
      const Vec3 arm = tied.model.nodes[link.follower] - tied.model.nodes[link.leader];
      EXPECT_LT((x[link.follower] - x[link.leader] - state.rotation[link.leader] * arm).norm(), 1e-14)
          << seed;
    }
    for (const auto& pair : tied.model.cyclic_pairs)
      EXPECT_LT((state.displacement[pair.follower] - pair.turn * state.displacement[pair.leader]).norm(),
                1e-14);
    for (const auto& constraint : tied.model.constraints) {
      double sum = 0;
      for (const auto& term : constraint.terms)
        sum += term.coefficient * state.displacement[term.node][term.component];
      EXPECT_NEAR(sum, 0, 1e-14) << seed;
    }
  }
}

TEST(LinearConstraint, IsRefusedWhereItCannotHold) {
  const auto refused = [](std::vector<model::LinearConstraint> constraints) {
    auto model = two_beams({0.2, 0.5, -0.3}, {});
    model.constraints = std::move(constraints);
    try {
      System system(model);
    } catch (const ModelError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refused({{{{3, 0, 1}, {2, 1, 1}}, {}}}).find("through an arm"), std::string::npos);
  EXPECT_NE(refused({{{{3, 0, 1}, {1, 1, 1}}, {}}, {{{1, 1, 1}, {3, 0, 1}}, {}}}).find("follows itself"),
            std::string::npos);
  EXPECT_NE(
      refused({{{{3, 0, 1}, {1, 1, 1}}, {}}, {{{3, 0, 1}, {1, 2, 1}}, {}}}).find("another linear constraint"),
      std::string::npos);
  EXPECT_EQ(refused({{{{3, 0, 1}, {1, 1, 1}}, {}}, {{{3, 1, 1}, {3, 0, 1}}, {}}}), "");
}

/// A cantilever along x whose tip may slide along a direction at 30 degrees in the x-z plane.
TEST(RotatedSupports, LetTheNodeSlideAlongTheirFreeDirection) {
  auto model = cantilever(4, 1.0, rod());
  model::Support roller = support({4}, {false, false, true, false, false, false});
  const double a = pi / 6;
  roller.axes << std::cos(a), 0, -std::sin(a), 0, 1, 0, std::sin(a), 0, std::cos(a);
  System system(model);
  const Boundary boundary{{support({0}, clamped), roller}, {load(2, {0, 0, -40})}};
  solve(system, boundary);
  const Vec3 u = system.state().displacement[4], normal = roller.axes.col(2);
  EXPECT_NEAR(u.dot(normal), 0, 1e-14);
  EXPECT_GT(std::abs(u.dot(roller.axes.col(0))), 1e-6);
  const Vec3 reaction = system.reactions().force[4];
  EXPECT_LT((reaction - normal * normal.dot(reaction)).norm(), 1e-9);
  const auto sum = resultant(system, boundary);
  EXPECT_LT(sum.force.norm(), 1e-8);
  EXPECT_LT(sum.moment.norm(), 1e-8);
}

TEST(RotatedSupports, TangentIsTheDerivativeOfTheResidual) {
  model::Support roller = support({3}, {true, false, false, false, true, false});
  roller.axes = Eigen::AngleAxisd(0.7, Vec3(1, 2, 2) / 3).toRotationMatrix();
  auto boundary = clamped_with_loads();
  boundary.supports.push_back(roller);
  expect_consistent_tangent(two_beams({0.2, 0.5, -0.3}, {}), boundary);
}

/// Two equal cantilevers side by side; the second's tip sinks twice as far as the first's.
TEST(LinearConstraint, SharesALoadByVirtualWork) {
  model::Model model;
  model.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  const int group = add_beam_group(model, "rod");
  model.groups[group].beam = rod();
  add_beam(model, group, 0, 1);
  add_beam(model, group, 2, 3);
  model.constraints.push_back({{{3, 2, 1.0}, {1, 2, -2.0}}, {}});
  System system(model);
  const double p = 1e-3, k = 3 * rod().bending_stiffness_2;
  solve(system, {{support({0, 2}, clamped)}, {load(1, {0, 0, p})}});
  // energy k w^2/2 + k (2 w)^2/2 - p w
  EXPECT_NEAR(system.state().displacement[1].z(), p / (5 * k), 1e-6 * p / k);
  EXPECT_NEAR(system.state().displacement[3].z(), 2 * system.state().displacement[1].z(), 1e-18);
}

/// A prescribed rotation rolls a cantilever up: M = E I theta / L and a circle, whatever the angle.
TEST(PrescribedMotion, RollsACantileverUpToTwoTurns) {
  auto model = cantilever(20, 1.0, rod());
  model.groups[0].beam.axial_stiffness = 1e8;
  System system(model);
  Boundary boundary{{support({0}, clamped), support({20}, {false, false, false, true, true, true})}, {}};
  model::Load turn;
  turn.name = "turn";
  turn.nodes = {20};
  turn.rotation = Vec3(0, -4 * pi, 0);
  boundary.loads = {turn};
  solve(system, boundary);
  EXPECT_NEAR(system.reactions().moment[20].y(), -4 * pi * 2e3, 1e-6 * 4 * pi * 2e3);
  // 10 elements for a turn: the chord polygon closes as the circle does
  const auto x = model::positions(system.model(), system.state());
  EXPECT_LT(x[20].norm(), 1e-5);
  EXPECT_LT(x[10].norm(), 1e-5);
}

TEST(PrescribedMotion, OfADirectionThatNothingHoldsIsRefused) {
  System system(cantilever(2, 1.0, rod()));
  model::Load pull;
  pull.name = "pull";
  pull.nodes = {2};
  pull.displacement = Vec3(0, 0, 0.1);
  EXPECT_THROW(system.begin_stage({{support({0}, clamped)}, {pull}}), ModelError);
}

TEST(PrescribedMotion, GivesTheReactionOfASupportThatSinks) {
  System system(cantilever(1, 2.0, rod()));
  model::Load sink;
  sink.name = "sink";
  sink.nodes = {1};
  sink.displacement = Vec3(0, 0, -1e-6);
  solve(system, {{support({0}, clamped), support({1}, {false, false, true, false, false, false})}, {sink}});
  EXPECT_NEAR(system.reactions().force[1].z(), -3 * 2e3 * 1e-6 / 8, 1e-6 * 3 * 2e3 * 1e-6 / 8);
}

/// A square of four quadrilaterals under follower pressure inside held edges, with a shell beside it.
TEST(Pressure, TangentIsTheDerivativeOfTheResidual) {
  model::Model model;
  const int cloth = add_membrane_group(model, "cloth");
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) model.nodes.emplace_back(i, j, 0.1 * i * j);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const int a = i + 3 * j;
      model.membranes.push_back({{a, a + 1, a + 4, a + 3}, cloth, Vec3(300, 200, 0)});
    }
  model::Load gas;
  gas.on = {"cloth"};
  gas.pressure = 4000;
  expect_consistent_tangent(model, {{support({0, 1, 2, 3, 5, 6, 7, 8})}, {gas}});
}

}  // namespace
}  // namespace tautline::assembly
