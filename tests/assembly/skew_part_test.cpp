// Loads without a potential: dead moments and pressures that end at a free rim. Theory:
// docs/theory/newton.md#loads-without-a-potential
#include <gtest/gtest.h>

#include <cmath>
#include <tautline/core/rotation.hpp>

#include "assembly/dense.hpp"
#include "assembly/models.hpp"
#include "assembly/rods.hpp"

namespace tautline::assembly {
namespace {

using namespace testing_models;

/// Held unknowns apart, the derivative of the residual is tangent and skew part together.
void expect_whole_derivative(System& system) {
  system.restart();
  const auto skew = system.skew_part();
  EXPECT_FALSE(skew.empty());
  MatX derivative = derivative_of_residual(system);
  MatX formed = dense_tangent(system) + dense_of(skew, system);
  const double size = formed.norm();
  for (int i = 0; i < system.n_dofs(); ++i)
    if (system.held()[static_cast<std::size_t>(i)]) {
      for (MatX* m : {&derivative, &formed}) {
        m->row(i).setZero();
        m->col(i).setZero();
      }
    }
  EXPECT_LT((derivative - formed).norm(), 1e-8 * size);
  EXPECT_GT(dense_of(skew, system).norm(), 1e-6 * size);  // what is tested is there
}

TEST(SkewPart, OfADeadMomentMakesTheDerivativeWhole) {
  System system(beam_to({0.6, -0.5, 1.1}, 2));
  solve(system, clamped_root(load(2, Vec3::Zero(), {40, -25, 60})));
  expect_whole_derivative(system);
}

TEST(SkewPart, OfADeadMomentWhereOneRotationIsHeldAboutASkewAxis) {
  System system(beam_to({0.6, -0.5, 1.1}, 2));
  auto key = support({2}, {false, false, false, false, false, true});
  key.axes = rotation_of({0.4, -1.1, 0.7});
  solve(system, {{support({0}, clamped), key}, {load(2, Vec3::Zero(), {40, -25, 60})}});
  expect_whole_derivative(system);
}

TEST(SkewPart, OfADeadMomentOnAFollower) {
  auto model = beam_to({0.6, -0.5, 1.1}, 2);
  model.nodes.emplace_back(0.8, -0.2, 1.3);
  model.links.push_back({2, 3, false, {}});
  System system(model);
  solve(system, clamped_root(load(3, {3, 5, -2}, {40, -25, 60})));
  expect_whole_derivative(system);
}

/// Where a potential exists there is nothing: forces at the end of an arm, moments about a fixed axis.
TEST(SkewPart, IsEmptyForDeadForcesAndAboutAFixedAxis) {
  auto model = beam_to({0.6, -0.5, 1.1}, 2);
  model.nodes.emplace_back(0.8, -0.2, 1.3);
  model.links.push_back({2, 3, false, {}});
  System arm(model);
  solve(arm, clamped_root(load(3, {30, 50, -20})));
  EXPECT_TRUE(arm.skew_part().empty());
  System plane(beam_to({1, 0, 0}, 2));
  const std::array<bool, 6> in_plane{false, true, false, true, false, true};
  solve(plane, {{support({0}, clamped), support({1, 2}, in_plane)}, {load(2, Vec3::Zero(), {0, 60, 0})}});
  EXPECT_TRUE(plane.skew_part().empty());
}

TEST(SkewPart, OfAPressureStandsOnTheFreeRim) {
  model::Model model;
  model.nodes = {{0, 0, 0}, {2, 0.1, 0.3}, {0.2, 1.7, 0.4}, {2.1, 1.9, -0.2}};
  const int cloth = add_membrane_group(model, "cloth");
  model.groups[cloth].membrane.tension_stiffness = 1000;
  add_membrane(model, cloth, 0, 1, 2);
  add_membrane(model, cloth, 2, 1, 3);
  System system(model);
  model::Load gas;
  gas.on = {"cloth"};
  gas.pressure = 300;
  system.begin_stage({{support({0})}, {gas}});
  system.set_lambda(1);
  system.set_state(some_state(model));
  expect_whole_derivative(system);

  System held(model);
  held.begin_stage({{support({0, 1, 2, 3})}, {gas}});
  held.set_lambda(1);
  EXPECT_TRUE(held.skew_part().empty());
}

/// A rod that a dead moment across it bends to an arc, in any position.
TEST(DeadMoment, ConvergesQuadraticallyInAnyPosition) {
  const Vec3 along(1, 0, 0), moment(0, -150, 0);  // M L / E I = 1.5
  for (const Vec3& turn :
       {Vec3(0, 0, 0), Vec3(0.3, -1.2, 0.8), Vec3(2.1, 0.4, -1.7), Vec3(0.02, 0.01, 3.1)}) {
    const Mat3 Q = rotation_of(turn);
    auto model = beam_to(Q * along, 16);
    for (auto& beam : model.beams) beam.frame = Q;
    System system(model);
    const auto path = solve(system, clamped_root(load(16, Vec3::Zero(), Q * moment)));
    // An arc of radius E I / M; 16 elements err by c^4/120 of the length, c = 1.5/32: 4e-8.
    const Vec3 tip(std::sin(1.5) / 1.5 - 1, 0, (1 - std::cos(1.5)) / 1.5);
    EXPECT_LT((system.state().displacement[16] - Q * tip).norm(), 1e-7);
    EXPECT_LE(path.newton_iterations, 10);  // a linear rate needs many times as many
    EXPECT_EQ(path.failed_attempts, 0);
  }
}

}  // namespace
}  // namespace tautline::assembly
