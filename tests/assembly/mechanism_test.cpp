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
