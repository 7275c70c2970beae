#include <tautline/core/error.hpp>
#include <tautline/model/model.hpp>

#include "messages.hpp"
#include "model/models.hpp"

namespace tautline::model {
namespace {

using namespace testing_models;
using testing_messages::mentions;
using testing_messages::message_of;

using Ints = std::vector<int>;

TEST(Model, SelectsTheElementsOfAGroupWithTheirNodes) {
  const auto selected = two_facets().select("ridge");
  EXPECT_EQ(selected.cables, Ints{0});
  EXPECT_EQ(selected.nodes, (Ints{1, 2}));
  EXPECT_TRUE(selected.beams.empty());
  EXPECT_TRUE(selected.membranes.empty());
}

TEST(Model, SelectsTheNodesOfASelectionsElements) {
  const auto selected = two_facets().select("everything");
  EXPECT_EQ(selected.membranes, (Ints{0, 1}));
  EXPECT_EQ(selected.nodes, (Ints{0, 1, 2, 3, 4}));
}

TEST(Model, JoinsAGroupAndASelectionOfTheSameName) {
  auto model = two_facets();
  model.selections["ridge"].nodes = {4, 4};
  EXPECT_EQ(model.select("ridge").nodes, (Ints{1, 2, 4}));
}

TEST(Model, ListsTheNodesOfSeveralNamesOnceAndSorted) {
  EXPECT_EQ(two_facets().nodes_of({"anchors", "ridge", "strut"}), (Ints{1, 2, 3, 4}));
  EXPECT_TRUE(two_facets().nodes_of({}).empty());
}

TEST(Model, ListsItsNamesSorted) {
  EXPECT_EQ(two_facets().names(),
            (std::vector<std::string>{"anchors", "cloth", "everything", "mast", "ridge", "strut", "tie"}));
}

TEST(Model, SuggestsTheNearestNameForAnUnknownOne) {
  const auto message = message_of<ModelError>([] { two_facets().select("Ridges"); });
  EXPECT_TRUE(mentions(message, "\"Ridges\""));
  EXPECT_TRUE(mentions(message, "did you mean \"ridge\"?"));
  EXPECT_TRUE(mentions(message, "anchors, cloth, everything, mast, ridge, strut, tie"));
}

TEST(Model, KnowsWhichNodesRotate) {
  EXPECT_EQ(two_facets().rotational_nodes(), (std::vector<bool>{true, false, true, true, true}));
}

TEST(Model, WeighsLengthsAndAreas) {
  Model model;
  model.nodes = {{0, 0, 0}, {3, 0, 0}, {3, 4, 0}};
  const int cord = add_cable_group(model, "cord", 1e6, 0.5), rod = add_beam_group(model, "rod"),
            cloth = add_membrane_group(model, "cloth");
  add_cable(model, cord, 0, 2, 0.25);  // 5 m as drawn, 4 m unstressed: its mass is that of 4 m
  add_beam(model, rod, 0, 1);
  add_membrane(model, cloth, 0, 1, 2);
  const auto mass = mass_by_group(model);
  EXPECT_DOUBLE_EQ(mass.at("cord"), 0.5 * 4);
  EXPECT_DOUBLE_EQ(mass.at("rod"), 3.0 * 3);
  EXPECT_DOUBLE_EQ(mass.at("cloth"), 1.2 * 6);
  EXPECT_DOUBLE_EQ(total_mass(model), 2 + 9 + 7.2);
  EXPECT_DOUBLE_EQ(model.unstressed_length(model.cables[0]), 4);
}

TEST(Validation, AcceptsASoundStructure) {
  EXPECT_NO_THROW(validate(two_facets()));
}

/// What validate says of two_facets() after `change`.
template <class Change>
std::string complaint(const Change& change) {
  auto model = two_facets();
  change(model);
  return message_of<ModelError>([&] { validate(model); });
}

TEST(Validation, NamesACableOfZeroLength) {
  const auto message = complaint([](Model& m) { m.cables[1].nodes = {3, 3}; });
  EXPECT_TRUE(mentions(message, "cable 2 of group \"tie\""));
  EXPECT_TRUE(mentions(message, "at the same place"));
}

TEST(Validation, NamesANodeThatBelongsToNoElement) {
  const auto message = complaint([](Model& m) { m.nodes.emplace_back(5, 5, 5); });
  EXPECT_TRUE(mentions(message, "node 6 at (5, 5, 5) belongs to no element"));
}

TEST(Validation, NamesAnElementWhoseNodeDoesNotExist) {
  const auto message = complaint([](Model& m) { m.beams[0].nodes[1] = 17; });
  EXPECT_TRUE(mentions(message, "beam 1 of group \"strut\""));
  EXPECT_TRUE(mentions(message, "does not exist"));
}

TEST(Validation, LetsAStructureFloat) {
  auto model = two_facets();
  model.supports.clear();
  EXPECT_NO_THROW(validate(model));
}

TEST(Validation, NamesAStiffnessThatIsNotPositive) {
  const auto cable = complaint([](Model& m) { m.groups[1].cable.axial_stiffness = -3; });
  EXPECT_TRUE(mentions(cable, "group \"ridge\": the axial stiffness E A [N] must be positive, is -3"));
  const auto beam = complaint([](Model& m) { m.groups[4].beam.torsion_stiffness = 0; });
  EXPECT_TRUE(mentions(beam, "group \"mast\": the torsion stiffness [N m^2] must be positive, is 0"));
  const auto membrane = complaint([](Model& m) { m.groups[0].membrane.tension_stiffness = std::nan(""); });
  EXPECT_TRUE(
      mentions(membrane, "group \"cloth\": the tension stiffness E h [N/m] must be positive, is nan"));
}

TEST(Validation, NamesAMembraneWithoutArea) {
  // Three points on a line whose coordinates are not exact in binary, so that the area is round-off and not
  // zero.
  const auto message = complaint([](Model& m) { m.nodes[3] = m.nodes[2] + 0.7 * (m.nodes[1] - m.nodes[2]); });
  EXPECT_TRUE(mentions(message, "membrane 2 of group \"cloth\": has no area"));
}

TEST(Validation, NamesAnElementInAGroupOfAnotherKind) {
  const auto message = complaint([](Model& m) { m.cables[0].group = 0; });
  EXPECT_TRUE(mentions(message, "cable 1 of group \"cloth\": the group's section is of another kind"));
}

TEST(Validation, ListsEveryFaultOfAStage) {
  const auto message = complaint([](Model& m) {
    m.groups[1].cable.axial_stiffness = 0;
    m.cables[0].nodes = {2, 2};
    m.beams[1].nodes[0] = -1;
  });
  EXPECT_TRUE(mentions(message, "group \"ridge\""));
  EXPECT_TRUE(mentions(message, "cable 1"));
  EXPECT_TRUE(mentions(message, "beam 2"));
}

}  // namespace
}  // namespace tautline::model
