#include <tautline/assembly/mechanism.hpp>

#include <cmath>

#include <gtest/gtest.h>

#include "assembly/models.hpp"

namespace tautline::assembly {
namespace {

using namespace testing_models;

std::optional<Mechanism> mechanism_of(const model::Model& model, const Boundary& boundary) {
  System system(model);
  analysis::Workspace workspace{system.new_matrix(), la::DirectSolver()};
  system.begin_stage(boundary);
  return find_mechanism(system, workspace);
}

model::Model straight_cables(double initial_strain) {
  model::Model model;
  model.nodes = {Vec3(-1, 0, 0), Vec3(0, 0, 0), Vec3(1, 0, 0)};
  const int group = add_cable_group(model, "cable", 1000.0);
  add_cable(model, group, 0, 1, initial_strain);
  add_cable(model, group, 1, 2, initial_strain);
  return model;
}

TEST(Mechanism, IsNotThereWhereCablesAreTaut) {
  EXPECT_FALSE(mechanism_of(straight_cables(0.01), {{support({0, 2})}, {}}));
}

TEST(Mechanism, OfSlackCablesNamesTheNodeAndAsksForTension) {
  const auto found = mechanism_of(straight_cables(0), {{support({0, 2})}, {}});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->nodes.front(), 1);
  EXPECT_NE(found->text.find("node 2 at (0, 0, 0)"), std::string::npos) << found->text;
  EXPECT_NE(found->text.find("`tension`"), std::string::npos) << found->text;
}

// A beam pinned at both ends can still spin about its axis.
TEST(Mechanism, OfABeamPinnedAtItsEndsIsTheSpinAboutItsAxis) {
  element::BeamSection section;
  section.axial_stiffness = 1e6;
  section.bending_stiffness_2 = section.bending_stiffness_3 = 100;
  section.torsion_stiffness = 80;
  const auto found = mechanism_of(cantilever(4, 2.0, section), {{support({0, 4}, pinned)}, {}});
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->rotation);
  EXPECT_NEAR(std::abs(found->direction.x()), 1, 1e-6);
  EXPECT_NE(found->text.find("frame"), std::string::npos) << found->text;
}

/// A long beam that nothing but a hinge at its root holds: places move as they are far from the root, and
/// those that move more than half as much as the tip are named, the tip first.
TEST(Mechanism, NamesTheNodesThatMoveMost) {
  const auto found = mechanism_of(cantilever(5, 40.0, {1e6, 100, 100, 80, 0, 0, 1, 0, 0}),
                                  {{support({0}, {true, true, true, true, false, true})}, {}});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->nodes, (std::vector{5, 4, 3}));
  EXPECT_FALSE(found->rotation);
  EXPECT_NEAR(std::abs(found->direction.z()), 1, 1e-6);
  EXPECT_NE(found->text.find("moving along z"), std::string::npos) << found->text;
}

/// A seesaw whose one arm is long: its tip moves against the many nodes of the short one.
TEST(Mechanism, NamesAnAxisWhicheverWayItGoes) {
  for (const double side : {-1.0, 1.0}) {
    model::Model model;
    const int rod = add_beam_group(model, "rod");
    model.groups[rod].beam = {1e6, 100, 100, 80, 0, 0, 1, 0, 0};
    model.nodes = {Vec3(side * 40, 0, 0), Vec3(0, 0, 0)};
    add_beam(model, rod, 0, 1);
    for (int i = 2; i < 12; ++i) {
      model.nodes.emplace_back(-side * (9 + i), 0, 0);
      add_beam(model, rod, i - 1, i);
    }
    const auto found = mechanism_of(model, {{support({1}, {true, true, true, true, false, true})}, {}});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->nodes.front(), 0);
    EXPECT_NE(found->text.find("moving along z"), std::string::npos) << found->text;
  }
}

/// Askew, the direction is written out.
TEST(Mechanism, NamesADirectionThatIsNoAxis) {
  model::Model model;
  model.nodes = {Vec3(-3, -4, 0), Vec3(0, 0, 0), Vec3(3, 4, 0)};
  const int group = add_cable_group(model, "cable", 1000.0);
  add_cable(model, group, 0, 1);
  add_cable(model, group, 1, 2);
  const auto found =
      mechanism_of(model, {{support({0, 2}), support({1}, {false, false, true, false, false, false})}, {}});
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->text.find("moving along (0.80, -0.60, 0.00)") != std::string::npos ||
              found->text.find("moving along (-0.80, 0.60, 0.00)") != std::string::npos)
      << found->text;
}

/// A hinge whose turn nothing holds is told from a frame that stands free.
TEST(Mechanism, OfAHingeThatNothingHoldsIsItsTurn) {
  model::Model model;
  model.nodes = {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1.2, 0, 0}};
  const int rod = add_beam_group(model, "rod");
  add_beam(model, rod, 0, 1);
  add_beam(model, rod, 2, 3);
  model::Link hinge{1, 2, false, {Vec3(0, 1, 0)}, -1};
  model.links.push_back(hinge);
  const auto found = mechanism_of(model, {{support({0}, clamped)}, {}});
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->rotation);
  EXPECT_NEAR(std::abs(found->direction.y()), 1, 1e-6);
  EXPECT_NE(found->text.find("turning about y"), std::string::npos) << found->text;
}

TEST(Mechanism, OfAMembraneWithoutPrestressIsNormalToIt) {
  model::Model model;
  model.nodes = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0), Vec3(0.4, 0.5, 0)};
  auto& group = model.groups.emplace_back();
  group.name = "sail";
  group.kind = model::ElementKind::membrane;
  group.membrane = {1000, 0.3, 0.1};
  for (int i = 0; i < 4; ++i) model.membranes.push_back({{i, (i + 1) % 4, 4}, 0});
  const Boundary corners{{support({0, 1, 2, 3})}, {}};
  const auto found = mechanism_of(model, corners);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->nodes.front(), 4);
  EXPECT_NEAR(std::abs(found->direction.z()), 1, 1e-6);
  EXPECT_NE(found->text.find("`prestress`"), std::string::npos) << found->text;
  for (auto& membrane : model.membranes) membrane.prestress = Vec3(5, 5, 0);
  EXPECT_FALSE(mechanism_of(model, corners));
}

}  // namespace
}  // namespace tautline::assembly
