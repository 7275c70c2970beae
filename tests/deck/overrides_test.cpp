#include <gtest/gtest.h>

#include <deck/files.hpp>
#include <tautline/core/text.hpp>
#include <tautline/deck/deck.hpp>

namespace tautline::deck {
namespace {

using namespace test;

const std::string main_deck = (source_dir / "inputs/perimeter_truss_12m.yaml").string();

Deck with(const std::string& override_text) {
  return read_deck(main_deck, {override_text});
}

std::string complaint(const std::string& override_text) {
  try {
    with(override_text);
    return "accepted";
  } catch (const DeckError& error) {
    return error.what();
  }
}

int subdivisions(const Deck& deck) {
  return std::get<steps::MeshOptions>(deck.steps[1].options).subdivide.subdivisions;
}

TEST(Overrides, ChangeParameters) {
  const Deck deck = with("parameters.subdivisions=8");
  EXPECT_EQ(subdivisions(deck), 8);
  EXPECT_EQ(deck.parameters.at("subdivisions"), "8");
}

TEST(Overrides, ReachValuesByPathIndexAndName) {
  EXPECT_EQ(with("reflector.gap=0.05").truss()->gap, 0.05);
  EXPECT_EQ(subdivisions(with("steps.1.subdivisions=2")), 2);
  EXPECT_EQ(subdivisions(with("steps.mesh.subdivisions=3")), 3);
  EXPECT_EQ(with("supports.held strut.fix=pinned").supports[0].fixed[3], false);
  EXPECT_EQ(std::get<steps::EquilibriumOptions>(with("steps.staged.stages.0.hold.1=ties").steps[2].options)
                .stages[0]
                .hold[1],
            "ties");
}

TEST(Overrides, ReplaceListsOfSingleValues) {
  const auto hold = [](const std::string& list) {
    const auto deck = with("steps.staged.stages.0.hold=" + list);
    return std::get<steps::EquilibriumOptions>(deck.steps[2].options).stages[0].hold;
  };
  EXPECT_EQ(hold("[ties, struts]"), (std::vector<std::string>{"ties", "struts"}));
  EXPECT_EQ(hold("[\"ties\"]"), std::vector<std::string>{"ties"});
  EXPECT_TRUE(hold("[]").empty());
  EXPECT_EQ(complaint("steps.staged.stages.0.hold=ties")
                .rfind("--set steps.staged.stages.0.hold=ties: error: this is a list, which cannot be set\n"
                       "  expected a list such as [a, b], or the path of a single value",
                       0),
            0);
}

TEST(Overrides, AddKeysAndBlocksThatHaveDefaults) {
  EXPECT_FALSE(with("reflector.diagonals=false").truss()->diagonals);
  EXPECT_EQ(with("solver.max_iterations=7").solver.max_iterations, 7);
  EXPECT_FALSE(with("output.pictures=false").output.pictures);
  EXPECT_EQ(with("title=a=b").title, "a=b");
}

TEST(Overrides, ApplyInOrder) {
  EXPECT_EQ(read_deck(main_deck, {"reflector.gap=0.1", "reflector.gap=0.2"}).truss()->gap, 0.2);
}

TEST(Overrides, TellWhatIsWrongWithThem) {
  EXPECT_EQ(complaint("reflector.gap"),
            "--set reflector.gap: error: this is no override\n  expected path.to.key=value\n");
  EXPECT_EQ(complaint("reflector.gap=wide"),
            "--set reflector.gap=wide: error: gap = wide is not a number\n  in reflector; expected a number "
            ">= 0 [m]\n");
  EXPECT_EQ(
      complaint("reflector.ring=1"),
      "--set reflector.ring=1: error: unknown key \"ring\"\n  in reflector\n  did you mean \"rings\"?\n");
  EXPECT_EQ(complaint("parameters.subdivision=8"),
            "--set parameters.subdivision=8: error: the deck has no \"subdivision\" here\n"
            "  expected one of: subdivisions, rim_width, net_tension\n  did you mean \"subdivisions\"?\n");
  EXPECT_EQ(complaint("steps.9.subdivisions=2")
                .rfind("--set steps.9.subdivisions=2: error: the deck has no \"9\" here\n", 0),
            0U);
  EXPECT_EQ(complaint("groups.front_nett.tension=2")
                .rfind("--set groups.front_nett.tension=2: error: the deck has no \"front_nett\" here", 0),
            0U);
  EXPECT_EQ(
      complaint("reflector=1").rfind("--set reflector=1: error: this is a mapping, which cannot be set", 0),
      0U);
  EXPECT_EQ(
      complaint("reflector.gap="),
      "--set reflector.gap=: error: \"gap\" has no value\n  in reflector; expected a number >= 0 [m]\n");
}

TEST(Overrides, AParametersOverrideIsNamedWhereItsValueDoesNotFit) {
  EXPECT_NE(
      complaint("parameters.subdivisions=0").find("${subdivisions} is 0 (--set parameters.subdivisions=0)"),
      std::string::npos)
      << complaint("parameters.subdivisions=0");
}

TEST(Overrides, WithControlCharactersAreRefusedWithoutThem) {
  for (const std::string bad : {"\x1b[31m", "\x07", "\xff", "\xc2\x9b"}) {
    const std::string told = complaint("title=red" + bad);
    EXPECT_NE(told.find("no text in UTF-8 or a control character"), std::string::npos) << told;
    EXPECT_EQ(first_bad_byte(told), std::string::npos) << told;
  }
}

TEST(Overrides, OfAnyLengthAreToldInFewWords) {
  std::string text = "reflector.gap=";
  text.resize(1'000'000, 'x');
  const std::string told = complaint(text);
  EXPECT_LT(told.size(), 10'000U);
  EXPECT_NE(told.find("--set reflector.gap=xxx"), std::string::npos);
}

}  // namespace
}  // namespace tautline::deck
