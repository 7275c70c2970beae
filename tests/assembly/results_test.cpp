// What a system tells of its present state, on a structure of every kind of element under every kind of load.
#include <gtest/gtest.h>

#include <cmath>
#include <tautline/core/rotation.hpp>

#include "assembly/dense.hpp"
#include "assembly/mixture.hpp"

namespace tautline::assembly {
namespace {

using namespace testing_models;

int add_spring_group(model::Model& model, const Vec3& stiffness, const Vec3& rotational) {
  auto& group = model.groups.emplace_back();
  group.name = "springs";
  group.kind = model::ElementKind::spring;
  group.spring = {stiffness, rotational};
  return static_cast<int>(model.groups.size()) - 1;
}

/// The mixture with springs to the ground that resist displacements and turns, and displacements only.
model::Model sprung_mixture() {
  auto model = mixture();
  const int both = add_spring_group(model, {300, 500, 700}, {20, 30, 50}),
            plain = add_spring_group(model, {200, 100, 400}, Vec3::Zero());
  model.springs.push_back({{4}, both});
  model.springs.push_back({{3}, plain});
  return model;
}

/// Displaced, under all loads, the boundary given.
void put_under_loads(System& system, const Boundary& boundary, double size) {
  system.begin_stage(boundary);
  system.set_lambda(1);
  system.set_state(
      system.kinematics().moved(model::State::reference(system.model()), some_increments(system, size)));
}

la::Vector distributed(const System& system, const std::vector<double>& all) {
  const auto& layout = system.layout();
  la::Vector x(layout);
  x.write(std::span(all).subspan(3 * static_cast<std::size_t>(layout.first),
                                 3 * static_cast<std::size_t>(layout.local)));
  return x;
}

TEST(Results, TangentOfTheMixtureUnderAllLoadsIsTheDerivativeOfTheResidual) {
  const auto model = sprung_mixture();
  System system(model);
  put_under_loads(system, {{support({0, 3}, clamped)}, all_loads()}, 0.03);
  expect_tangent_is_derivative_of_residual(system);
}

TEST(Results, SecondVariationOfTheMixtureIsTheQuadraticFormOfTheTangent) {
  const auto model = sprung_mixture();
  System system(model);
  put_under_loads(system, {{support({0, 3}, clamped)}, all_loads()}, 0.03);
  const MatX tangent = dense_tangent(system);
  const auto x = some_increments(system, 1);
  const Eigen::Map<const VecX> v(x.data(), system.n_dofs());
  EXPECT_NEAR(system.second_variation(distributed(system, x)), v.dot(tangent * v),
              1e-12 * tangent.norm() * v.squaredNorm());
}

/// Whatever the state, what acts, what supports and what the ground's springs carry make no force and no
/// moment, as elements have none of their own.
TEST(Results, LoadsReactionsAndTheGroundBalance) {
  const auto model = sprung_mixture();
  for (const double size : {0.0, 0.1, 0.3}) {
    System system(model);
    auto boundary = held(model, all_loads());
    system.begin_stage(boundary);
    system.set_lambda(1);
    std::vector<double> moved(static_cast<std::size_t>(system.n_dofs()));
    for (std::size_t i = 0; i < moved.size(); ++i)
      moved[i] = size * std::sin(2.3 * static_cast<double>(i) + 1);
    system.set_state(system.kinematics().moved(model::State::reference(model), moved));
    const auto applied = system.applied(), reactions = system.reactions(), ground = system.ground_springs();
    const auto x = model::positions(model, system.state());
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    double scale = 0;
    for (const auto* part : {&applied, &reactions, &ground})
      for (std::size_t i = 0; i < x.size(); ++i) {
        force += part->force[i];
        moment += x[i].cross(part->force[i]) + part->moment[i];
        scale = std::max(scale, part->force[i].norm());
      }
    EXPECT_LT(force.norm(), 1e-12 * scale) << size;
    EXPECT_LT(moment.norm(), 1e-11 * scale) << size;
    if (size == 0) continue;
    const Vec3 u = system.state().displacement[3];  // a spring whose axes stay: -k u
    EXPECT_LT((ground.force[3] + Vec3(200, 100, 400).cwiseProduct(u)).norm(), 1e-11);
    EXPECT_LT((ground.force[4] + Vec3(300, 500, 700).cwiseProduct(system.state().displacement[4])).norm(),
              1e-11);
    EXPECT_GT(ground.moment[4].norm(), 0.1);
  }
}

TEST(Results, GroundSpringsTurnBackWhatTurned) {
  // About one axis: -k theta.
  model::Model model;
  model.nodes = {{0, 0, 0}, {1, 0, 0}};
  const int rod = add_beam_group(model, "rod");
  add_beam(model, rod, 0, 1);
  model.springs.push_back({{1}, add_spring_group(model, Vec3::Zero(), {20, 30, 50})});
  System system(model);
  auto state = model::State::reference(model);
  state.rotation[1] = rotation_of({0, 0.4, 0});
  system.set_state(state);
  EXPECT_LT((system.ground_springs().moment[1] - Vec3(0, -30 * 0.4, 0)).norm(), 1e-14);
  EXPECT_EQ(system.ground_springs().moment[0].norm(), 0);
}

TEST(Results, WeightOfACatenaryActsInItsCentroid) {
  // Hung level between two points: by symmetry in the middle of the span; carried by both ends alike.
  model::Model model;
  model.nodes = {{1, 2, 3}, {9, 2, 3}};
  const int line = add_cable_group(model, "line", 1e6, 2.0);
  model.groups[line].kind = model::ElementKind::catenary;
  add_cable(model, line, 0, 1, -0.2);
  System system(model);
  system.begin_stage({{support({0, 1})}, {weight({0, 0, -9.81})}});
  system.set_lambda(1);
  const auto applied = system.applied();
  const double all = 2 * model.unstressed_length(model.cables[0]) * 9.81;
  EXPECT_LT((applied.force[0] - Vec3(0, 0, -all / 2)).norm(), 1e-9 * all);
  EXPECT_LT((applied.force[1] - Vec3(0, 0, -all / 2)).norm(), 1e-9 * all);
  EXPECT_LT((applied.moment[0] + applied.moment[1]).norm(), 1e-8 * all);
}

/// Forces of a linear constraint: w3 = 2 w1 of two cantilevers' tips; the second is moved by nothing else.
TEST(Results, ForcesOfALinearConstraintMoveWhatNothingElseMoves) {
  model::Model model;
  model.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  const int group = add_beam_group(model, "rod");
  model.groups[group].beam = {1e6, 2e3, 3e3, 1e3, 0, 0, 2, 0, 0};
  add_beam(model, group, 0, 1);
  add_beam(model, group, 2, 3);
  model.constraints.push_back({{{3, 2, 0.5}, {1, 2, -1.0}}, {}});
  System system(model);
  const double p = 1e-3, k = 3 * 2e3, w = p / (5 * k);  // energy k w^2/2 + k (2 w)^2/2 - p w
  solve(system, {{support({0, 2}, clamped)}, {load(1, {0, 0, p})}});
  const auto forces = system.constraint_forces();
  EXPECT_LT((forces.force[3] - Vec3(0, 0, 2 * k * w)).norm(), 1e-6 * p);
  EXPECT_LT((forces.force[1] - Vec3(0, 0, -4 * k * w)).norm(), 1e-6 * p) << "no work: -2 times";
  EXPECT_EQ(system.reactions().force[3].norm(), 0) << "no support";
}

/// A quarter of a ring of cables about z with loads on every node: what the neighbours carry on the one face
/// they carry on the other, turned.
TEST(Results, ForcesOfNeighbouringSectorsAreThoseOfTheWholeRing) {
  const double r = 2;
  const auto place = [&](int k) {
    const double angle = std::acos(-1) / 8 * k;
    return Vec3(r * std::cos(angle), r * std::sin(angle), 0);
  };
  model::Model model;
  for (int k = 0; k <= 4; ++k) model.nodes.push_back(place(k));
  const int ring = add_cable_group(model, "ring", 1e5, 0.0);
  for (int k = 0; k < 4; ++k) add_cable(model, ring, k, k + 1, 1e-2);
  const int spokes = add_cable_group(model, "spokes", 1e5, 0.0);
  for (int k = 0; k < 4; ++k) {
    model.nodes.push_back(2 * place(k));
    add_cable(model, spokes, k, 5 + k, 1e-2);
  }
  model.cyclic_pairs.push_back({0, 4, rotation_of({0, 0, std::acos(-1) / 2})});
  System system(model);
  solve(system, {{support({5, 6, 7, 8})}, {load(0, {0, 0, -5}), load(2, {0, 0, -9})}});
  const auto forces = system.constraint_forces();
  const auto residual = resultant(system, {});
  // The follower's last cable pulls it towards node 3, and nothing else acts there.
  const auto x = model::positions(model, system.state());
  const double length = (x[3] - x[4]).norm(), rest = (place(3) - place(4)).norm() / 1.01;
  const Vec3 pull = 1e5 * (length / rest - 1) * (x[3] - x[4]).normalized();
  EXPECT_LT((forces.force[4] + pull).norm(), 1e-7 * pull.norm());
  const Mat3 turn = model.cyclic_pairs[0].turn;
  EXPECT_LT((forces.force[0] - turn.transpose() * pull).norm(), 1e-7 * pull.norm());
  EXPECT_GT(residual.force.norm(), 1);  // supports alone do not balance the loads of a sector
  for (const int other : {1, 2, 3}) EXPECT_EQ(forces.force[static_cast<std::size_t>(other)].norm(), 0);
}

/// A mast on each face, with a load at the end of an arm from its top: the follower carries what its sector
/// puts on it, the moment of the arm with it.
TEST(Results, MomentsOfArmsGoToTheNeighbouringSector) {
  const Mat3 turn = rotation_of({0, 0, std::acos(-1) / 2});
  model::Model model;
  const Vec3 foot(2, 0, 0), top(2, 0, 3), arm(0.5, 0.2, 0.4);
  model.nodes = {foot, top, turn * foot, turn * top, turn * top + arm};
  const int rod = add_beam_group(model, "rod");
  model.groups[rod].beam = {1e6, 2e3, 3e3, 1e3, 0, 0, 2, 0, 0};
  add_beam(model, rod, 0, 1);
  model.links.push_back({3, 4, false, {}, -1});
  model.cyclic_pairs.push_back({0, 2, turn});
  model.cyclic_pairs.push_back({1, 3, turn});
  System system(model);
  const Vec3 force(0.1, -0.2, 0.3);
  solve(system, {{support({0}, clamped)}, {load(4, force)}});
  const auto forces = system.constraint_forces();
  const auto x = model::positions(model, system.state());
  const Vec3 lever = x[4] - x[3];
  EXPECT_LT((forces.force[3] + force).norm(), 1e-9);
  EXPECT_LT((forces.moment[3] + lever.cross(force)).norm(), 1e-9);
  EXPECT_LT((forces.moment[1] - turn.transpose() * lever.cross(force)).norm(), 1e-9);
}

TEST(Results, SizeOfAnIncrementIsThatOfTheNodeThatMovesMost) {
  const auto model = mixture();
  System system(model);
  for (std::size_t node = 0; node < model.nodes.size(); ++node) {
    const int block = system.dof_map().displacement_block[node];
    if (block < 0) continue;
    std::vector<double> x(static_cast<std::size_t>(system.n_dofs()), 0.0);
    for (int c = 0; c < 3; ++c) x[static_cast<std::size_t>(3 * block + c)] = c + 1;
    if (const int turn = system.dof_map().rotation_block[node]; turn >= 0)
      x[static_cast<std::size_t>(3 * turn)] = 100;  // is no motion of a place
    EXPECT_NEAR(system.relative_size(distributed(system, x)), std::sqrt(14.0) / system.size(), 1e-15) << node;
  }
}

TEST(Results, OutOfBalanceTellsMomentsAndForcesOfWhatIsReleased) {
  // A beam whose tip was sunk and turned, then let go: E I / L^3 (12 w + 6 L t), E I / L^2 (6 w + 4 L t).
  const double length = 2, bending = 2e3, w = -1e-5, t = 3e-5;
  auto model = cantilever(1, length, {1e6, bending, 3e3, 1e3, 0, 0, 2, 0, 0});
  model.nodes.emplace_back(5, 0, 0);  // another, that keeps still
  model.nodes.emplace_back(7, 0, 0);
  add_beam(model, 0, 2, 3);
  System system(model);
  model::Load move;
  move.name = "move";
  move.nodes = {1};
  move.displacement = Vec3(0, 0, w);
  move.rotation = Vec3(0, -t, 0);  // turns x towards z
  const auto root = support({0, 2, 3}, clamped);
  solve(system, {{root, support({1}, clamped)}, {move}});
  const double force = bending * (12 * w - 6 * length * t) / std::pow(length, 3),
               moment = bending * (-6 * w + 4 * length * t) / std::pow(length, 2);
  EXPECT_NEAR(system.reactions().force[1].z(), force, 1e-4 * std::abs(force));
  const auto released = system.begin_stage({{root}, {}});
  EXPECT_NEAR(released.force, std::abs(force), 1e-4 * std::abs(force));
  EXPECT_NEAR(released.moment, std::abs(moment), 1e-4 * std::abs(moment));
  EXPECT_EQ(released.node, 1);
  EXPECT_NEAR(released.before, released.force, 1e-12 * released.force);
  const auto loaded = system.begin_stage({{root}, {load(1, {0, 0, -2 * force})}});
  EXPECT_NEAR(loaded.force, std::abs(3 * force), 1e-3 * std::abs(force)) << "with what will act";
}

TEST(Results, NormsComeWithForcesAndMomentsToCompareWith) {
  // A cable alone: no moments; force times 1e-3 of the size stands in.
  model::Model cable;
  cable.nodes = {{0, 0, 0}, {3, 4, 0}};
  add_cable(cable, add_cable_group(cable, "cord", 1000), 0, 1, 0.01);
  System pulled(cable);
  pulled.begin_stage({{support({0})}, {}});
  la::Vector f(pulled.layout()), zero(pulled.layout());
  pulled.residual(zero, f);
  auto norms = pulled.norms(f);
  const double all = std::sqrt(2.0) * 10;  // 10 N at both ends
  EXPECT_NEAR(norms.reference_force, all, 1e-10);
  EXPECT_NEAR(norms.reference_moment, 1e-3 * 5 * all, 1e-12);

  // A beam that a moment bends to an arc: no forces; moment over size stands in.
  System bent(cantilever(1, 5, {1e9, 40, 100, 30, 0, 0, 1, 0, 0}));
  solve(bent, clamped_root(load(1, Vec3::Zero(), {0, 0, 1e-3})));
  bent.restart();
  la::Vector g(bent.layout()), still(bent.layout());
  bent.residual(still, g);
  norms = bent.norms(g);
  EXPECT_NEAR(norms.reference_moment, std::sqrt(2.0) * 1e-3, 1e-7);
  EXPECT_NEAR(norms.reference_force, norms.reference_moment / 5, 1e-4 * norms.reference_moment);
  EXPECT_LT(norms.moment, 1e-9);
}

TEST(Results, NormsOfAResidualAreThoseOverNodes) {
  const auto model = mixture();
  System system(model);
  std::vector<double> all(static_cast<std::size_t>(system.n_dofs()));
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = 1 + static_cast<double>(i);
  double force = 0, moment = 0;
  const auto add = [&](int block, double& sum) {
    for (int c = 0; block >= 0 && c < 3; ++c) sum += std::pow(1 + 3 * block + c, 2);
  };
  for (const int block : system.dof_map().displacement_block) add(block, force);
  for (const int block : system.dof_map().rotation_block) add(block, moment);
  const auto norms = system.norms(distributed(system, all));
  EXPECT_NEAR(norms.force, std::sqrt(force), 1e-12 * norms.force);
  EXPECT_NEAR(norms.moment, std::sqrt(moment), 1e-12 * norms.moment);
}

TEST(Mass, OfTheMixtureMovesAsAWholeWithItsWholeMass) {
  const auto model = mixture();
  System system(model);
  for (const auto kind : {MassKind::consistent, MassKind::lumped})
    for (int c = 0; c < 3; ++c) {
      std::vector<double> field(static_cast<std::size_t>(system.n_dofs()), 0.0);
      for (const int block : system.dof_map().displacement_block)
        if (block >= 0) field[static_cast<std::size_t>(3 * block + c)] = 1;
      const auto x = distributed(system, field);
      la::Vector y(system.layout());
      system.mass(kind).multiply(x, y);
      EXPECT_NEAR(x.dot(y), model::total_mass(model), 1e-11 * model::total_mass(model));
    }
}

/// Twice the kinetic energy of a spin of one rad/s: m L^2 / 3, and half of the mass at the tip where masses
/// are gathered at the nodes; the sections' own inertia beside it.
TEST(Mass, OfARodTurningAboutItsEndIsOneThird) {
  const double length = 3, rho = 2, i2 = 0.01, i3 = 0.02;
  System system(cantilever(1, length, {1e7, 2e4, 1e4, 5e3, 0, 0, rho, i2, i3}));
  const auto energy = [&](const Vec3& spin, MassKind kind) {
    std::vector<double> field(static_cast<std::size_t>(system.n_dofs()), 0.0);
    for (std::size_t node = 0; node < 2; ++node) {
      const Vec3 v = spin.cross(system.model().nodes[node]);
      for (int c = 0; c < 3; ++c) {
        field[static_cast<std::size_t>(3 * system.dof_map().displacement_block[node] + c)] = v[c];
        field[static_cast<std::size_t>(3 * system.dof_map().rotation_block[node] + c)] = spin[c];
      }
    }
    const auto x = distributed(system, field);
    la::Vector y(system.layout());
    system.mass(kind).multiply(x, y);
    return x.dot(y);
  };
  const double third = rho * std::pow(length, 3) / 3, half = rho * std::pow(length, 3) / 2;
  EXPECT_NEAR(energy({1, 0, 0}, MassKind::consistent), (i2 + i3) * length, 1e-12);
  EXPECT_NEAR(energy({0, 1, 0}, MassKind::consistent), third + i2 * length, 1e-11);
  EXPECT_NEAR(energy({0, 0, 1}, MassKind::consistent), third + i3 * length, 1e-11);
  EXPECT_NEAR(energy({1, 0, 0}, MassKind::lumped), (i2 + i3) * length, 1e-12);
  EXPECT_NEAR(energy({0, 1, 0}, MassKind::lumped), half + i2 * length, 1e-11) << "half of it at the tip";
  EXPECT_NEAR(energy({0, 0, 1}, MassKind::lumped), half + i3 * length, 1e-11);
}

TEST(Mass, OfABodyOnANodeTurnsWithIt) {
  model::Model model;
  model.nodes = {{0, 0, 0}, {1, 0, 0}};
  const int rod = add_beam_group(model, "rod");
  model.groups[rod].beam.mass_per_length = 0;
  model.groups[rod].beam.rotary_inertia_2 = model.groups[rod].beam.rotary_inertia_3 = 0;
  add_beam(model, rod, 0, 1);
  auto& body = model.groups.emplace_back();
  body.name = "body";
  body.kind = model::ElementKind::mass;
  body.mass.mass = 7;
  body.mass.inertia = Vec3(1, 2, 5);
  model.masses.push_back({{1}, 1});
  System system(model);
  const Mat3 turn = rotation_of({0.3, -0.8, 0.5});
  auto state = model::State::reference(model);
  state.rotation[1] = turn;
  system.set_state(state);
  const auto energy = [&](const Vec3& spin) {
    std::vector<double> field(static_cast<std::size_t>(system.n_dofs()), 0.0);
    for (int c = 0; c < 3; ++c)
      field[static_cast<std::size_t>(3 * system.dof_map().rotation_block[1] + c)] = spin[c];
    const auto x = distributed(system, field);
    la::Vector y(system.layout());
    system.mass().multiply(x, y);
    return x.dot(y);
  };
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(energy(turn.col(c)), Vec3(1, 2, 5)[c], 1e-13);
}

}  // namespace
}  // namespace tautline::assembly
