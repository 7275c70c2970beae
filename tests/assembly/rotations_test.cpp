// Rotations as supports and as loads. Theory: docs/theory/constraints.md#held-rotations
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <tautline/core/rotation.hpp>

#include "assembly/dense.hpp"
#include "assembly/models.hpp"
#include "assembly/rods.hpp"

namespace tautline::assembly {
namespace {

using namespace testing_models;
using std::numbers::pi;

model::Load turn(int node, const Vec3& rotation) {
  model::Load result;
  result.name = "turn";
  result.nodes = {node};
  result.rotation = rotation;
  return result;
}

model::Support turned_support(const std::vector<int>& nodes, const std::array<bool, 6>& fixed,
                              const Mat3& axes) {
  auto result = support(nodes, fixed);
  result.axes = axes;
  return result;
}

/// The same in equal increments, imposed motions with it.
void solve_by(System& system, const Boundary& boundary, int increments) {
  analysis::NewtonOptions options;
  options.increments = increments;
  solve(system, boundary, options);
}

constexpr std::array<bool, 6> rx{false, false, false, true, false, false},
    ry{false, false, false, false, true, false}, rz{false, false, false, false, false, true},
    rx_ry{false, false, false, true, true, false};

/// Whatever came before, a foot stands as its last rotation vector says.
TEST(ImposedRotation, ReplacesTheOneBefore) {
  const Vec3 tip(0, 0, 1);
  System system(beam_to(tip));
  for (const Vec3& rotation : {Vec3(0.5, 0, 0), Vec3(0, 0.5, 0), Vec3(1.2, -0.7, 2.1), Vec3(-2.9, 0.4, 0.3),
                               Vec3(0, 0, 0), Vec3(0.1, 3.0, -0.2)}) {
    solve(system, {{support({0}, clamped)}, {turn(0, rotation)}});
    EXPECT_LT((system.state().rotation[0] - rotation_of(rotation)).norm(), 1e-13);
    EXPECT_LT((system.state().displacement[1] - (rotation_of(rotation) * tip - tip)).norm(), 1e-9);
    EXPECT_LT((system.state().turn[0] - rotation).norm(), 1e-12);
  }
}

TEST(ImposedRotation, StaysWithoutItsLoad) {
  System system(beam_to({0, 0, 1}));
  const Vec3 rotation(0.3, 0.5, -0.2);
  solve(system, {{support({0}, clamped)}, {turn(0, rotation)}});
  solve(system, {{support({0}, clamped)}, {}});
  EXPECT_LT((system.state().rotation[0] - rotation_of(rotation)).norm(), 1e-13);
}

/// A shaft held at one end and twisted at the other: M = G J theta / L counts the turns.
TEST(ImposedRotation, CountsTurnsAboutOneAxis) {
  System system(beam_to({2, 0, 0}, 20));
  for (const double angle : {4 * pi, 2 * pi, 5.0, -3 * pi, 0.0}) {
    solve(system, {{support({0, 20}, clamped)}, {turn(20, {angle, 0, 0})}});
    EXPECT_NEAR(system.reactions().moment[20].x(), 80 * angle / 2, 1e-8 * 80 * 2 * pi) << angle;
  }
}

/// The same where the bearing leaves the tilt free.
TEST(ImposedRotation, CountsTurnsAboutTheOnlyAxisThatIsHeld) {
  System system(beam_to({2, 0, 0}, 20));
  constexpr std::array<bool, 6> bearing{true, true, true, true, false, false};
  for (const double angle : {4 * pi, 2 * pi, 1.0}) {
    solve(system, {{support({0}, clamped), support({20}, bearing)}, {turn(20, {angle, 0, 0})}});
    EXPECT_NEAR(system.reactions().moment[20].x(), 80 * angle / 2, 1e-8 * 80 * 2 * pi) << angle;
  }
}

/// A body that is clamped in one place goes where the clamp goes, without any force.
TEST(ImposedRotation, TurnsABodyAsAWholeHoweverFar) {
  for (const Vec3& rotation : {Vec3(0.7, 0, 0), Vec3(0.5, -1, 1), Vec3(-2, 2, 1), Vec3(0, 3.1, 0)}) {
    auto model = beam_to({0.3, 0.4, 1.2}, 4);
    model.nodes.emplace_back(0.9, -0.2, 1.5);
    add_beam(model, 0, 4, 5);
    System system(model);
    const auto path = solve(system, {{support({0}, clamped)}, {turn(0, rotation)}});
    const Mat3 R = rotation_of(rotation);
    for (std::size_t i = 0; i < model.nodes.size(); ++i)
      EXPECT_LT((system.state().displacement[i] - (R * model.nodes[i] - model.nodes[i])).norm(), 1e-12);
    EXPECT_LE(path.newton_iterations, 1);  // one that takes off rounding
    EXPECT_EQ(path.failed_attempts, 0);
  }
}

/// Whose tip is turned once or twice becomes a ring, and not what it was, in as many iterations on many
/// elements as on few.
TEST(ImposedRotation, RollsUpARodInFewIterations) {
  for (const int parts : {16, 48})
    for (const int turns : {1}) {
      auto model = cantilever(parts, 1, rod());
      System system(model);
      const auto path = solve(
          system, {{support({0}, clamped), support({parts}, ry)}, {turn(parts, {0, -2 * pi * turns, 0})}});
      EXPECT_LT((system.state().displacement[parts] - Vec3(-1, 0, 0)).norm(), 1e-9);
      EXPECT_NEAR(system.reactions().moment[parts].y(), -100 * 2 * pi * turns, 1e-6);  // E I / radius
      EXPECT_LE(path.newton_iterations, 8);
      EXPECT_EQ(path.failed_attempts, 0);
    }
}

/// The end state of a conservative structure does not know how it came about.
void expect_one_answer(const model::Model& model, const Boundary& boundary, int node) {
  System at_once(model);
  solve(at_once, boundary);
  for (const int steps : {2, 7, 20}) {
    System slowly(model);
    solve_by(slowly, boundary, steps);
    EXPECT_LT((slowly.state().displacement[node] - at_once.state().displacement[node]).norm(), 1e-9) << steps;
    EXPECT_LT((slowly.state().rotation[node] - at_once.state().rotation[node]).norm(), 1e-9) << steps;
  }
}

/// Rotation vector after what is prescribed.
Vec3 tilt(const System& system, int node, const Vec3& prescribed) {
  return rotation_vector(system.state().rotation[node] * rotation_of(prescribed).transpose());
}

TEST(HeldRotation, IsOneAnswerInHoweverManySteps) {
  const Boundary boundary{{support({0}, clamped), support({1}, rz)}, {load(1, {0, 60, 60}, {40, 30, 0})}};
  expect_one_answer(beam_to({1, 0.3, 0.2}), boundary, 1);
}

TEST(HeldRotation, IsTheComponentOfTheRotationVectorAlongTheAxis) {
  for (const Mat3& axes : {rotation_of({0.4, -0.9, 0.7}), Mat3(Mat3::Identity())})
    for (const auto& fixed : {rx, ry, rz}) {
      System system(beam_to({1, 0.3, 0.2}, 3));
      const auto key = turned_support({3}, fixed, axes);
      solve(system, {{support({0}, clamped), key}, {load(3, {0, 60, 60}, {10, 5, 0})}});
      const Vec3 theta = axes.transpose() * rotation_vector(system.state().rotation[3]);
      for (int c = 0; c < 3; ++c)
        if (fixed[static_cast<std::size_t>(3 + c)]) {
          EXPECT_NEAR(theta[c], 0, 1e-13);
        } else {
          EXPECT_GT(std::abs(theta[c]), 1e-3);
        }
    }
}

/// R = exp(tilt) exp(prescribed): in any order of steps the same.
TEST(HeldRotation, IsPrescribedBeforeTheTilt) {
  const auto model = beam_to({1, 0.3, 0.2}, 3);
  const Mat3 axes = rotation_of({0.4, -0.9, 0.7});
  const auto pull = load(3, {0, 30, 40});
  for (const auto& fixed : {rx, rx_ry}) {
    const std::vector<model::Support> supports{support({0}, clamped), turned_support({3}, fixed, axes)};
    const Vec3 first = axes * Vec3(0.8, 0, 0), last = axes * Vec3(-0.6, fixed[4] ? 0.5 : 0, 0);
    System direct(model), detour(model);
    solve(direct, {supports, {pull, turn(3, last)}});
    solve(detour, {supports, {turn(3, first)}});
    solve(detour, {supports, {pull, turn(3, first)}});
    solve(detour, {supports, {turn(3, last)}});
    solve(detour, {supports, {pull, turn(3, last)}});
    EXPECT_LT((direct.state().displacement[3] - detour.state().displacement[3]).norm(), 1e-9);
    const Vec3 left = axes.transpose() * tilt(direct, 3, last);
    EXPECT_NEAR(left[0], 0, 1e-12);
    if (fixed[4]) {
      EXPECT_NEAR(left[1], 0, 1e-12);
    }
    EXPECT_GT(left.norm(), 1e-3);
    expect_one_answer(model, {supports, {pull, turn(3, last)}}, 3);
  }
}

/// No tilt is special, half a turn neither: a free beam follows its other end, on through a whole turn.
TEST(HeldRotation, LetsTheNodeTiltThroughAWholeTurn) {
  System system(beam_to({1, 0, 0}, 2));
  const auto hub = support({0}, {true, true, true, false, false, true});
  constexpr std::array<bool, 6> handle{false, false, false, true, true, true};
  for (const double angle : {1.0, 2.5, 3.0, pi, 3.5, 5.0, 6.0, 7.0}) {
    const Boundary boundary{{hub, support({2}, handle)}, {turn(2, {0, angle, 0})}};
    solve_by(system, boundary, 3);
    EXPECT_LT((system.state().rotation[0] - rotation_of({0, angle, 0})).norm(), 1e-9) << angle;
  }
}

/// Away from equilibrium, what supports prescribe moved, too.
void expect_consistent_tangent(const model::Model& model, const Boundary& boundary) {
  System system(model);
  system.begin_stage(boundary);
  system.set_lambda(1);
  std::vector<double> x(static_cast<std::size_t>(system.n_dofs()));
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = 0.3 * std::sin(1.7 * static_cast<double>(i) + 0.3);
  system.set_state(system.kinematics().moved(system.state(), x));
  expect_tangent_is_derivative_of_residual(system);
}

TEST(HeldRotation, TangentIsTheDerivativeOfTheResidual) {
  const Mat3 axes = rotation_of({0.4, -0.9, 0.7});
  const auto pull = load(2, {30, -20, 50}, {4, 7, -3});
  for (const auto& fixed : {rx, ry, rx_ry})
    for (const Vec3& prescribed : {Vec3(0, 0, 0), Vec3(0.9, 0, 0)}) {
      if (fixed == ry && !prescribed.isZero()) continue;
      const Boundary boundary{{support({0}, clamped), turned_support({1, 2}, fixed, axes)},
                              {pull, turn(2, axes * prescribed)}};
      expect_consistent_tangent(beam_to({1, 0.3, 0.2}, 2), boundary);
    }
}

TEST(HeldRotation, TangentOfAnArmOnItIsTheDerivativeOfTheResidual) {
  auto model = beam_to({1, 0.3, 0.2}, 2);
  model.nodes.emplace_back(1.2, 0.8, 0.1);  // node 3 on an arm from node 2, carries a beam to node 4
  model.nodes.emplace_back(1.9, 1.0, 0.6);
  add_beam(model, 0, 3, 4);
  model.links.push_back({2, 3, false, {}, -1});
  const Boundary boundary{{support({0}, clamped), turned_support({2}, rx, rotation_of({0.4, -0.9, 0.7}))},
                          {load(3, {30, -20, 50}, {4, 7, -3}), load(4, {-5, 10, 5}, {1, 0, 2})}};
  expect_consistent_tangent(model, boundary);
}

/// Without dead moments the structure is conservative and Newton's method quadratic: a residual of v < 5e-3
/// of the forces at work leaves less than 100 v^2, down to rounding.
TEST(HeldRotation, ConvergesQuadratically) {
  for (const auto& fixed : {rx, ry, rz, rx_ry}) {
    System system(beam_to({1, 0.3, 0.2}, 4));
    const auto key = turned_support({4}, fixed, rotation_of({0.4, -0.9, 0.7}));
    const auto path = solve(system, {{support({0}, clamped), key}, {load(4, {0, 60, 60})}});
    const auto& list = path.points.back().newton.iterations;
    int counted = 0;
    for (std::size_t i = 0; i + 1 < list.size(); ++i) {
      const double now = list[i].norms.force / list[i].norms.reference_force;
      const double next = list[i + 1].norms.force / list[i + 1].norms.reference_force;
      if (now > 5e-3 || now < 1e-8) continue;
      EXPECT_LT(next, 100 * now * now + 1e-12);
      ++counted;
    }
    EXPECT_GT(counted, 0);
  }
}

/// Loads and reactions make no moment about any point, whatever the support holds.
TEST(HeldRotation, HasAMomentThatBalancesTheRest) {
  for (const auto& fixed : {rx, ry, rz, rx_ry}) {
    System system(beam_to({1, 0.3, 0.2}, 2));
    const Mat3 axes = rotation_of({0.4, -0.9, 0.7});
    const auto key = turned_support({2}, fixed, axes);
    const Boundary boundary{
        {support({0}, clamped), key},
        {load(2, {0, 60, 60}, {9, 5, 2}), turn(2, axes * Vec3(fixed[3] ? 0.4 : 0, 0, 0))}};
    solve_by(system, boundary, 2);
    const auto sum = resultant(system, boundary);
    EXPECT_LT(sum.force.norm(), 1e-6);
    EXPECT_LT(sum.moment.norm(), 1e-6);
    EXPECT_GT(system.reactions().moment[2].norm(), 1e-3);
  }
}

/// Turned as a whole, a structure answers turned as a whole; mirrored, mirrored.
TEST(HeldRotation, KnowsNoSpecialDirection) {
  const Vec3 tip(1, 0.3, 0.2), pull(0, 40, 60);
  const Mat3 axes = rotation_of({0.4, -0.9, 0.7}), whole = rotation_of({1.1, 0.6, -2.0});
  const auto answer = [&](const Mat3& by) {
    auto model = beam_to(by * tip, 2);
    for (auto& beam : model.beams)
      beam.frame = by * element::beam_frame((Mat<3, 2>() << Vec3::Zero(), tip).finished(), Vec3(0, 0, 1));
    if (by.determinant() < 0)
      for (auto& beam : model.beams) beam.frame.col(1) *= -1;
    System system(model);
    solve(system, {{support({0}, clamped), turned_support({2}, rx, by * axes)}, {load(2, by * pull)}});
    return Vec3(by.transpose() * system.state().displacement[2]);
  };
  const Vec3 one = answer(Mat3::Identity());
  EXPECT_LT((answer(whole) - one).norm(), 1e-9);
  const Vec3 normal = Vec3(1, -2, 2) / 3;
  EXPECT_LT((answer(Mat3::Identity() - 2 * normal * normal.transpose()) - one).norm(), 1e-9);
}

}  // namespace
}  // namespace tautline::assembly
