#include <cmath>
#include <numbers>
#include <tautline/assembly/system.hpp>
#include <tautline/la/session.hpp>
#include <tautline/model/response.hpp>

#include "assembly/dense.hpp"
#include "assembly/models.hpp"

namespace tautline::assembly {
namespace {

using namespace testing_models;

double tension(const System& system, int cable) {
  return model::evaluate_response(system.model(), system.state()).cables[cable].tension;
}

TEST(System, StretchesACableByItsLoad) {
  model::Model model;
  model.nodes = {{0, 0, 0}, {0, 0, -2}};
  add_cable(model, add_cable_group(model, "cord", 1000), 0, 1, 0.01);
  System system(model);
  const Boundary boundary{{support({0})}, {load(1, {0, 0, -30})}};
  solve(system, boundary);
  const double length = 2 / 1.01 * (1 + 30.0 / 1000);
  EXPECT_NEAR(system.state().displacement[1].z(), 2 - length, 1e-12);
  EXPECT_LT((system.reactions().force[0] - Vec3(0, 0, 30)).norm(), 1e-10);
  EXPECT_EQ(system.reactions().force[1], Vec3::Zero()) << "a free node has no reaction";
}

/// Two cables of reference length 1 m in a line, E A = 1e4 N, tension 50 N.
model::Model two_cables() {
  model::Model model;
  model.nodes = {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}};
  const int cord = add_cable_group(model, "cord", 1e4);
  add_cable(model, cord, 0, 1, 5e-3);
  add_cable(model, cord, 1, 2, 5e-3);
  return model;
}

/// Sag w with 2 N sin(angle) = load, N = E A (l / L0 - 1), by Newton's method for one unknown.
double sag(double load) {
  const double ea = 1e4, rest = 1 / 1.005;
  double w = 0.1;
  for (int i = 0; i < 60; ++i) {
    const double l = std::hypot(1, w), n = ea * (l / rest - 1);
    w -= (2 * n * w / l - load) / (2 * ea * (w / l) * (w / l) / rest + 2 * n / (l * l * l));
  }
  return w;
}

TEST(System, HoldsANodeBetweenTwoPrestressedCables) {
  for (const double force : {0.1, 20.0, 3000.0}) {
    System system(two_cables());
    solve(system, {{support({0, 2})}, {load(1, {0, 0, -force})}});
    const Vec3 u = system.state().displacement[1];
    EXPECT_NEAR(u.z(), -sag(force), 1e-9 * sag(force)) << "load " << force;
    EXPECT_NEAR(u.x(), 0, 1e-12);
    EXPECT_NEAR(u.y(), 0, 1e-12);
  }
}

TEST(System, NeedsNoIterationWhereItIsInEquilibrium) {
  System system(two_cables());
  const auto summary = solve(system, {{support({0, 2})}, {}});
  EXPECT_EQ(summary.newton_iterations, 0);
  EXPECT_EQ(summary.inertia.negative, 0);
  EXPECT_LT((system.reactions().force[0] - Vec3(-50, 0, 0)).norm(), 1e-10);
}

/// Two cables in a line, the left one 1 mm short, the right one 1 cm too long: pushed to the left the
/// carriage crosses the gap in which neither pulls.
TEST(System, CrossesTheGapBetweenTwoSlackCables) {
  for (const double force : {-40.0, -5.0, 5.0}) {
    model::Model model;
    model.nodes = {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}};
    const int cord = add_cable_group(model, "cord", 1000);
    add_cable(model, cord, 0, 1, 1 / 0.999 - 1);
    add_cable(model, cord, 1, 2, 1 / 1.01 - 1);
    System system(model);
    solve(system, {{support({0, 2}), support({1}, {false, true, true, false, false, false})},
                   {load(1, {force, 0, 0})}});
    const double left = -0.001 + 0.999 * force / 1000, right = -0.01 + 1.01 * force / 1000;
    EXPECT_NEAR(system.state().displacement[1].x(), force > 0 ? left : right, 1e-12) << force;
  }
}

/// A line of two different cables: 1 m at 20 N and 2 m at 10 N, E A = 1000 N, with the node between them
/// held.
model::Model uneven_cables() {
  model::Model model;
  model.nodes = {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}};
  const int cord = add_cable_group(model, "cord", 1000);
  add_cable(model, cord, 0, 1, 0.02);
  add_cable(model, cord, 1, 2, 0.01);
  return model;
}

TEST(Stage, BeginsWithTheReactionsOfTheSupportsItReleases) {
  System system(uneven_cables());
  solve(system, {{support({0, 1, 2})}, {}});
  EXPECT_LT((system.reactions().force[1] - Vec3(10, 0, 0)).norm(), 1e-10)
      << "20 N to the left against 10 N to the right";
  const auto unbalanced = system.begin_stage({{support({0, 2})}, {}});
  EXPECT_NEAR(unbalanced.force, 10, 1e-10);
  EXPECT_EQ(unbalanced.node, 1);
  EXPECT_EQ(unbalanced.moment, 0);
}

TEST(Stage, ThatReleasesASupportEndsWithEqualTensions) {
  System system(uneven_cables());
  solve(system, {{support({0, 1, 2})}, {}});
  solve(system, {{support({0, 2})}, {}});
  // Equal strains: the node parts the span of 3 m as the unstressed lengths.
  const double first = 1 / 1.02, second = 2 / 1.01;
  EXPECT_NEAR(1 + system.state().displacement[1].x(), 3 * first / (first + second), 1e-12);
  EXPECT_NEAR(tension(system, 0), tension(system, 1), 1e-9);
}

TEST(Stage, EndsInTheSameStateInOneStepAndInSmallSteps) {
  const Boundary held{{support({0, 1, 2})}, {}};
  const Boundary released{{support({0, 2})}, {load(1, {0, 3, -8})}};
  System once(uneven_cables()), often(uneven_cables());
  solve(once, held);
  solve(often, held);
  const auto summary = solve(once, released);
  EXPECT_EQ(summary.points.size(), 1u);
  solve_in_steps(often, released, 20);
  EXPECT_LT((once.state().displacement[1] - often.state().displacement[1]).norm(), 1e-9);
}

TEST(Stage, ReachesTheStrainsAskedFor) {
  System system(uneven_cables());
  system.set_target_strains({0.05, 0.04});
  solve(system, {{support({0, 2})}, {}});
  EXPECT_EQ(system.model().cables[0].initial_strain, 0.05);
  EXPECT_EQ(system.model().cables[1].initial_strain, 0.04);
  const double first = 1 / 1.05, second = 2 / 1.04;
  EXPECT_NEAR(1 + system.state().displacement[1].x(), 3 * first / (first + second), 1e-12);
  EXPECT_NEAR(tension(system, 0), 1000 * (3 / (first + second) - 1), 1e-9);
}

TEST(Stage, BegunHalfWayThroughAnotherStartsFromTheStrainsReachedThere) {
  const Boundary boundary{{support({0, 2})}, {}};
  System system(uneven_cables());
  solve(system, boundary);
  system.set_target_strains({0.05, 0.04});
  system.begin_stage(boundary);
  system.set_lambda(0.5);
  analysis::Workspace workspace{system.new_matrix(), la::DirectSolver()};
  ASSERT_TRUE(analysis::solve_newton(system, workspace, {}).converged());
  system.commit();
  EXPECT_LT(system.begin_stage(boundary).force, 1e-8);
  solve(system, boundary);
  EXPECT_NEAR(system.model().cables[0].initial_strain, 0.035, 1e-15);
  EXPECT_NEAR(system.model().cables[1].initial_strain, 0.025, 1e-15);
}

TEST(Stage, ThatIsRolledBackIsWhereItWasCommitted) {
  System system(two_cables());
  const Boundary boundary{{support({0, 2})}, {load(1, {0, 0, -20})}};
  solve(system, boundary);
  const auto kept = system.state().displacement[1];
  la::Vector x(system.layout());
  std::vector<double> ones(static_cast<std::size_t>(3 * system.layout().local), 0.25);
  x.write(ones);
  system.restart();
  system.accept(x);
  EXPECT_EQ(system.state().displacement[1], kept + Vec3::Constant(0.25));
  system.roll_back();
  EXPECT_EQ(system.state().displacement[1], kept);
}

TEST(Acceleration, StretchesAHangingChainByTheWeightBelow) {
  // Half of each link's weight goes to either end, so a link carries the links below it and half of itself.
  const int links = 8;
  const double h = 0.5, ea = 2000, rho = 3, g = 9.81, strain = 1e-3;
  model::Model model;
  for (int i = 0; i <= links; ++i) model.nodes.emplace_back(0, 0, -h * i);
  const int chain = add_cable_group(model, "chain", ea, rho * (1 + strain));  // rho h for each drawn link
  for (int i = 0; i < links; ++i) add_cable(model, chain, i, i + 1, strain);
  System system(model);
  solve(system, {{support({0})}, {weight({0, 0, -g})}});
  double end = 0;
  for (int i = 0; i < links; ++i) {
    const double force = rho * g * h * (links - i - 0.5);
    EXPECT_NEAR(tension(system, i), force, 1e-8 * force);
    end -= h / (1 + strain) * (1 + force / ea);
    EXPECT_NEAR(model.nodes[i + 1].z() + system.state().displacement[i + 1].z(), end, 1e-10);
  }
  EXPECT_NEAR(system.reactions().force[0].z(), rho * g * h * links, 1e-8) << "the whole weight";
}

element::BeamSection slender() {
  return {1e9, 40, 100, 30, 0, 0, 1, 0, 0};
}

TEST(Cantilever, BendsByTheCubeOfItsLengthUnderASmallTipLoad) {
  const double length = 2, force = 1e-4;
  for (const bool shear : {false, true}) {
    auto section = slender();
    if (shear) section.shear_stiffness_2 = 300, section.shear_stiffness_3 = 200;
    for (const int axis : {1, 2}) {  // a load along local axis 2 bends about 3 and the other way round
      System system(cantilever(4, length, section));
      Vec3 direction = Vec3::Unit(axis);
      solve(system, clamped_root(load(4, force * direction)));
      const double bending = axis == 1 ? section.bending_stiffness_3 : section.bending_stiffness_2;
      const double shearing = axis == 1 ? section.shear_stiffness_2 : section.shear_stiffness_3;
      const double exact =
          force * std::pow(length, 3) / (3 * bending) + (shear ? force * length / shearing : 0);
      // The square of the slope, 1e-10, is what the linear formula leaves out.
      EXPECT_NEAR(system.state().displacement[4][axis], exact, 1e-8 * exact)
          << "axis " << axis << " shear " << shear;
    }
  }
}

TEST(Cantilever, CarriesItsTipLoadToTheRoot) {
  const double length = 2, force = 1e-4;
  System system(cantilever(4, length, slender()));
  solve(system, clamped_root(load(4, {0, 0, force})));
  const auto reactions = system.reactions();
  EXPECT_LT((reactions.force[0] - Vec3(0, 0, -force)).norm(), 1e-9 * force);
  EXPECT_LT((reactions.moment[0] - Vec3(0, force * length, 0)).norm(), 1e-8 * force * length);
}

TEST(Cantilever, FollowsTheElastica) {
  // P L^2 / E I = 1: w / L and u / L from the elliptic integrals (Mattiasson 1981, Int. J. Num. Meth. Eng.
  // 17, 145-153).
  const double length = 2, bending = 40, force = bending / (length * length);
  System system(cantilever(16, length, slender()));
  solve(system, clamped_root(load(16, {0, 0, -force})));
  const Vec3 tip = system.state().displacement[16];
  EXPECT_NEAR(-tip.z() / length, 0.3017207738, 1e-3 * 0.3017207738);
  EXPECT_NEAR(-tip.x() / length, 0.05643323628, 1e-3 * 0.05643323628);
  EXPECT_NEAR(tip.y(), 0, 1e-12);
  EXPECT_NEAR(system.reactions().moment[0].y(), -force * (length + tip.x()), 1e-6 * force * length)
      << "the load at its arm in the bent state";
}

TEST(Cantilever, RollsIntoACircleUnderATipMoment) {
  // A moment pi E I / L bends it to a half circle of radius L / pi. No force acts, so that any E A will do.
  const double length = 2, bending = 40, moment = std::numbers::pi * bending / length;
  auto section = slender();
  section.axial_stiffness = 1e5;
  System system(cantilever(16, length, section));
  solve(system, clamped_root(load(16, Vec3::Zero(), {0, moment, 0})));
  const Vec3 tip = system.model().nodes[16] + system.state().displacement[16];
  EXPECT_NEAR(tip.x(), 0, 5e-3 * length);
  EXPECT_NEAR(tip.z(), -2 * length / std::numbers::pi, 5e-3 * length);
  EXPECT_LT(
      (system.state().rotation[16] - Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitY()).toRotationMatrix())
          .norm(),
      1e-6);
}

/// Cloth, cables and beams together: two_facets() with its anchors clamped.
Boundary mixed_boundary() {
  return {{support({3, 4}, clamped), support({2}, pinned)},
          {load(1, {20, -10, -40}), load(0, {5, 3, -10}, {1, 2, -1})}};
}

TEST(System, BalancesLoadsByReactionsInForceAndMoment) {
  System system(two_facets());
  const auto boundary = mixed_boundary();
  solve(system, boundary);
  const auto sum = resultant(system, boundary);
  EXPECT_LT(sum.force.norm(), 1e-6) << "of forces of some thousand newton";
  EXPECT_LT(sum.moment.norm(), 1e-6);
  EXPECT_GT(system.state().displacement[1].norm(), 1e-4) << "the answer is not that nothing moves";
}

TEST(Tangent, OfCableBeamAndClothTogetherIsTheDerivativeOfTheResidual) {
  System system(two_facets());
  system.begin_stage({{support({3}, pinned)}, {}});
  system.set_state(some_state(system.model()));
  // Moments conjugate to spins have an antisymmetric part away from equilibrium, which the tangent leaves
  // out.
  expect_tangent_is_derivative_of_residual(system);
}

TEST(SecondVariation, IsTheQuadraticFormOfTheTangent) {
  System system(two_facets());
  system.begin_stage({{support({3}, pinned)}, {}});
  system.set_state(some_state(system.model()));
  const MatX tangent = dense_tangent(system);
  std::vector<double> values(static_cast<std::size_t>(system.n_dofs()));
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = system.held()[i] ? 0 : std::sin(1.3 * static_cast<double>(i) + 0.4);
  const auto& layout = system.layout();
  la::Vector x(layout);
  x.write(std::span(values).subspan(3 * layout.first, 3 * layout.local));
  const Eigen::Map<const VecX> v(values.data(), system.n_dofs());
  const double expected = v.dot(tangent * v);
  EXPECT_NEAR(system.second_variation(x), expected, 1e-12 * tangent.norm() * v.squaredNorm());
}

TEST(Mass, OfARigidTranslationIsThatOfTheStructure) {
  System system(two_facets());
  const auto mass = system.mass();
  const auto& layout = system.layout();
  std::vector<double> field(static_cast<std::size_t>(system.n_dofs()), 0.0);
  for (const int block : system.dof_map().displacement_block)
    field[static_cast<std::size_t>(3 * block + 1)] = 1;
  la::Vector x(layout), y(layout);
  x.write(std::span(field).subspan(3 * layout.first, 3 * layout.local));
  mass.multiply(x, y);
  EXPECT_NEAR(x.dot(y), model::total_mass(system.model()), 1e-12 * model::total_mass(system.model()));
}

TEST(Mass, HasNoRowsOfHeldUnknowns) {
  System system(two_facets());
  system.begin_stage({{support({0, 1, 2, 3, 4}, clamped)}, {}});
  EXPECT_EQ(system.mass().norm_of_diagonal(), 0);
}

TEST(System, GivesAVectorsBlocksToTheirNodes) {
  System system(two_facets());
  const auto& map = system.dof_map();
  std::vector<double> values(static_cast<std::size_t>(system.n_dofs()));
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i);
  la::Vector x(system.layout());
  x.write(std::span(values).subspan(3 * system.layout().first, 3 * system.layout().local));
  const auto field = system.nodal(x);
  for (std::size_t node = 0; node < 5; ++node) {
    EXPECT_EQ(field.displacement[node], Vec3(0, 1, 2) + Vec3::Constant(3 * map.displacement_block[node]));
    const Vec3 rotation = map.rotation_block[node] < 0
                              ? Vec3::Zero()
                              : Vec3(Vec3(0, 1, 2) + Vec3::Constant(3 * map.rotation_block[node]));
    EXPECT_EQ(field.rotation[node], rotation);
  }
}

}  // namespace
}  // namespace tautline::assembly
