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
  EXPECT_NE(found->text.find("node 2 of \"cable\" at (0, 0, 0)"), std::string::npos) << found->text;
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

/// A beam of `n` parts and length L, clamped at one end, thin as tubes are, with modulus E.
model::Model slender(int n, double length, double modulus, const Mat3& turn = Mat3::Identity()) {
  const double area = 1e-6 * length * length, inertia = 1e-6 * length * length * area;
  element::BeamSection section;
  section.axial_stiffness = modulus * area;
  section.bending_stiffness_2 = section.bending_stiffness_3 = modulus * inertia;
  section.torsion_stiffness = modulus * inertia;
  auto model = cantilever(n, length, section);
  for (Vec3& x : model.nodes) x = turn * x;
  for (auto& beam : model.beams) beam.frame = turn * beam.frame;
  return model;
}

// A number that changes with the units of length and force, or with the axes, could not tell.
TEST(Mechanism, IsNoMatterOfUnitsOrAxes) {
  const Mat3 skew = Eigen::AngleAxisd(1.1, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  for (const Mat3& turn : {Mat3(Mat3::Identity()), skew})
    for (const double length : {1e-4, 1., 1e5})
      for (const double modulus : {1., 2e11, 3e15})
        for (const int n : {1, 2, 60}) {
          const auto model = slender(n, length, modulus, turn);
          EXPECT_FALSE(mechanism_of(model, {{support({0}, clamped)}, {}}))
              << length << " " << modulus << " " << n;
          EXPECT_TRUE(mechanism_of(model, {{support({0}, pinned)}, {}}))
              << length << " " << modulus << " " << n;
          auto other_pinned = model;
          EXPECT_TRUE(mechanism_of(other_pinned, {{support({0, n}, pinned)}, {}}))
              << length << " " << modulus << " " << n;
        }
}

// Stiff and soft in one: a beam of any stiffness on strings of any tension is held; without one string it is
// not.
TEST(Mechanism, OfAStiffBeamOnSoftStrings) {
  for (const double modulus : {1e5, 1e11, 3e15}) {
    auto model = slender(8, 2, modulus);
    const int group = add_cable_group(model, "string", 10);
    for (const int end : {0, 8})
      for (const Vec3& way :
           {Vec3(0, 1, 0), Vec3(0, -0.5, 0.8), Vec3(0, -0.5, -0.8), Vec3(end > 0 ? 1 : -1, 0, 0)}) {
        model.nodes.push_back(model.nodes[end] + way);
        add_cable(model, group, end, static_cast<int>(model.nodes.size()) - 1, 0.1);
      }
    std::vector<int> anchors;
    for (int i = 9; i < static_cast<int>(model.nodes.size()); ++i) anchors.push_back(i);
    const auto spin = mechanism_of(model, {{support(anchors)}, {}});  // the strings hold no torsion
    ASSERT_TRUE(spin) << modulus;
    EXPECT_TRUE(spin->rotation);
    EXPECT_FALSE(mechanism_of(
        model, {{support(anchors), support({0}, {false, false, false, true, false, false})}, {}}))
        << modulus;
  }
}

// What a tension might hold is no loose part; what none could is.
TEST(LooseParts, AreWhatNoTensionHolds) {
  const auto chain = straight_cables(0);
  EXPECT_TRUE(mechanism_of(chain, {{support({0, 2})}, {}}));
  EXPECT_FALSE(find_loose_part(chain, {{support({0, 2})}, {}}));
  EXPECT_FALSE(find_loose_part(chain, {{support({0})}, {}}));  // hangs down
  const auto sliding =
      find_loose_part(chain, {{support({0, 2}, {false, true, true, false, false, false})}, {}});
  ASSERT_TRUE(sliding);
  EXPECT_NEAR(std::abs(sliding->direction.x()), 1, 1e-9);
  const auto beam = slender(3, 2, 2e11);
  EXPECT_FALSE(
      find_loose_part(beam, {{support({0}, {true, true, true, true, false, false})}, {}}));  // a pendulum
  const auto spin = find_loose_part(beam, {{support({0, 3}, pinned)}, {}});
  ASSERT_TRUE(spin);
  EXPECT_TRUE(spin->rotation);
}

}  // namespace
}  // namespace tautline::assembly
