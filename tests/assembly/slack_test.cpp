#include <tautline/assembly/slack.hpp>

#include <cmath>

#include <Eigen/Geometry>

#include <gtest/gtest.h>
#include <tautline/analysis/descent.hpp>

#include "assembly/models.hpp"

namespace tautline::assembly {
namespace {

using namespace testing_models;

/// Cables drawn straight from (0, 0, 0) to (10, 0, 0), each `ratio` times as long as drawn, turned about (1,
/// 1, 1).
model::Model straight_chain(int links, double ratio, double stiffness) {
  model::Model model;
  const Mat3 turn = Eigen::AngleAxisd(1, Vec3(1, 1, 1).normalized()).toRotationMatrix();
  const int group = add_cable_group(model, "chain", stiffness, 0);
  for (int i = 0; i <= links; ++i) model.nodes.push_back(turn * Vec3(10.0 * i / links, 0, 0));
  for (int i = 0; i < links; ++i) add_cable(model, group, i, i + 1, 1 / ratio - 1);
  return model;
}

/// A force across the chain on each inner node.
Boundary loaded(const model::Model& model, double force) {
  const Mat3 turn = Eigen::AngleAxisd(1, Vec3(1, 1, 1).normalized()).toRotationMatrix();
  const int last = static_cast<int>(model.nodes.size()) - 1;
  Boundary boundary{{support({0, last})}, {}};
  for (int i = 1; i < last; ++i) boundary.loads.push_back(load(i, turn * Vec3(0, 0, -force)));
  return boundary;
}

/// Sag of the middle of a chain with an even number of links, each of length L and stiffness EA, under equal
/// forces P: the pull H along it is that at which the links span the chord.
double sag_of_chain(int links, double span, double length, double stiffness, double force) {
  const auto stretch = [&](double pull, double v) { return length * (1 + std::hypot(pull, v) / stiffness); };
  const auto spanned = [&](double pull) {
    double sum = 0;
    for (int i = 0; i < links; ++i) {
      const double v = force * ((links - 1) / 2.0 - i);
      sum += stretch(pull, v) * pull / std::hypot(pull, v);
    }
    return sum;
  };
  double low = 1e-9 * force, high = 1e9 * force;
  for (int i = 0; i < 200; ++i) (spanned(std::sqrt(low * high)) < span ? low : high) = std::sqrt(low * high);
  double sag = 0;
  for (int i = 0; i < links / 2; ++i) {
    const double v = force * ((links - 1) / 2.0 - i);
    sag += stretch(low, v) * v / std::hypot(low, v);
  }
  return sag;
}

TEST(Slack, ChainsDrawnStraightHangAsTheyMust) {
  for (const int links : {2, 6, 30})
    for (const double ratio : {1.0, 1.02, 1.3})
      for (const double stiffness : {1e3, 2e8}) {
        const auto model = straight_chain(links, ratio, stiffness);
        System system(model);
        solve(system, loaded(model, 5));
        const double sag = system.state().displacement[static_cast<std::size_t>(links / 2)].norm();
        EXPECT_NEAR(sag, sag_of_chain(links, 10, ratio * 10 / links, stiffness, 5), 1e-7)
            << links << " links, " << ratio << ", " << stiffness;
      }
}

TEST(Slack, ChainsOfCatenariesHangAsThoseOfCables) {
  for (const double weight : {0.0, 1e-9}) {
    auto model = straight_chain(6, 1.1, 2e8);
    model.groups[0].kind = model::ElementKind::catenary;
    model.groups[0].cable.mass_per_length = weight;
    System system(model);
    solve(system, loaded(model, 5));
    EXPECT_NEAR(system.state().displacement[3].norm(), sag_of_chain(6, 10, 11.0 / 6, 2e8, 5), 1e-7) << weight;
  }
}

TEST(Slack, ElementsHaveTheirOwnStiffnessAgainAfterwards) {
  const auto model = straight_chain(6, 1.1, 2e8);
  System system(model);
  solve(system, loaded(model, 5));
  for (const auto& cable : system.model().cables) EXPECT_EQ(cable.stiffness_factor, 1);
}

TEST(Slack, AStartThatGivesWayIsOneOfSlackCablesNotOfLooseFrames) {
  const auto gives = [](const model::Model& model, const Boundary& boundary) {
    System system(model);
    analysis::Workspace workspace{system.new_matrix(), la::DirectSolver()};
    system.begin_stage(boundary);
    return analysis::gives_way(system, workspace);
  };
  const auto chain = straight_chain(4, 1.1, 1e6);
  EXPECT_TRUE(gives(chain, loaded(chain, 1)));
  const auto taut = straight_chain(4, 0.99, 1e6);
  EXPECT_FALSE(gives(taut, loaded(taut, 1)));
  element::BeamSection section;
  section.axial_stiffness = 1e6;
  section.bending_stiffness_2 = section.bending_stiffness_3 = section.torsion_stiffness = 100;
  auto mast = cantilever(4, 2.0, section);
  const Boundary pinned_foot{{support({0})}, {load(4, Vec3(0, 0, -1))}};
  EXPECT_FALSE(gives(mast, pinned_foot));
  const int guys = add_cable_group(mast, "guys");
  mast.nodes.emplace_back(2, 3, 0);
  add_cable(mast, guys, 4, 5, -0.1);
  EXPECT_FALSE(gives(mast, {{support({0, 5})}, {load(4, Vec3(0, 0, -1))}}))
      << "it turns about its axis all the same";
}

/// A taut cable from node 0 to 1 and on to 2, and a slack one from there by node 3 to 4.
model::Model taut_and_slack() {
  model::Model model;
  model.nodes = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(1, 1, 0), Vec3(1, 2, 0)};
  const int taut = add_cable_group(model, "taut"), slack = add_cable_group(model, "slack");
  add_cable(model, taut, 0, 1, 1e-3);
  add_cable(model, taut, 1, 2, 1e-3);
  add_cable(model, slack, 1, 3, -0.2);
  add_cable(model, slack, 3, 4, -0.2);
  return model;
}

std::optional<Slack> slack_of(const model::Model& model, const Boundary& boundary) {
  System system(model);
  analysis::Workspace workspace{system.new_matrix(), la::DirectSolver()};
  system.begin_stage(boundary);
  system.set_lambda(1);
  return find_slack(system, workspace);
}

TEST(Slack, ThatNothingLoadsIsToldWithItsPlace) {
  const auto found = slack_of(taut_and_slack(), {{support({0, 2, 4})}, {load(1, Vec3(0, 0, -1))}});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->nodes, std::vector<int>{3});
  EXPECT_EQ(found->cables, (std::vector<int>{2, 3}));
  EXPECT_NE(found->text.find("2 cables of slack"), std::string::npos) << found->text;
  EXPECT_NE(found->text.find("(1, 1, 0)"), std::string::npos) << found->text;
  EXPECT_NE(found->text.find("undetermined"), std::string::npos) << found->text;
}

TEST(Slack, ThatALoadFeelsIsNoSlackThatMayStay) {
  for (const double force : {1.0, 1e-6})
    EXPECT_FALSE(slack_of(taut_and_slack(), {{support({0, 2, 4})}, {load(3, Vec3(0, force, 0))}})) << force;
}

TEST(Slack, IsNotBlamedForAMechanismBesideIt) {
  auto model = taut_and_slack();
  const int bars = add_beam_group(model, "bars");
  model.nodes.emplace_back(5, 0, 0);
  model.nodes.emplace_back(6, 0, 0);
  add_beam(model, bars, 5, 6);
  EXPECT_FALSE(slack_of(model, {{support({0, 2, 4, 5})}, {}}));
}

TEST(Slack, IsBracedUnlessTheLoadsThatGrowActOnIt) {
  const auto model = taut_and_slack();
  System system(model);
  analysis::Workspace workspace{system.new_matrix(), la::DirectSolver()};
  const auto nulls = [&] {
    system.tangent(workspace.tangent);
    workspace.solver.factor(workspace.tangent);
    return workspace.solver.inertia().null;
  };
  system.begin_stage({{support({0, 2, 4})}, {load(1, Vec3(0, 0, -1))}});
  {
    const Bracing bracing(system, workspace);
    EXPECT_TRUE(bracing.holds());
    EXPECT_EQ(nulls(), 0);
  }
  EXPECT_EQ(nulls(), 3);
  system.begin_stage({{support({0, 2, 4})}, {load(1, Vec3(0, 0, -1)), load(3, Vec3(0, 1e-6, 0))}});
  const Bracing bracing(system, workspace);
  EXPECT_FALSE(bracing.holds());
}

TEST(Slack, UnloadedNodesDoNotStopAStage) {
  const auto model = taut_and_slack();
  System system(model);
  const Boundary boundary{{support({0, 2, 4})}, {load(1, Vec3(0, 0, -1))}};
  const auto path = solve(system, boundary);
  EXPECT_GT(path.inertia.null, 0);
  EXPECT_EQ(path.inertia.negative, 0);
  // Two cables of 1 m with the strain e0 under P across: 2 EA (e0 + (1 + e0) (1/cos a - 1)) sin a = P.
  const double z = system.state().displacement[1].z();
  const double e0 = 1e-3, length = std::hypot(1, z);
  EXPECT_NEAR(2 * 1e6 * (e0 + (1 + e0) * (length - 1)) * -z / length, 1, 1e-6);
}

}  // namespace
}  // namespace tautline::assembly
