#include <cmath>
#include <stdexcept>
#include <tautline/assembly/system.hpp>

#include "assembly/dense.hpp"
#include "assembly/models.hpp"

namespace tautline::assembly {
namespace {

using namespace testing_models;

model::Model two_cables() {
  model::Model model;
  model.nodes = {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}};
  const int cord = add_cable_group(model, "cord", 1e4);
  add_cable(model, cord, 0, 1, 5e-3);
  add_cable(model, cord, 1, 2, 5e-3);
  return model;
}

VecX gathered(const la::Vector& x) {
  std::vector<double> all;
  x.gather(all);
  return Eigen::Map<const VecX>(all.data(), static_cast<Eigen::Index>(all.size()));
}

/// Place of a node's displacement among the unknowns.
int at(const System& system, int node) {
  return 3 * system.dof_map().displacement_block[static_cast<std::size_t>(node)];
}

TEST(SystemPath, LoadRateIsWhatOneUnitOfLambdaAdds) {
  System system(two_cables());
  system.begin_stage({{support({0, 2})}, {load(1, {3, 0, -20})}});
  la::Vector q(system.layout());
  system.load_rate(q);
  VecX expected = VecX::Zero(system.n_dofs());
  expected.segment<3>(at(system, 1)) = Vec3(3, 0, -20);
  EXPECT_LT((gathered(q) - expected).norm(), 1e-10) << "what is held has no part in it";
}

TEST(SystemPath, LoadRateOfAMovingSupportPullsThroughTheTangent) {
  System system(two_cables());
  auto pull = load(2, Vec3::Zero());
  pull.displacement = Vec3(0.01, 0, 0);
  system.begin_stage({{support({0, 2})}, {pull}});
  la::Vector q(system.layout()), way(system.layout());
  system.load_rate(q);
  const double stiffness = 1e4 * 1.005;  // E A / L0 of the cable to the moving support
  EXPECT_NEAR(gathered(q)[at(system, 1)], stiffness * 0.01, 1e-7);
  system.add_drives(way);
  EXPECT_EQ(gathered(way)[at(system, 2)], 0.01);
}

/// Two facets under pressure, beams, and an arm with a dead load at its end, with one support displaced and
/// another turned: the load rate is the derivative of the residual by lambda, whatever pulls.
TEST(SystemPath, LoadRateIsTheDerivativeOfTheResidual) {
  auto model = two_facets();
  model.nodes.push_back({0.4, 2.4, 0.9});
  model.links.push_back({2, 5, false, {}, -1});
  add_cable(model, 2, 1, 5, 5e-3);
  System system(model);
  auto push = load(3, Vec3(1, 2, 3)), turn = load(4, Vec3::Zero());
  push.displacement = Vec3(0.05, 0.02, -0.03);
  turn.rotation = Vec3(0.1, 0.3, -0.2);
  model::Load blow;
  blow.on = {"cloth"};
  blow.pressure = 400;
  system.begin_stage({{support({3}), support({4}, clamped)}, {push, turn, load(5, {10, -20, 300}), blow}});
  for (const double lambda : {0.0, 0.6}) {
    constexpr double h = 1e-4;
    la::Vector x(system.layout()), ahead(system.layout()), back(system.layout()), q(system.layout());
    system.set_lambda(lambda);
    system.accept(x);
    system.restart();
    system.set_lambda(lambda + h);
    system.residual(x, ahead);
    system.set_lambda(lambda - h);
    system.residual(x, back);
    system.set_lambda(lambda);
    system.load_rate(q);
    const VecX exact = (gathered(back) - gathered(ahead)) / (2 * h);
    EXPECT_LT((gathered(q) - exact).norm(), 1e-5 * exact.norm()) << "h^2 and rounding over h";
  }
}

TEST(SystemPath, FindsAPrescribedMotionThatWasLost) {
  System system(two_cables());
  auto pull = load(2, Vec3::Zero());
  pull.displacement = Vec3(0.01, 0, 0);
  const Boundary boundary{{support({0, 2})}, {pull}};
  solve(system, boundary);
  EXPECT_NO_THROW(system.check_prescribed());
  system.set_lambda(0.5);  // as if a solver had said so, and left the support where it is
  EXPECT_THROW(system.check_prescribed(), std::logic_error);
}

TEST(SystemPath, ReturnsToAPointThatWasKept) {
  System system(two_cables());
  const Boundary boundary{{support({0, 2})}, {load(1, {0, 0, -20})}};
  solve(system, boundary);
  const auto kept = system.keep();
  const auto there = system.state().displacement[1];
  la::Vector push(system.layout());
  push.add(1, system.mean_motion({1}, Vec3(0, 1, 0)));
  system.move(push);
  EXPECT_NEAR(system.state().displacement[1].y(), 1, 1e-15);
  system.set_lambda(0.5);
  system.return_to(*kept);
  EXPECT_EQ(system.state().displacement[1], there);
  EXPECT_NEAR(system.applied().force[1].z(), -20, 1e-14);
}

TEST(SystemPath, RestoresWhereItRestedAndWhatActed) {
  System system(two_cables());
  const Boundary light{{support({0, 2})}, {load(1, {0, 0, -20})}},
      heavy{{support({0, 2})}, {load(1, {5, 0, -900})}};
  solve(system, light);
  const Rest rest = system.rest();
  solve(system, heavy);
  System other(two_cables());  // as in another run
  for (System* one : {&system, &other}) {
    one->restore(rest);
    EXPECT_EQ(one->state().displacement[1], rest.state.displacement[1]);
    EXPECT_LT(one->begin_stage(light).force, 1e-6) << "it is in equilibrium under the loads that acted";
    EXPECT_NEAR(one->begin_stage(heavy).force, std::hypot(5, 880), 1e-6);
  }
}

TEST(SystemPath, WeighsMotionsByTheSizeOfTheStructure) {
  System system(two_cables());
  system.begin_stage({{support({0, 2})}, {}});
  la::Vector d(system.layout());
  system.weights(1, d);
  const VecX weights = gathered(d);
  EXPECT_EQ(weights[at(system, 0)], 0) << "held";
  EXPECT_NEAR(weights[at(system, 1)], 0.25, 1e-15) << "the structure is 2 m long";
}

/// A cable along x that a response stretches, and may turn as a whole.
TEST(SystemPath, StressedTangentHasTheStressesOfTheResponseAndNotItsRotations) {
  model::Model model;
  model.nodes = {{0, 0, 0}, {2, 0, 0}};
  add_cable(model, add_cable_group(model, "cord", 1000), 0, 1, 0.01);
  System system(model);
  system.begin_stage({{support({0})}, {}});
  const double h = 1e-5, strain = 0.3;
  for (const double turn : {0.0, 4.0}) {
    la::Vector response(system.layout());
    response.add(2 * strain, system.mean_motion({1}, Vec3(1, 0, 0)));
    response.add(2 * turn, system.mean_motion({1}, Vec3(0, 1, 0)));
    const auto difference = system.stress_change({0, nullptr, &response, h});
    la::Vector push(system.layout()), force(system.layout());
    push.add(1, system.mean_motion({1}, Vec3(0, 0, 1)));
    difference.multiply(push, force);
    // N / l with N = E A (l / L0 - 1) changes by E A / L0 d(1 - L0 / l) = E A dl / l^2.
    const double exact = 1000 * 2 * strain / 4;
    EXPECT_NEAR(gathered(force)[at(system, 1) + 2] / (2 * h), exact, 1e-6 * exact) << "turned by " << turn;
    EXPECT_NEAR(gathered(force)[at(system, 1)] / (2 * h), 0, 1e-4);
  }
}

TEST(SystemPath, DeformationLeavesOutRigidMotions) {
  model::Model model;
  model.nodes = {{0, 0, 0}, {2, 0, 0}};
  add_cable(model, add_cable_group(model, "cord", 1000), 0, 1, 0.01);
  System system(model);
  system.begin_stage({{support({0})}, {}});
  la::Vector turn(system.layout()), stretch(system.layout());
  turn.add(3, system.mean_motion({1}, Vec3(0, 1, 0)));
  stretch.add(0.2, system.mean_motion({1}, Vec3(1, 0, 0)));
  EXPECT_LT(system.largest_deformation(turn), 1e-7);
  EXPECT_NEAR(system.largest_deformation(stretch), 0.1 / 2, 1e-7)
      << "0.1 at each end, over sqrt(2 * 1 * 1 * 2)";
}

}  // namespace
}  // namespace tautline::assembly
