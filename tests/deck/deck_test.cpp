#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <deck/files.hpp>
#include <filesystem>
#include <tautline/deck/deck.hpp>

namespace tautline::deck {
namespace {

using namespace test;

const std::string main_deck = (source_dir / "inputs/perimeter_truss_12m.yaml").string();

Deck read_good(const std::string& name) {
  return read_deck((source_dir / "tests/decks/good" / name).string());
}

TEST(Deck, ReadsTheReflectorOfTheMainDeck) {
  const Deck deck = read_deck(main_deck);
  ASSERT_TRUE(deck.truss());
  EXPECT_FALSE(deck.model);
  EXPECT_EQ(deck.title, "12 m perimeter-truss reflector");
  EXPECT_EQ(deck.truss()->aperture, 12);
  EXPECT_EQ(deck.truss()->clearance, 1.125);
  EXPECT_EQ(deck.truss()->rings, 10);
  EXPECT_EQ(deck.truss()->frequency, 12e9);
  EXPECT_TRUE(deck.truss()->diagonals);
}

TEST(Deck, ReadsSectionsAndGroupsOfTheMainDeck) {
  const Deck deck = read_deck(main_deck);
  const auto& rim = std::get<model::RectangleSectionOptions>(deck.sections.at("rim"));
  EXPECT_EQ(rim.width, 0.009) << "from a parameter";
  EXPECT_EQ(rim.material, "rim");
  EXPECT_EQ(std::get<model::CableSectionOptions>(deck.sections.at("cord")).axial_stiffness, 30890);
  EXPECT_EQ(deck.groups.size(), 8U);
  EXPECT_EQ(deck.groups.at("diagonals").tension, 29);
  EXPECT_FALSE(deck.groups.at("ties").tension);
  EXPECT_EQ(deck.groups.at("cloth").prestress, (std::array<double, 2>{2, 2}));
  EXPECT_GT(deck.groups.at("cloth").where.line, 0);
}

TEST(Deck, ReadsTheStepsOfTheMainDeck) {
  const Deck deck = read_deck(main_deck);
  ASSERT_EQ(deck.steps.size(), 6U);
  EXPECT_EQ(deck.steps[0].name, "form_finding");
  EXPECT_EQ(std::get<steps::MeshOptions>(deck.steps[1].options).subdivide.subdivisions, 4);
  const auto& staged = std::get<steps::EquilibriumOptions>(deck.steps[2].options);
  ASSERT_EQ(staged.stages.size(), 2U);
  EXPECT_EQ(staged.stages[0].hold, (std::vector<std::string>{"front_rim", "rear_rim", "struts"}));
  EXPECT_TRUE(std::get<steps::EquilibriumOptions>(deck.steps[3].options).reset);
  EXPECT_EQ(deck.steps[3].name, "direct");
  EXPECT_EQ(std::get<steps::ModalOptions>(deck.steps[5].options).modes, 6);
}

TEST(Deck, ReadsEveryOptionOfAReflectorsSteps) {
  const Deck deck = read_good("reflector_all_keys.yaml");
  const auto& net = std::get<steps::FormFindingOptions>(deck.steps[0].options);
  EXPECT_EQ(net.jacobian, formfinding::SurfaceJacobian::as_published);
  EXPECT_EQ(net.max_iterations, 30);
  EXPECT_TRUE(net.condition_number);
  const auto& mesh = std::get<steps::MeshOptions>(deck.steps[1].options).subdivide;
  EXPECT_EQ(mesh.pattern, model::FacetPattern::mapped);
  EXPECT_EQ(mesh.group_subdivisions.at("rear_rim"), 1);
  const auto& tuning = std::get<steps::TuningStepOptions>(deck.steps[3].options).tuning;
  EXPECT_EQ(tuning.method, reflector::TuningMethod::sensitivity);
  EXPECT_EQ(tuning.tension_max, 100);
  EXPECT_EQ(deck.solver.max_iterations, 30);
  EXPECT_FALSE(deck.output.pictures);
  EXPECT_EQ(deck.supports[1].name, "support 2");
  EXPECT_EQ(deck.supports[1].fixed, (std::array<bool, 6>{true, true, false, false, false, true}));
}

TEST(Deck, ReadsAPlainModel) {
  const Deck deck = read_good("plain_all_keys.yaml");
  ASSERT_TRUE(deck.model);
  ASSERT_EQ(deck.model->nodes.size(), 5U);
  EXPECT_EQ(deck.model->nodes[3].first, "4");
  EXPECT_EQ(deck.model->nodes[3].second, Vec3(1, 1, 0));
  EXPECT_EQ(deck.model->elements[5].connectivity[0], (std::vector<std::string>{"a", "b", "4"}));
  EXPECT_EQ(deck.supports[0].fixed, (std::array<bool, 6>{true, true, true, false, false, false}));
  EXPECT_EQ(deck.loads[0].moment, Vec3(0, 0, 0.5));
  EXPECT_EQ(deck.groups.at("ends").nodes, (std::vector<std::string>{"a", "c"}));
}

TEST(Deck, FindsTheMeshFileBesideTheDeck) {
  const Deck deck = read_good("mesh_file.yaml");
  ASSERT_TRUE(deck.model);
  EXPECT_TRUE(std::filesystem::exists(deck.model->mesh_file)) << deck.model->mesh_file;
}

TEST(Deck, NumbersStepsWhoseKindRepeats) {
  const Deck deck = read_deck(main_deck, {"steps.staged.name=form_finding 1"});
  EXPECT_EQ(deck.steps[2].name, "form_finding 1");
  const std::string text = read_file(main_deck) + "  - kind: modal\n";
  EXPECT_EQ(parse_deck(text, "deck.yaml").steps[5].name, "modal 1");
  EXPECT_EQ(parse_deck(text, "deck.yaml").steps[6].name, "modal 2");
}

TEST(Deck, SurvivesWindowsLineEndsAndAByteOrderMark) {
  std::string text = "\xEF\xBB\xBF";
  for (const char c : starting_deck("frame")) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(parse_deck(text, "deck.yaml").title, "cantilever");
}

TEST(Deck, CarriesTheDigestOfItsBytes) {
  std::string text = starting_deck("frame");
  const std::string digest = parse_deck(text, "deck.yaml").sha256;
  EXPECT_EQ(digest.size(), 64U);
  EXPECT_NE(parse_deck(text + "\n", "deck.yaml").sha256, digest);
}

TEST(Deck, FingerprintIsThatOfTheMeshFilesContent) {
  const auto folder =
      std::filesystem::temp_directory_path() / fmt::format("tautline_fingerprint_{}", getpid());
  std::filesystem::create_directories(folder);
  const auto fingerprint = [&](const std::string& mesh) {
    test::write_file(folder / "film.msh", mesh);
    const std::string text =
        "model: {mesh: film.msh}\n"
        "sections: {film: {kind: membrane, tension_stiffness: 1000, poisson_ratio: 0, mass_per_area: 0}}\n"
        "groups: {film: {section: film}}\nsupports: [{on: film}]\nsteps: [{kind: equilibrium}]\n";
    return parse_deck(text, (folder / "deck.yaml").string()).fingerprint;
  };
  const auto first = fingerprint("one mesh");
  EXPECT_EQ(fingerprint("one mesh"), first);
  EXPECT_NE(fingerprint("one mash"), first);
  std::filesystem::remove_all(folder);
}

TEST(Deck, ReadsTwentyThousandNodes) {
  std::string nodes, elements;
  for (int i = 0; i < 20000; ++i) {
    nodes += "    n" + std::to_string(i) + ": [" + std::to_string(i) + ", 0, 0]\n";
    if (i > 0) elements += "      - [n" + std::to_string(i - 1) + ", n" + std::to_string(i) + "]\n";
  }
  const std::string text = "model:\n  nodes:\n" + nodes + "  elements:\n    line:\n" + elements +
                           "sections: {cord: {kind: cable, axial_stiffness: 1, mass_per_length: 0}}\n"
                           "groups: {line: {section: cord, tension: 1}}\nsteps: [{kind: equilibrium}]\n";
  EXPECT_EQ(parse_deck(text, "deck.yaml").model->elements[0].connectivity.size(), 19999U);
}

TEST(GoodDeck, UmbrellaIsRead) {
  const Deck deck = read_good("umbrella_all_keys.yaml");
  ASSERT_NE(deck.umbrella(), nullptr);
  EXPECT_EQ(deck.truss(), nullptr);
  EXPECT_EQ(deck.rod_umbrella(), nullptr);
  EXPECT_EQ(deck.dish(), deck.umbrella());
  EXPECT_EQ(deck.dish()->aperture, 12);
  EXPECT_EQ(deck.umbrella()->spokes, 5);
  EXPECT_EQ(deck.umbrella()->surface_height, 0.1033);
  EXPECT_EQ(deck.umbrella()->tip_radius, (std::vector<double>{8.2, 7.8, 7.7, 7.7, 7.8}));
  EXPECT_TRUE(deck.umbrella()->separate_rings);
  EXPECT_EQ(deck.umbrella()->fork_length, 0);
  EXPECT_TRUE(deck.umbrella()->end_cords);
  EXPECT_TRUE(deck.umbrella()->paired_ties);
  EXPECT_EQ(deck.groups.at("front_peripheral").force_density, 251.1);
}

TEST(Deck, ReadsAnUmbrellaOfRodsWithoutSections) {
  const Deck deck = read_good("rod_umbrella_all_keys.yaml");
  ASSERT_NE(deck.rod_umbrella(), nullptr);
  EXPECT_EQ(deck.truss(), nullptr);
  const auto& umbrella = *deck.rod_umbrella();
  EXPECT_EQ(umbrella.rods, 24);
  EXPECT_EQ(umbrella.lengths, (std::vector<double>{2, 1.5, 1}));
  EXPECT_EQ(umbrella.bending_stiffness, std::vector<double>{2000});
  EXPECT_EQ(umbrella.root_offset, 0.05);
  EXPECT_EQ(umbrella.meridian.kind, rod::MeridianKind::parabola);
  EXPECT_EQ(umbrella.meridian.coefficient, 0.1);
  EXPECT_EQ(umbrella.cable.law, rod::CableLaw::bilinear);
  EXPECT_EQ(umbrella.cable.knee_strain, 0.02);
  using Options = steps::RodShapingOptions;
  const auto& published = std::get<Options>(deck.steps.at(0).options);
  EXPECT_EQ(published.method, Options::Method::cantilevers);
  EXPECT_EQ(published.cantilevers.shortening, rod::Shortening::as_published);
  EXPECT_EQ(published.cantilevers.method, rod::CantileverMethod::successive);
  EXPECT_EQ(published.max_iterations, 500);
  EXPECT_EQ(std::get<Options>(deck.steps.at(1).options).exact.form, rod::ExactForm::nodes_on_target);
  EXPECT_EQ(std::get<Options>(deck.steps.at(2).options).stiffness, (std::vector<double>{300, 200, 100}));
}

TEST(Deck, ReadsAMeridianOfPoints) {
  const Deck deck = read_good("rod_umbrella_points.yaml");
  const auto& meridian = deck.rod_umbrella()->meridian;
  EXPECT_EQ(meridian.kind, rod::MeridianKind::table);
  EXPECT_EQ(meridian.x, (std::vector<double>{0, 0.5, 1, 2, 3}));
  EXPECT_EQ(meridian.y, (std::vector<double>{0, 0.02, 0.1, 0.4, 0.9}));
}

TEST(Deck, ReadsAnInverse) {
  const Deck deck = read_good("inverse_all_keys.yaml");
  EXPECT_EQ(deck.rod_umbrella()->axial_stiffness, (std::vector<double>{1e9, 2e9}));
  EXPECT_EQ(deck.rod_umbrella()->torsion_stiffness, std::vector<double>{1500});
  EXPECT_EQ(deck.rod_umbrella()->mass_per_length, std::vector<double>{0.4});
  EXPECT_EQ(deck.rod_umbrella()->meridian.expression, "0.1*X^2");
  using Unknown = steps::InverseUnknownOptions;
  const auto& inverse = std::get<steps::InverseOptions>(deck.steps.at(3).options);
  ASSERT_EQ(inverse.targets.size(), 5U);
  EXPECT_EQ(inverse.targets[0].radius, 2.1);
  EXPECT_EQ(inverse.targets[0].z, 0.4);
  EXPECT_FALSE(inverse.targets[0].x.has_value());
  EXPECT_EQ(inverse.targets[0].weight, 2);
  EXPECT_EQ(inverse.targets[2].meridian->coefficient, 0.1);
  EXPECT_EQ(inverse.targets[3].meridian->kind, rod::MeridianKind::table);
  ASSERT_EQ(inverse.unknowns.size(), 2U);
  EXPECT_EQ(inverse.unknowns[0].quantity, Unknown::Quantity::axial_stiffness);
  EXPECT_EQ(inverse.unknowns[0].each, Unknown::Each::cable);
  EXPECT_EQ(inverse.unknowns[0].max, 5000);
  EXPECT_EQ(inverse.unknowns[1].quantity, Unknown::Quantity::unstressed_length);
  EXPECT_FALSE(inverse.unknowns[1].min.has_value());
  EXPECT_EQ(inverse.rank_tolerance, 1e-9);
}

class StartingDeck : public testing::TestWithParam<std::string> {};

TEST_P(StartingDeck, IsValid) {
  const Deck deck = parse_deck(starting_deck(GetParam()), GetParam() + ".yaml");
  EXPECT_FALSE(deck.title.empty());
  EXPECT_FALSE(deck.steps.empty());
}

INSTANTIATE_TEST_SUITE_P(Kinds, StartingDeck, testing::ValuesIn(starting_deck_kinds()), [](const auto& test) {
  std::string name = test.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(StartingDecks, UnknownKindsAreTold) {
  for (const char* kind : {"umbrela", "rod-umbrela", "nett", ""}) {
    try {
      starting_deck(kind);
      FAIL() << kind;
    } catch (const DeckError& error) {
      EXPECT_NE(std::string(error.what()).find("expected one of: perimeter-truss, umbrella, net"),
                std::string::npos)
          << error.what();
    }
  }
}

}  // namespace
}  // namespace tautline::deck
