// What is possible but hardly meant is told; what comes near it is left in peace. Limits:
// docs/adr/0024-doubts.md.
#include <tautline/model/doubts.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "messages.hpp"
#include "model/models.hpp"

namespace tautline::model {
namespace {

using namespace testing_models;
using testing_messages::mentions;

std::vector<std::string> codes(const std::vector<Doubt>& doubts) {
  std::vector<std::string> result;
  for (const auto& doubt : doubts) result.push_back(doubt.code);
  return result;
}

using Codes = std::vector<std::string>;

/// A mast with two stays; steel of the cables' 100 mm^2.
Model stayed_mast(double scale = 1) {
  Model model;
  for (const Vec3& x : {Vec3(0, 0, 0), Vec3(0, 0, 10), Vec3(6, 0, 0), Vec3(-6, 1, 0)})
    model.nodes.push_back(scale * x);
  model.node_names = {"foot", "top", "east", "west"};
  const int mast = add_beam_group(model, "mast"), stay = add_cable_group(model, "stay", 1.6e7, 0.785);
  add_beam(model, mast, 0, 1);
  add_cable(model, stay, 2, 1, 1e-3);
  add_cable(model, stay, 3, 1, 1e-3);
  return model;
}

Stock steel(double modulus = 1.6e11, double density = 7850) {
  Stock stock;
  stock.materials["steel"] = {modulus, 0.3, density, 1.2e-5};
  return stock;
}

TEST(InputDoubts, AreNoneOfAPlainStructure) {
  EXPECT_EQ(codes(input_doubts(stayed_mast(), steel())), Codes());
}

TEST(InputDoubts, TellOfAModulusInMegapascals) {
  for (const auto& [modulus, density] :
       {std::pair(1.6e5, 7850.), {7e4, 2700.}, {1.1e4, 500.}, {2.3e5, 1800.}})
    EXPECT_EQ(codes(input_doubts(stayed_mast(), steel(modulus, density))), Codes{"modulus"}) << modulus;
  for (const auto& [modulus, density] : {std::pair(1e6, 1100.), {1e9, 1100.}, {1.2e12, 3500.}, {1e10, 450.}})
    EXPECT_EQ(codes(input_doubts(stayed_mast(), steel(modulus, density))), Codes()) << modulus;
}

TEST(InputDoubts, TellOfADensityInTonnesPerCubicMillimetreOrGramsPerCubicCentimetre) {
  for (const double density : {7.85e-9, 2.7e-9, 7.85, 1.4})
    EXPECT_EQ(codes(input_doubts(stayed_mast(), steel(2.1e11, density))), Codes{"density"}) << density;
  EXPECT_EQ(codes(input_doubts(stayed_mast(), steel(2.1e11, 0))), Codes());  // without mass
  EXPECT_EQ(codes(input_doubts(stayed_mast(), steel(2.1e11, 7.85e6))), Codes{"density"});
}

// E = 1 and rho = 1, and steel in inches, pounds and seconds, are no slips.
TEST(InputDoubts, LeaveOtherUnitsInPeace) {
  auto model = stayed_mast(1e5);
  model.loads.emplace_back().acceleration = Vec3(0, 0, -9810);
  for (auto& group : model.groups) {
    group.cable = {100, 100};
    group.beam.axial_stiffness = group.beam.mass_per_length;
  }
  EXPECT_EQ(codes(input_doubts(model, steel(1, 1))), Codes());
  EXPECT_EQ(codes(input_doubts(model, steel(1.03e7, 2.5e-4))), Codes());
  EXPECT_EQ(codes(input_doubts(model, steel(2.1e5, 7.85e-9))), Codes());  // mm, t, N throughout
}

TEST(InputDoubts, TellOfMillimetresAndOfGravityInThem) {
  EXPECT_EQ(codes(input_doubts(stayed_mast(1000), steel())), Codes{"size"});
  EXPECT_EQ(codes(input_doubts(stayed_mast(100), steel())), Codes());
  auto model = stayed_mast();
  model.loads.emplace_back().acceleration = Vec3(0, 0, -9810);
  EXPECT_EQ(codes(input_doubts(model, steel())), Codes{"acceleration"});
  model.loads.back().acceleration = Vec3(0, 0, -50 * 9.81);  // of a launch
  EXPECT_EQ(codes(input_doubts(model, steel())), Codes());
}

TEST(InputDoubts, TellOfSectionsInMillimetres) {
  auto stock = steel();
  CableSectionOptions rope;
  rope.diameter = 10;
  stock.sections["rope"] = rope;
  stock.sections["tube"] = TubeSectionOptions{"steel", 168, 8};
  stock.sections["plate"] = ShellSectionOptions{"steel", 50};
  EXPECT_EQ(codes(input_doubts(stayed_mast(), stock)), Codes(3, "section_size"));
  rope.diameter = 1.1;
  stock.sections["rope"] = rope;
  stock.sections["tube"] = TubeSectionOptions{"steel", 20, 0.1};
  stock.sections["plate"] = ShellSectionOptions{"steel", 3};
  EXPECT_EQ(codes(input_doubts(stayed_mast(), stock)), Codes());
}

TEST(InputDoubts, TellOfInitialStrainsThatNothingBears) {
  auto model = stayed_mast();
  model.cables[1].initial_strain = 80;
  const auto doubts = input_doubts(model, steel());
  EXPECT_EQ(codes(doubts), Codes{"strain"});
  EXPECT_EQ(doubts[0].where, "group \"stay\"");
  EXPECT_TRUE(mentions(doubts[0].message, "8e+03 %"));
  model.cables[1].initial_strain = 0.8;
  EXPECT_EQ(codes(input_doubts(model, steel())), Codes());
}

TEST(TemperatureDoubts, AddUpWhatActsTogether) {
  auto model = stayed_mast();
  for (const char* name : {"night", "shade"}) {
    auto& load = model.loads.emplace_back();
    load.name = name;
    load.on = {"stay"};
    load.temperature_change = -150;
  }
  EXPECT_EQ(codes(temperature_doubts(model, {"night"})), Codes());
  EXPECT_EQ(codes(temperature_doubts(model, {"night", "shade"})), Codes{"temperature"});
  model.loads[0].temperature_change = 0;
  model.loads[0].temperature_field = [](const Vec3& x) { return -500 * x.z(); };
  EXPECT_EQ(codes(temperature_doubts(model, {"night"})), Codes{"temperature"});
}

/// Two cables that cross in the middle, drawn by their ends, each held there; turned and scaled.
Model cross(double scale, double gap, const Mat3& turn = Mat3::Identity()) {
  Model model;
  for (const Vec3& x : {Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0.2, -1, gap), Vec3(-0.2, 1, gap)})
    model.nodes.push_back(scale * (turn * x));
  model.node_names = {"w", "e", "s", "n"};
  const int net = add_cable_group(model, "net");
  add_cable(model, net, 0, 1);
  add_cable(model, net, 2, 3);
  return model;
}

TEST(GeometryDoubts, TellOfMembersThatPassThroughEachOther) {
  const Mat3 turn = (Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized())).toRotationMatrix();
  for (const double scale : {1e-3, 1., 1e3}) {
    const auto doubts = geometry_doubts(cross(scale, 1e-6, turn));
    ASSERT_EQ(codes(doubts), Codes{"crossing_elements"});
    EXPECT_TRUE(
        mentions(doubts[0].message,
                 "cable 1 of group \"net\", from node \"w\" to node \"e\" and cable 2 of group \"net\""));
    EXPECT_EQ(codes(geometry_doubts(cross(scale, 1e-3, turn))), Codes());
  }
}

// The diagonals of a panel, between posts on two supports; without the posts they are a slip.
TEST(GeometryDoubts, LeaveBracingInPeace) {
  Model model;
  model.nodes = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(4, 0, 3), Vec3(0, 0, 3)};
  const int frame = add_beam_group(model, "frame"), brace = add_cable_group(model, "brace");
  add_cable(model, brace, 0, 2);
  add_cable(model, brace, 1, 3);
  EXPECT_EQ(codes(geometry_doubts(model)), Codes{"crossing_elements"});
  add_beam(model, frame, 0, 3);
  add_beam(model, frame, 1, 2);
  EXPECT_EQ(codes(geometry_doubts(model)), Codes{"crossing_elements"});
  model.supports.push_back({"ground", {}, {0, 1}, {true, true, true, true, true, true}});
  EXPECT_EQ(codes(geometry_doubts(model)), Codes());
}

TEST(GeometryDoubts, LeaveMembersThatMeetAtTheirEndsOrAreLinked) {
  auto model = cross(1, 0);
  model.nodes[2] = Vec3(0, 1e-9, 0);  // the end of one lies on the other
  EXPECT_EQ(codes(geometry_doubts(model)), Codes{"node_on_element"});
  model.links.push_back({0, 2, false, {}});
  EXPECT_EQ(codes(geometry_doubts(model)), Codes());
}

TEST(GeometryDoubts, TellOfAMemberLaidOverTwo) {
  auto model = stayed_mast();
  model.nodes.emplace_back(0, 0, 4);
  model.node_names.push_back("mid");
  model.beams.clear();
  add_beam(model, 0, 0, 4);
  add_beam(model, 0, 4, 1);
  EXPECT_EQ(codes(geometry_doubts(model)), Codes());
  add_beam(model, 0, 0, 1);
  const auto doubts = geometry_doubts(model);
  ASSERT_EQ(codes(doubts), Codes{"node_on_element"});
  EXPECT_TRUE(mentions(doubts[0].message, "node \"mid\" at (0, 0, 4) lies on beam 3 of group \"mast\""));
}

TEST(GeometryDoubts, TellOfNodesAtOnePlaceOrAHairApart) {
  for (const double gap : {0., 1e-9, 2e-3}) {
    auto model = stayed_mast();
    model.nodes.push_back(model.nodes[1] + Vec3(gap, 0, 0));
    model.node_names.push_back("top2");
    model.cables[1].nodes[1] = 4;
    const auto doubts = geometry_doubts(model);
    ASSERT_EQ(codes(doubts), Codes{"coincident_nodes"}) << gap;
    EXPECT_TRUE(mentions(doubts[0].message, "node \"top\" at (0, 0, 10) and node \"top2\""));
    auto hinged = model;
    hinged.links.push_back({1, 4, true, {}});
    EXPECT_EQ(codes(geometry_doubts(hinged)), Codes());
    auto sprung = model;
    sprung.springs.push_back({{1, 4}, 0});
    EXPECT_EQ(codes(geometry_doubts(sprung)), Codes());
    auto held = model;  // two anchors at one place
    held.supports.push_back({"s", {}, {1, 4}, {true, true, true, false, false, false}});
    EXPECT_EQ(codes(geometry_doubts(held)), Codes());
  }
  auto apart = stayed_mast();
  apart.nodes.push_back(apart.nodes[1] + Vec3(0.05, 0, 0));
  apart.cables[1].nodes[1] = 4;
  EXPECT_EQ(codes(geometry_doubts(apart)), Codes());
}

TEST(GeometryDoubts, TellOfAMemberAHairLong) {
  for (const double length : {1e-9, 1e-4, 0.1}) {
    auto model = stayed_mast();
    model.nodes.push_back(model.nodes[1] + Vec3(length, 0, 0));
    model.cables[1].nodes[1] = 4;
    add_cable(model, 1, 1, 4);
    EXPECT_EQ(codes(geometry_doubts(model)), length < 1e-3 ? Codes{"short_element"} : Codes()) << length;
  }
}

TEST(GeometryDoubts, TellOfElementsGivenTwice) {
  auto model = two_facets();
  add_membrane(model, 0, 2, 0, 1);
  add_cable(model, 1, 2, 1);
  const auto doubts = geometry_doubts(model);
  ASSERT_EQ(codes(doubts), Codes{"duplicate_elements"});
  EXPECT_TRUE(
      mentions(doubts[0].message, "cable 3 of group \"ridge\", from node 3 to node 2 has the same nodes"));
  EXPECT_TRUE(mentions(doubts[0].message, "membrane 3 of group \"cloth\""));
  auto beside = two_facets();  // a cable along a beam is none
  add_cable(beside, 1, 2, 3);
  EXPECT_EQ(codes(geometry_doubts(beside)), Codes());
}

/// A strip of quadrilaterals under pressure, of which some are turned over.
Model strip(const std::vector<int>& turned) {
  Model model;
  for (int i = 0; i < 5; ++i)
    for (const double y : {0., 1.}) model.nodes.emplace_back(i, y, 0.1 * i * i);
  const int cloth = add_membrane_group(model, "cloth");
  for (int i = 0; i < 4; ++i) {
    FacetNodes nodes(2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1);
    if (std::find(turned.begin(), turned.end(), i) != turned.end())
      nodes = FacetNodes(2 * i + 1, 2 * i + 3, 2 * i + 2, 2 * i);
    model.membranes.push_back({nodes, cloth});
  }
  auto& load = model.loads.emplace_back();
  load.name = "wind";
  load.on = {"cloth"};
  load.pressure = 100;
  return model;
}

TEST(GeometryDoubts, TellOfFacetsUnderPressureThatFaceDifferentSides) {
  EXPECT_EQ(codes(geometry_doubts(strip({}))), Codes());
  EXPECT_EQ(codes(geometry_doubts(strip({0, 1, 2, 3}))), Codes());
  const auto doubts = geometry_doubts(strip({1}));
  ASSERT_EQ(codes(doubts), Codes{"mixed_orientation"});
  EXPECT_TRUE(mentions(doubts[0].message, "membrane 1 of group \"cloth\" and membrane 2 of group \"cloth\""));
  auto without = strip({1});
  without.loads[0].pressure = 0;
  EXPECT_EQ(codes(geometry_doubts(without)), Codes());
}

// 20 000 cables of a net in a fraction of a second (compared with each other they would take minutes), with
// one crossing among them.
TEST(GeometryDoubts, OfALargeNetTakeNoTime) {
  constexpr int n = 100;
  Model model;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) model.nodes.emplace_back(i, j, 1e-3 * i * j);
  const int net = add_cable_group(model, "net");
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      if (i + 1 < n) add_cable(model, net, i * n + j, (i + 1) * n + j);
      if (j + 1 < n) add_cable(model, net, i * n + j, i * n + j + 1);
    }
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(codes(geometry_doubts(model)), Codes());
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 5);
  add_cable(model, net, 0, n + 2);
  add_cable(model, net, 2, n);
  EXPECT_EQ(codes(geometry_doubts(model)), Codes());  // the middles lie 0.5 mm apart
  for (auto& x : model.nodes) x.z() = 0;
  EXPECT_EQ(codes(geometry_doubts(model)), Codes{"crossing_elements"});
}

Response at_rest(const Model& model) {
  return evaluate_response(model, State::reference(model));
}

// Euler's load of the mast, 10 m long with the smaller stiffness 1e4 N m^2.
TEST(StateDoubts, TellOfAMemberBeyondItsEulerLoad) {
  const auto model = stayed_mast();
  auto response = at_rest(model);
  const double euler = std::pow(std::numbers::pi / 10, 2) * 1e4;
  response.beams[0].axial = -0.99 * euler;
  EXPECT_EQ(codes(state_doubts(model, response)), Codes());
  response.beams[0].axial = -3 * euler;
  const auto doubts = state_doubts(model, response);
  ASSERT_EQ(codes(doubts), Codes{"member_buckling"});
  EXPECT_TRUE(mentions(
      doubts[0].message,
      "beam 1 of group \"mast\", from node \"foot\" to node \"top\" carries 3 times the Euler load"));
  response.beams[0].axial = 3 * euler;
  EXPECT_EQ(codes(state_doubts(model, response)), Codes());
}

// Torsion stiffness of the test beam over 10 m: a torque of G J / 10 m turns the ends by 1 rad.
TEST(StateDoubts, TellOfABeamThatTurnsFarWithinOneElement) {
  const auto model = stayed_mast();
  auto response = at_rest(model);
  const double one = model.groups[0].beam.torsion_stiffness / 10;
  response.beams[0].torque = -0.99 * one;
  EXPECT_EQ(codes(state_doubts(model, response)), Codes());
  response.beams[0].torque = -2 * one;
  const auto doubts = state_doubts(model, response);
  ASSERT_EQ(codes(doubts), Codes{"large_turn"});
  EXPECT_TRUE(mentions(doubts[0].message, "turns by 2 rad from end to end"));
}

TEST(InputDoubts, TellOfATurnThatTheElementsCannotFollow) {
  auto model = stayed_mast();
  Load turn;
  turn.name = "wind up";
  turn.nodes = {1};
  turn.rotation = Vec3(0, 0, 3);
  model.loads = {turn};
  EXPECT_EQ(codes(input_doubts(model, steel())), Codes());
  model.loads[0].rotation = Vec3(0, 0, 10);
  EXPECT_EQ(codes(input_doubts(model, steel())), Codes{"large_turn"});
}

TEST(StateDoubts, TellOfStrains) {
  const auto model = stayed_mast();
  auto response = at_rest(model);
  response.cables[0].tension = 0.9 * 1.6e7;
  EXPECT_EQ(codes(state_doubts(model, response)), Codes());
  response.cables[0].tension = 3 * 1.6e7;
  response.cables[1].tension = 4 * 1.6e7;
  const auto doubts = state_doubts(model, response);
  ASSERT_EQ(codes(doubts), Codes{"strain"});
  EXPECT_TRUE(mentions(doubts[0].message,
                       "cable 2 of group \"stay\", from node \"west\" to node \"top\" is strained "
                       "by 400 % (the worst of 2)"));
}

}  // namespace
}  // namespace tautline::model
