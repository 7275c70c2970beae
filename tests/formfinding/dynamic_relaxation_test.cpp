#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <formfinding/elastic_nets.hpp>
#include <limits>
#include <tautline/formfinding/dynamic_relaxation.hpp>
#include <tautline/formfinding/force_density.hpp>
#include <tautline/formfinding/minimal_film.hpp>

namespace tautline::formfinding {
namespace {

DynamicRelaxationOptions with(Damping damping) {
  DynamicRelaxationOptions options;
  options.damping = damping;
  return options;
}

class EachDamping : public testing::TestWithParam<Damping> {};
INSTANTIATE_TEST_SUITE_P(DynamicRelaxation, EachDamping, testing::Values(Damping::kinetic, Damping::viscous));

TEST_P(EachDamping, LoadedPairComesToRestWhereStaticsSays) {
  const RelaxationResult result = relax(elastic_pair(), with(GetParam()));
  ASSERT_TRUE(result.converged) << result.reason;
  EXPECT_LE((result.nodes[0] - Vec3(0, 0, -1.5)).norm(), 1e-7);
  EXPECT_LE((result.tension - Eigen::Vector2d(5, 5)).norm(), 1e-6);
}

TEST_P(EachDamping, ConstantTensionsGiveTheShapeOfTheForceDensityMethod) {
  Net net = triangular_net(4, 0.5, Dish(2));
  for (std::size_t i = 0; i < net.nodes.size(); ++i)
    if (!net.fixed[i])
      net.nodes[i] = Vec3(0, 0, 1) + 0.01 * Vec3(static_cast<double>(i % 7), static_cast<double>(i % 5), 0);
  const VecX tension = VecX::Constant(net.branches.size(), 8);
  const ForceDensityResult expected = find_tensions(net, tension, nullptr, {});
  ASSERT_TRUE(expected.converged) << expected.reason;
  net.nodes = solve_linear(net, VecX::Constant(net.branches.size(), 10));
  const RelaxationResult result = relax({net, {}, {}, tension}, with(GetParam()));
  ASSERT_TRUE(result.converged) << result.reason;
  for (std::size_t i = 0; i < net.nodes.size(); ++i)
    EXPECT_LE((result.nodes[i] - expected.nodes[i]).norm(), 1e-6) << i;
}

TEST_P(EachDamping, GuidedNodeReflectsEqualTensions) {
  // The mirror image of (2, 2) lies on the straight line from (-1, 1) through (0, 0).
  ElasticNet net;
  net.net = star({{-1, 1, 0}, {2, 2, 0}});
  net.net.nodes[0] = Vec3(0.6, 5, 1);
  net.net.guides = {{0, Guide::Kind::line, Vec3(7, 0, 0), Vec3::UnitX()}};
  net.tension = Eigen::Vector2d(3, 3);
  const RelaxationResult result = relax(net, with(GetParam()));
  ASSERT_TRUE(result.converged) << result.reason;
  EXPECT_LE(result.nodes[0].norm(), 1e-7);
}

TEST_P(EachDamping, GuidedNodeStartsAtTheNearestPlaceOnItsGuide) {
  ElasticNet net;
  net.net = star({{-1, 1, 0}, {2, 2, 0}});
  net.net.nodes[0] = Vec3(0.6, 5, 1);
  net.tension = Eigen::Vector2d(3, 3);
  DynamicRelaxationOptions options = with(GetParam());
  options.max_iterations = 0;
  const Vec3 along(1, 2, 2), point(7, 0, 0), off = net.net.nodes[0] - point;
  net.net.guides = {{0, Guide::Kind::line, point, along}};
  EXPECT_LE((relax(net, options).nodes[0] - (point + along * along.dot(off) / 9)).norm(), 1e-14);
  net.net.guides = {{0, Guide::Kind::plane, point, along}};
  EXPECT_LE((relax(net, options).nodes[0] - (point + off - along * along.dot(off) / 9)).norm(), 1e-14);
}

TEST_P(EachDamping, FilmWithEdgeCablesComesToRestAsTheMinimalFilm) {
  ElasticNet net;
  net.film = add_film_grid(6, net.net, 1);
  net.tension = VecX::Constant(net.net.branches.size(), 3);
  const FilmResult film = find_minimal_film({net.net, net.film, net.tension, {}});
  ASSERT_TRUE(film.converged) << film.reason;
  DynamicRelaxationOptions options = with(GetParam());
  options.tolerance = 1e-7;
  const RelaxationResult result = relax(net, options);
  ASSERT_TRUE(result.converged) << result.reason;
  // Nodes may have slid along the film on different ways. Energy, stress x area + tension x length, has its
  // minimum there and feels that in second order only.
  const auto energy = [&](const Points& nodes) {
    double sum = 0;
    for (const auto& facet : net.film) {
      const auto& n = facet.nodes;
      sum += 0.5 * (nodes[n[1]] - nodes[n[0]]).cross(nodes[n[2]] - nodes[n[0]]).norm();
    }
    for (const auto& [a, b] : net.net.branches) sum += 3 * (nodes[b] - nodes[a]).norm();
    return sum;
  };
  EXPECT_NEAR(energy(result.nodes), energy(film.nodes), 1e-5 * energy(film.nodes));
  EXPECT_LT(energy(film.nodes), 0.99 * energy(net.net.nodes));
}

/// Where the structure stands does not matter: the same steps, a thousand metres away.
TEST_P(EachDamping, FilmComesToRestInTheSameStepsWhereverItIs) {
  const auto steps = [&](const Vec3& offset) {
    ElasticNet net;
    net.film = add_film_grid(4, net.net, 1);
    for (Vec3& node : net.net.nodes) node += offset;
    net.tension = VecX::Constant(net.net.branches.size(), 3);
    DynamicRelaxationOptions options = with(GetParam());
    options.tolerance = 1e-7;
    const RelaxationResult result = relax(net, options);
    EXPECT_TRUE(result.converged) << result.reason;
    return result.iterations;
  };
  const int here = steps(Vec3::Zero());
  EXPECT_NEAR(steps({1000, -2000, 500}), here, 0.02 * here + 2);
}

/// Edge cables that pull too little: the film draws its corners' edges together.
TEST_P(EachDamping, FilmWhoseEdgesDoNotHoldItIsToldNotReturned) {
  ElasticNet net;
  net.film = add_film_grid(4, net.net, 1);
  net.tension = VecX::Constant(net.net.branches.size(), 1e-3);
  const RelaxationResult result = relax(net, with(GetParam()));
  EXPECT_FALSE(result.converged);
  EXPECT_NE(result.reason.find("nodes of the film ran together"), std::string::npos) << result.reason;
}

TEST(DynamicRelaxation, PeriodIsThatOfTheOscillator) {
  // One node between two springs k along their axis: K = 2 k, M = 1.1 K / 2, omega^2 = 2 / 1.1.
  ElasticNet net;
  net.net = star({{-1, 0, 0}, {1, 0, 0}});
  net.net.load = {{1, 0, 0}, Vec3::Zero(), Vec3::Zero()};
  net.axial_stiffness = VecX::Constant(2, 100);
  net.unstressed_length = VecX::Constant(2, 0.9);
  const RelaxationResult result = relax(net, with(Damping::viscous));
  ASSERT_TRUE(result.converged) << result.reason;
  EXPECT_NEAR(result.nodes[0].x(), 0.9 / 200, 1e-10);
  EXPECT_NEAR(result.period, 2 * M_PI / std::sqrt(2 / 1.1), 0.01);
}

TEST(DynamicRelaxation, StopsWithAReason) {
  DynamicRelaxationOptions options;
  options.max_iterations = 3;
  const RelaxationResult result = relax(elastic_pair(), options);
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.reason.rfind("stopped after 3 steps: largest force out of balance", 0), 0u)
      << result.reason;
}

TEST(ElasticNet, NewtonFindsTheLoadedPair) {
  const ElasticResult result = find_elastic_equilibrium(elastic_pair());
  ASSERT_TRUE(result.converged) << result.reason;
  EXPECT_LE((result.nodes[0] - Vec3(0, 0, -1.5)).norm(), 1e-10);
  EXPECT_LE(result.iterations, 15);
}

TEST(ElasticNet, NewtonFindsItFromAStartWithoutAnyTension) {
  ElasticNet net = elastic_pair();
  net.net.nodes[0] = Vec3::Zero();  // both slack: no stiffness at all
  const ElasticResult result = find_elastic_equilibrium(net);
  ASSERT_TRUE(result.converged) << result.reason;
  EXPECT_LE((result.nodes[0] - Vec3(0, 0, -1.5)).norm(), 1e-10);
}

/// The force of whatever keeps its tension, or its force density, with the energies T L and q L^2 / 2: found
/// from far away, where whole steps would overshoot.
TEST(ElasticNet, NewtonFindsTensionsAndForceDensitiesFromAfar) {
  for (const Vec3& start : {Vec3(0, 0, 3), Vec3(30, 20, 10), Vec3(-1.9, 0.1, -0.2), Vec3(0, 0, -1e-3)}) {
    ElasticNet net = elastic_pair();
    net.net.nodes[0] = start;
    net.tension = Eigen::Vector2d(5, 5);
    const ElasticResult tense = find_elastic_equilibrium(net);
    ASSERT_TRUE(tense.converged) << start.transpose() << ": " << tense.reason;
    EXPECT_LE((tense.nodes[0] - Vec3(0, 0, -1.5)).norm(), 1e-8) << start.transpose();

    net.tension = {};
    net.axial_stiffness = net.unstressed_length = {};
    net.force_density = Eigen::Vector2d(2, 2);  // T / L = 5 / 2.5
    const ElasticResult dense = find_elastic_equilibrium(net);
    ASSERT_TRUE(dense.converged) << start.transpose() << ": " << dense.reason;
    EXPECT_LE((dense.nodes[0] - Vec3(0, 0, -1.5)).norm(), 1e-10);
    EXPECT_LE(dense.iterations, 1) << "linear";
  }
}

TEST(ElasticNet, SlackCableCarriesNothing) {
  // A third cable, 4 m long, to a support 2.5 m from the node.
  ElasticNet net = elastic_pair();
  net.net.branches.push_back({0, 3});
  net.net.nodes.push_back(Vec3(0, 2, 0));
  net.net.fixed.push_back(true);
  net.net.load.push_back(Vec3::Zero());
  net.axial_stiffness = VecX::Constant(3, 1000);
  net.unstressed_length = Vec3(2.5 / 1.005, 2.5 / 1.005, 4);
  const ElasticResult result = find_elastic_equilibrium(net);
  ASSERT_TRUE(result.converged) << result.reason;
  EXPECT_EQ(result.n_slack, 1);
  EXPECT_EQ(result.tension[2], 0);
  EXPECT_LE((result.nodes[0] - Vec3(0, 0, -1.5)).norm(), 1e-10);
}

TEST(ElasticNet, InputThatMakesNoSenseIsNamed) {
  ElasticNet net = elastic_pair();
  net.unstressed_length[1] = 0;
  EXPECT_EQ(error_of([&] { relax(net); }),
            "the axial stiffness and unstressed length of branch 2 must be positive");
  net = elastic_pair();
  net.film = {{{0, 1, 3}, {1, 1}}};  // one beyond the last
  EXPECT_EQ(error_of([&] { relax(net); }), "facet 1 of the film names node 4, but the net has 3 nodes");
}

}  // namespace
}  // namespace tautline::formfinding
