// What linear responses do: strains, pulls of cables, stresses on a ray, and what a stage imposes.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <tautline/core/rotation.hpp>

#include "assembly/dense.hpp"
#include "assembly/mixture.hpp"

namespace tautline::assembly {
namespace {

using namespace testing_models;

/// A cable, a bar and a catenary from the origin to x = 2, 4 and 5, E A = 1000 N, strains 1, 2 and 3 %.
model::Model three_lines(double mass_per_length = 0) {
  model::Model model;
  model.nodes = {{0, 0, 0}, {2, 0, 0}, {0, 4, 0}, {0, 0, 5}};
  for (const auto& [name, kind] :
       {std::pair{"cord", model::ElementKind::cable}, std::pair{"bar", model::ElementKind::bar},
        std::pair{"line", model::ElementKind::catenary}}) {
    const int group = add_cable_group(model, name, 1000, mass_per_length);
    model.groups[group].kind = kind;
    model.groups[group].thermal_expansion = 1e-5;
    add_cable(model, group, 0, group + 1, 0.01 * (group + 1));
  }
  return model;
}

Boundary held_at_the_origin(const std::vector<model::Load>& loads = {}) {
  return {{support({0})}, loads};
}

/// The three ends pulled outwards by `stretch` and turned about the origin by `spin`.
la::Vector pulled(const System& system, double stretch, const Vec3& spin = Vec3::Zero()) {
  la::Vector x(system.layout());
  for (int node = 1; node < 4; ++node) {
    const Vec3& at = system.model().nodes[static_cast<std::size_t>(node)];
    const Vec3 motion = stretch * at.normalized() + spin.cross(at);
    for (int c = 0; c < 3; ++c) x.add(motion[c], system.mean_motion({node}, Vec3::Unit(c)));
  }
  return x;
}

TEST(Response, PullsAreThoseOfCablesThatOnlyPull) {
  for (const double mass : {0.0, 0.5}) {
    for (const double g : {0.0, 9.81}) {
      System system(three_lines(mass));
      system.begin_stage(
          held_at_the_origin(g > 0 ? std::vector{weight({0, 0, -g})} : std::vector<model::Load>{}));
      const auto pulls = system.pulls(pulled(system, 0.1, {1, 2, 3}), 1e-6);
      const bool sags = mass > 0 && g > 0;  // a catenary that sags is no cable that goes slack
      ASSERT_EQ(pulls.size(), sags ? 1u : 2u);
      EXPECT_EQ(pulls[0].cable, 0);
      EXPECT_NEAR(pulls[0].rest, 10, 1e-10);
      EXPECT_NEAR(pulls[0].rate, 1000 * 1.01 / 2 * 0.1, 1e-5) << "E A / L0 times what it gets longer";
      if (sags) continue;
      EXPECT_EQ(pulls[1].cable, 2);
      EXPECT_NEAR(pulls[1].rest, 30, 1e-10);
      EXPECT_NEAR(pulls[1].rate, 1000 * 1.03 / 5 * 0.1, 1e-5);
    }
  }
}

TEST(Response, PullsPushWhereTheCableWouldBeSlack) {
  auto model = three_lines();
  model.cables[0].initial_strain = -0.01;
  System system(model);
  system.begin_stage(held_at_the_origin());
  const auto pulls = system.pulls(pulled(system, -0.1), 1e-6);
  EXPECT_NEAR(pulls[0].rest, -10, 1e-10);
  EXPECT_NEAR(pulls[0].rate, -1000 * 0.99 / 2 * 0.1, 1e-5);
}

TEST(Response, PullsChangeWithWhatTheStageImposes) {
  System system(three_lines());
  auto heat = on("cord");
  heat.temperature_change = 50;
  system.set_target_strains({0.01, 0.02, 0.035});
  system.begin_stage(held_at_the_origin({heat}));
  const auto pulls = system.pulls(pulled(system, 0), 1e-3);
  EXPECT_NEAR(pulls[0].rate, -1000 * 1.01 * 5e-4, 1e-3) << "- E A alpha dT";
  EXPECT_NEAR(pulls[1].rate, 1000 * 0.005, 1e-3);
}

TEST(Response, LargestStrainsOfGroupsLeaveOutWhatIsFree) {
  System system(three_lines());
  auto heat = on("bar");
  heat.temperature_change = 100;
  system.begin_stage(held_at_the_origin({heat}));
  const auto strains = system.largest_strains(pulled(system, 0.1, {1, 2, 3}));
  ASSERT_EQ(strains.size(), 3u);
  EXPECT_NEAR(strains[0], 0.1 / 2, 1e-12) << "a turn strains nothing";
  EXPECT_NEAR(strains[1], std::abs(0.1 / 4 - 1e-3), 1e-12);
  EXPECT_NEAR(strains[2], 0.1 / 5, 1e-12);
  EXPECT_NEAR(system.largest_strains(pulled(system, -0.1))[1], 0.1 / 4 + 1e-3, 1e-12);
}

TEST(Response, LargestStrainsOfFacetsAreThoseOfTheirSides) {
  const auto model = mixture();
  System system(model);
  auto heat = on("cloth"), warm = on("shell");
  heat.temperature_change = 100;
  warm.temperature_change = -300;
  system.begin_stage({{support({0}, clamped)}, {heat, warm}});
  la::Vector x(system.layout());
  const double e = 0.01;  // stretched along x from the origin
  for (int node = 0; node < 9; ++node) {
    if (node == 6 || node == 8) continue;
    x.add(e * model.nodes[static_cast<std::size_t>(node)].x(), system.mean_motion({node}, Vec3(1, 0, 0)));
  }
  const auto strains = system.largest_strains(x);
  double steepest = 0, flattest = 1;
  for (const auto& [a, b] :
       std::vector<std::array<std::size_t, 2>>{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {1, 4}, {4, 2}, {2, 1}}) {
    const Vec3 side = model.nodes[b] - model.nodes[a];
    const double along = std::pow(side.x() / side.norm(), 2);
    steepest = std::max(steepest, along);
    flattest = std::min(flattest, along);
  }
  EXPECT_NEAR(strains[0], std::max(e * steepest - 1e-3, 1e-3 - e * flattest), 1e-9);
  EXPECT_NEAR(strains[1], e * steepest + 3e-3, 1e-9);
}

TEST(Response, LargestDeformationIsNoLessThanWhatTheStageImposes) {
  const auto model = mixture();
  const auto imposed = [&](const std::vector<model::Load>& loads, std::vector<double> strains = {}) {
    System system(model);
    if (!strains.empty()) system.set_target_strains(std::move(strains));
    system.begin_stage({{support({0, 3}, clamped)}, loads});
    return system.largest_deformation(la::Vector(system.layout()));
  };
  EXPECT_EQ(imposed({}), 0);
  for (const char* name : {"rope", "bar", "line", "rod", "cloth", "shell"}) {
    auto heat = on(name);
    heat.temperature_change = -70;
    EXPECT_NEAR(imposed({heat}), 70e-5, 1e-15) << name;
  }
  auto warm = on("rod");
  warm.temperature_field = [](const Vec3&) { return 1.0; };
  warm.temperature_gradient = [](const Vec3&) { return Vec3(0, 300, 400); };
  const double longest =
      std::max((model.nodes[4] - model.nodes[6]).norm(), (model.nodes[1] - model.nodes[7]).norm());
  EXPECT_NEAR(imposed({warm}), 1e-5 * longest * 500, 1e-12);
  EXPECT_NEAR(imposed({}, {1e-3, -1e-3, -0.2}), 0.12, 1e-15);
}

/// Across a taut cable the tangent is N / l; at lambda on a ray of stretch N has grown by E A lambda e, and
/// the directions are those at rest.
TEST(Response, TangentAtAPlaceOfARayHasTheStressesThere) {
  System system(three_lines());
  system.begin_stage(held_at_the_origin());
  const auto rate = pulled(system, 0.1), way = pulled(system, 0.04);
  const auto across = [&](const la::SymmetricMatrix& k, int node) {
    la::Vector push(system.layout()), force(system.layout());
    const Vec3 sideways = node == 1 ? Vec3(0, 1, 0) : Vec3(1, 0, 0);
    push.add(1, system.mean_motion({node}, sideways));
    k.multiply(push, force);
    return force.dot(push);
  };
  const double length[] = {2, 4, 5};
  for (const double lambda : {0.0, 0.4}) {
    const Ray ray{lambda, &way, &rate, 1e-4};
    const auto there = system.tangent_at(ray), at_rest = system.tangent_towards(ray);
    for (int node = 1; node < 4; ++node) {
      const double l = length[node - 1], tension = 10 * node;
      EXPECT_NEAR(across(at_rest, node), tension / l, 1e-9);
      // d(N / l) = E A / L0 d(1 - L0 / l) = E A dl / l^2
      EXPECT_NEAR(across(there, node), tension / l + lambda * 1000 * 0.1 / (l * l), 1e-4) << node;
    }
  }
}

TEST(Response, CablesStayOnTheBranchTheyAreHeldOn) {
  auto model = three_lines();
  model.cables[0].initial_strain = -0.01;
  System system(model);
  system.begin_stage(held_at_the_origin());
  const auto along = [&](int node) {
    auto k = system.new_matrix();
    system.tangent(k);
    la::Vector push(system.layout()), force(system.layout());
    push.add(1, system.mean_motion({node}, model.nodes[static_cast<std::size_t>(node)].normalized()));
    k.multiply(push, force);
    return force.dot(push);
  };
  EXPECT_EQ(along(1), 0);
  EXPECT_NEAR(along(3), 1000 * 1.03 / 5, 1e-10);
  system.hold_branches({Branch::taut, Branch::own, Branch::slack});
  EXPECT_NEAR(along(1), 1000 * 0.99 / 2, 1e-10);
  EXPECT_NEAR(along(2), 1000 * 1.02 / 4, 1e-10);
  EXPECT_EQ(along(3), 0);
  system.hold_branches({});
  EXPECT_EQ(along(1), 0);
}

TEST(Response, OnlySheetsThatMayWrinkleDo) {
  auto model = mixture();
  EXPECT_FALSE(System(model).may_wrinkle());
  model.groups[0].membrane.wrinkling = true;
  EXPECT_TRUE(System(model).may_wrinkle());
  model.groups[0].membrane.tension_stiffness = 0;  // a stress that nothing changes
  EXPECT_FALSE(System(model).may_wrinkle());
}

/// Warm sheets that a stage warms further and pulls, with or without leave to wrinkle.
model::Model sheets(bool wrinkling) {
  model::Model model;
  model.nodes = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}, {3, 0.5, 0}};
  const int cloth = add_membrane_group(model, "cloth");
  model.groups[cloth].membrane.wrinkling = wrinkling;
  model.groups[cloth].membrane.thermal_expansion = model.groups[cloth].membrane.thermal_expansion_2 = 1e-5;
  model.membranes.push_back({{0, 1, 2, 3}, cloth, Vec3(300, 200, 20)});
  model.membranes.push_back({{1, 4, 2}, cloth, Vec3(300, 200, 20)});
  return model;
}

/// As long as sheets are taut, that they may wrinkle changes nothing: not where a ray begins, not on its way,
/// and not what changes along it.
TEST(Response, TautSheetsAnswerOnARayAsThoseThatCannotWrinkle) {
  const auto answers = [](bool wrinkling) {
    System system(sheets(wrinkling));
    auto cold = on("cloth"), warm = on("cloth");
    cold.temperature_change = -5;
    warm.temperature_change = 3;
    const Boundary all_held{{support({0, 1, 2, 3, 4})}, {cold}};
    solve(system, all_held);
    system.begin_stage({{support({0, 3})}, {warm}});
    la::Vector rate(system.layout()), way(system.layout());
    for (int node = 0; node < 5; ++node) {
      const double x = system.model().nodes[static_cast<std::size_t>(node)].x();
      rate.add(1e-3 * x, system.mean_motion({node}, Vec3(1, 0.2, 0)));
      way.add(1e-5 * x, system.mean_motion({node}, Vec3(1, 0.2, 0)));
    }
    la::Vector push(system.layout());
    push.add(1, system.mean_motion({1, 4}, Vec3(0.3, 1, -2)));
    push.add(1, system.mean_motion({2}, Vec3(-0.7, 0.4, 1)));
    const auto under = [&](const la::SymmetricMatrix& k) {
      la::Vector force(system.layout());
      k.multiply(push, force);
      std::vector<double> all;
      force.gather(all);
      return VecX(Eigen::Map<const VecX>(all.data(), static_cast<Eigen::Index>(all.size())));
    };
    const Ray from_rest{0, nullptr, &rate, 1e-5}, on_the_way{0.01, &way, &rate, 1e-5};
    return std::array{under(system.tangent_towards(from_rest)), under(system.tangent_at(on_the_way)),
                      under(system.stress_change(from_rest))};
  };
  const auto found = answers(true), expected = answers(false);
  EXPECT_LT((found[0] - expected[0]).norm(), 1e-7 * expected[0].norm());
  const double grown = (expected[1] - expected[0]).norm();  // by the stresses on the way
  EXPECT_GT(grown, 1e-6 * expected[0].norm());
  EXPECT_LT((found[1] - expected[1]).norm(), 1e-2 * grown);
  EXPECT_LT((found[2] - expected[2]).norm(), 1e-3 * expected[2].norm());
}

TEST(Stage, SizeOfWhatMovesIsInPartsOfTheStructureAndTurnsWithTheirWeight) {
  auto model = cantilever(1, 4, {1e6, 100, 100, 80, 0, 0, 1, 0, 0});
  System system(model);
  model::Load move;
  move.name = "move";
  move.nodes = {1};
  move.displacement = Vec3(0.3, 0.4, 0);
  move.rotation = Vec3(0, 0, 0.2);
  system.begin_stage({{support({0, 1}, clamped)}, {move}});
  EXPECT_NEAR(system.drive_size(0), 0.25 / 16, 1e-15);
  EXPECT_NEAR(system.drive_size(3), 0.25 / 16 + 3 * 0.04, 1e-12);
  system.begin_stage({{support({0, 1}, clamped)}, {}});
  EXPECT_EQ(system.drive_size(3), 0);
}

TEST(Stage, KnowsWhetherItChangesAnything) {
  const auto model = cantilever(1, 4, {1e6, 100, 100, 80, 0, 0, 1, 0, 0});
  const auto changes = [&](const std::vector<model::Load>& loads) {
    System system(model);
    system.begin_stage({{support({0}, clamped)}, loads});
    return system.changes_at_rest();
  };
  EXPECT_FALSE(changes({}));
  EXPECT_TRUE(changes({load(1, {0, 0, 1e-3})}));
  EXPECT_TRUE(changes({load(1, {0, 0, 0}, {0, 0, 1e-3})}));
  EXPECT_FALSE(changes({load(1, {0, 0, 0})}));
  System system(model);
  model::Load move;
  move.name = "move";
  move.nodes = {0};
  move.displacement = Vec3(0.3, 0.4, 0);
  system.begin_stage({{support({0}, clamped)}, {move}});
  EXPECT_TRUE(system.changes_at_rest());
}

TEST(System, IsBackWhereTheModelBeginsAfterAReset) {
  auto model = cantilever(2, 4, {1e6, 100, 100, 80, 0, 0, 1, 0, 0});
  const int rope = add_cable_group(model, "rope", 1e4);
  model.nodes.emplace_back(4, 0, 3);
  add_cable(model, rope, 2, 3, 0);
  System system(model);
  system.set_target_strains({2e-3});
  const Boundary boundary{{support({0, 3}, clamped)}, {load(1, {0, 0, 1})}};
  solve(system, boundary);
  ASSERT_GT(system.state().displacement[2].norm(), 1e-4);
  system.reset();
  EXPECT_EQ(system.state().displacement[2].norm(), 0);
  EXPECT_EQ(system.state().rotation[2], Mat3(Mat3::Identity()));
  EXPECT_EQ(system.strains(), std::vector{2e-3}) << "lengths stay";
  EXPECT_EQ(system.applied().force[1].norm(), 0);
}

}  // namespace
}  // namespace tautline::assembly
