#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <tautline/assembly/bodies.hpp>
#include <tautline/model/response.hpp>

#include "assembly/models.hpp"

namespace tautline::assembly {
namespace {

using namespace testing_models;

element::BeamSection tube() {
  element::BeamSection section;
  section.axial_stiffness = 2e6;
  section.bending_stiffness_2 = section.bending_stiffness_3 = 500;
  section.torsion_stiffness = 400;
  section.mass_per_length = 3;
  section.rotary_inertia_2 = section.rotary_inertia_3 = 1e-3;
  return section;
}

Boundary free_under(std::vector<model::Load> loads) {
  return {{}, std::move(loads), true};
}

/// The model turned about a skew axis and moved.
model::Model turned(model::Model model, const Mat3& turn) {
  for (Vec3& node : model.nodes) node = turn * node + Vec3(3, -5, 2);
  for (auto& beam : model.beams) beam.frame = turn * beam.frame;
  return model;
}

const Mat3 skew_turn = Eigen::AngleAxisd(1.2, Vec3(1, 2, -1).normalized()).toRotationMatrix();

/// An angle of two legs, so that loads can turn it about any axis.
model::Model angle_frame(int n, double length) {
  model::Model model = cantilever(n, length, tube());
  for (int i = 1; i <= n; ++i) {
    model.nodes.emplace_back(length, length * i / n, 0);
    add_beam(model, 0, i == 1 ? n : n + i - 1, n + i);
  }
  return model;
}

TEST(Bodies, AreWhatElementsJoin) {
  auto model = cantilever(2, 1, tube());
  const auto other = cantilever(1, 1, tube());
  for (const Vec3& node : other.nodes) model.nodes.push_back(node + Vec3(0, 5, 0));
  auto beam = other.beams[0];
  beam.nodes = {3, 4};
  model.beams.push_back(beam);
  const auto bodies = bodies_of(model);
  ASSERT_EQ(bodies.size(), 2U);
  EXPECT_EQ(bodies[0], (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(bodies[1], (std::vector<int>{3, 4}));
  EXPECT_EQ(rigid_motions(System(model)).size(), 12U);
}

TEST(Bodies, SupportsLeaveSomeRigidMotions) {
  System system(turned(cantilever(4, 1, tube()), skew_turn));
  EXPECT_EQ(rigid_motions(system).size(), 6U);
  system.begin_stage({{support({0}, pinned)}, {}});
  EXPECT_EQ(rigid_motions(system).size(), 3U);
  system.begin_stage({{support({0, 4}, pinned)}, {}});
  EXPECT_EQ(rigid_motions(system).size(), 1U);  // about its own line
  system.begin_stage({{support({0}, clamped)}, {}});
  EXPECT_TRUE(rigid_motions(system).empty());
}

TEST(InertiaRelief, BarPulledAtOneEndCarriesForceInProportionToTheMassBehind) {
  constexpr int n = 8;
  constexpr double length = 4, force = 1000;
  System system(turned(cantilever(n, length, tube()), skew_turn));
  const Vec3 along = skew_turn.col(0);
  solve(system, free_under({load(n, force * along)}));
  const auto bodies = system.accelerations();
  ASSERT_EQ(bodies.size(), 1U);
  EXPECT_NEAR((bodies[0].linear - force / (3 * length) * along).norm(), 0, 1e-9);
  EXPECT_NEAR(bodies[0].angular.norm(), 0, 1e-9);
  const auto response = model::evaluate_response(system.model(), system.state());
  for (int i = 0; i < n; ++i)
    EXPECT_NEAR(response.beams[static_cast<std::size_t>(i)].axial, force * (i + 1) / n, 1e-6 * force);
  Vec3 mean = Vec3::Zero();
  for (int i = 0; i <= n; ++i)
    mean += (i == 0 || i == n ? 0.5 : 1.0) * system.state().displacement[static_cast<std::size_t>(i)];
  EXPECT_LT(mean.norm(), 1e-12);
}

TEST(InertiaRelief, FreeFallLeavesNoForces) {
  System system(turned(cantilever(6, 2, tube()), skew_turn));
  solve(system, free_under({weight(Vec3(1, -2, -9.81))}));
  EXPECT_NEAR((system.accelerations()[0].linear - Vec3(1, -2, -9.81)).norm(), 0, 1e-12);
  for (const Vec3& u : system.state().displacement) EXPECT_LT(u.norm(), 1e-12);
}

/// A stiff frame at rest is not shaken by the rounding of its mean place.
TEST(InertiaRelief, FreeFallOfAFrameLeavesNoForces) {
  System system(turned(angle_frame(4, 3), skew_turn));
  solve(system, free_under({weight(Vec3(1, -2, -9.81))}));
  EXPECT_NEAR((system.accelerations()[0].linear - Vec3(1, -2, -9.81)).norm(), 0, 1e-12);
  for (const Vec3& u : system.state().displacement) EXPECT_LT(u.norm(), 1e-12);
}

/// M(x) of a free beam pushed across at its middle is that of the beam on the uniform load m a = F / L.
TEST(InertiaRelief, BeamPushedAtItsMiddleBendsAsUnderAUniformLoad) {
  constexpr int n = 8;
  constexpr double length = 4, force = 0.01;
  System system(turned(cantilever(n, length, tube()), skew_turn));
  const Vec3 across = skew_turn.col(2);
  solve(system, free_under({load(n / 2, force * across)}));
  // Small bending: half the beam is a cantilever under -F/L, its end w L'^4 / 8 EI below the middle.
  const double half = length / 2, end = force / length * std::pow(half, 4) / (8 * 500);
  const auto& u = system.state().displacement;
  EXPECT_NEAR((u[n / 2] - u[0]).dot(across), end, 1e-6 * end);
  EXPECT_NEAR((u[n / 2] - u[n]).dot(across), end, 1e-6 * end);
}

/// A moment about the axis of a straight beam turns it by its own polar inertia, without other forces.
TEST(InertiaRelief, TorqueAboutTheAxis) {
  constexpr int n = 4;
  constexpr double length = 2, torque = 0.5;
  System system(turned(cantilever(n, length, tube()), skew_turn));
  const Vec3 along = skew_turn.col(0);
  solve(system, free_under({load(n, Vec3::Zero(), torque * along)}));
  EXPECT_NEAR((system.accelerations()[0].angular - torque / (2e-3 * length) * along).norm(), 0, 1e-6);
  // Linear torque T x / L: the end turns by T L / 3 GJ from the mean, which is where x^2/2L is L/6.
  const Mat3 end = system.state().rotation[n], start = system.state().rotation[0];
  EXPECT_NEAR(Eigen::AngleAxisd(end * start.transpose()).angle(), torque * length / (2 * 400), 1e-7);
}

/// Large bending: the same as held statically determinate with the inertia as loads.
TEST(InertiaRelief, LargeDisplacementsAsHeldStaticallyDeterminate) {
  constexpr int n = 6;
  constexpr double length = 3;
  const auto model = turned(angle_frame(n, length), skew_turn);
  System system(model);
  const Mat3& axes = skew_turn;
  solve(system, free_under({load(n, 120 * axes.col(2)), load(2 * n, 20 * axes.col(0), 10 * axes.col(1))}));
  const auto found = system.state();
  double largest = 0;
  for (const Vec3& u : found.displacement) largest = std::max(largest, u.norm());
  EXPECT_GT(largest, 0.03 * length);
  const auto applied = system.applied();
  std::vector<model::Load> loads;
  Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
  for (int i = 0; i <= 2 * n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    loads.push_back(load(i, applied.force[at], applied.moment[at]));
    sum += applied.force[at];
    moment += (model.nodes[at] + found.displacement[at]).cross(applied.force[at]) + applied.moment[at];
  }
  EXPECT_LT(sum.norm(), 1e-6);
  EXPECT_LT(moment.norm(), 1e-6);
  System other(model);
  other.set_state(found);
  solve(other, {{support({0}, clamped)}, loads});
  EXPECT_LT(other.reactions().force[0].norm(), 1e-5);
  EXPECT_LT(other.reactions().moment[0].norm(), 1e-5);
  for (std::size_t i = 0; i < found.displacement.size(); ++i)
    EXPECT_LT((other.state().displacement[i] - found.displacement[i]).norm(), 1e-6);
}

/// Mean displacement and rotation, weighed by mass, are zero; the same loads again move nothing.
TEST(InertiaRelief, StandsInItsMeanAxes) {
  constexpr int n = 6;
  const auto model = turned(angle_frame(n, 3), skew_turn);
  System system(model);
  const auto boundary = free_under({load(n, 120 * skew_turn.col(2)), load(2 * n, 20 * skew_turn.col(0))});
  solve(system, boundary);
  const auto found = system.state();
  const auto check_mean = [&] {
    Vec3 mean = Vec3::Zero(), turn = Vec3::Zero();
    for (int i = 0; i <= 2 * n; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double mass = i == 0 || i == 2 * n ? 0.5 : 1;
      mean += mass * found.displacement[at];
      turn += mass * model.nodes[at].cross(found.displacement[at]);
    }
    EXPECT_LT(mean.norm(), 1e-9);
    EXPECT_LT(turn.norm(), 1e-8);
  };
  check_mean();
  const auto again = solve(system, boundary);
  EXPECT_LE(again.newton_iterations, 2);
  for (std::size_t i = 0; i < found.displacement.size(); ++i)
    EXPECT_LT((system.state().displacement[i] - found.displacement[i]).norm(), 1e-8);
}

}  // namespace
}  // namespace tautline::assembly
