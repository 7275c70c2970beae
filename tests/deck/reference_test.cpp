#include <gtest/gtest.h>

#include <deck/files.hpp>
#include <deck/topics.hpp>
#include <nlohmann/json.hpp>
#include <tautline/deck/deck.hpp>

namespace tautline::deck {
namespace {

using namespace test;

TEST(Reference, CommittedPagesAreUpToDate) {
  const auto folder = source_dir / "docs/deck";
  const auto pages = reference_pages();
  for (const auto& [name, text] : pages) {
    if (updating()) write_file(folder / name, text);
    EXPECT_EQ(read_file(folder / name), text) << name << ": TAUTLINE_UPDATE=1 test_deck writes it anew";
  }
  for (const auto& file : files(folder, ".md"))
    EXPECT_TRUE(pages.count(file.filename().string()) > 0) << file;
}

TEST(Explain, ShowsTheContents) {
  const std::string text = explain("");
  for (const char* key : {"reflector", "model", "materials", "sections", "groups", "supports", "loads",
                          "steps", "output", "solver"})
    EXPECT_NE(text.find(std::string("  ") + key + " "), std::string::npos) << key;
}

TEST(Explain, FindsAKeyByPathAndByLastWord) {
  const std::string text =
      "reflector.perimeter-truss.diagonals: true or false\n  Crossed cords in every bay between struts.\n"
      "  default                true\n";
  EXPECT_EQ(explain("diagonals"), text);
  EXPECT_EQ(explain("reflector.diagonals"), text);
  EXPECT_EQ(explain("reflector.perimeter-truss.diagonals"), text);
  EXPECT_EQ(explain("steps.mesh.subdivisions").rfind("steps.mesh.subdivisions: whole number\n", 0), 0U);
}

TEST(Explain, ListsWhatAWordCanMean) {
  const std::string text = explain("diameter");
  EXPECT_NE(text.find("sections.cable.diameter"), std::string::npos);
  EXPECT_NE(text.find("sections.tube.diameter"), std::string::npos);
}

TEST(Explain, KnowsEveryPathOfTheTable) {
  for (const auto& topic : all_topics())
    EXPECT_EQ(explain(topic.path).rfind(topic.path, 0), 0U) << topic.path;
}

TEST(Explain, SuggestsForAnUnknownKey) {
  try {
    explain("aprture");
    FAIL();
  } catch (const DeckError& error) {
    EXPECT_STREQ(error.what(), "explain: error: unknown key \"aprture\"\n  did you mean \"aperture\"?\n");
  }
}

TEST(Schema, IsJsonWithEveryTopLevelKey) {
  const auto json = nlohmann::json::parse(schema());
  EXPECT_EQ(json["$schema"], "https://json-schema.org/draft/2020-12/schema");
  EXPECT_EQ(json["additionalProperties"], false);
  for (const auto& keyword : root_blocks().alternatives.front().keywords)
    EXPECT_TRUE(json["properties"].contains(keyword.name));
}

TEST(Schema, ChoosesByKind) {
  const auto json = nlohmann::json::parse(schema());
  const auto& sections = json["properties"]["sections"]["additionalProperties"]["oneOf"];
  ASSERT_EQ(sections.size(), 17U);
  EXPECT_EQ(sections[0]["properties"]["kind"]["const"], "cable");
  const auto& steps = json["properties"]["steps"]["items"]["oneOf"];
  EXPECT_EQ(steps.size(), 9U);
}

TEST(Schema, AsksForSectionsUnlessTheReflectorIsComplete) {
  const auto json = nlohmann::json::parse(schema());
  EXPECT_EQ(json["required"], nlohmann::json::array({"steps"}));
  std::map<std::string, nlohmann::json> required;
  for (const auto& structure : json["oneOf"])
    required[structure.value("/properties/reflector/properties/kind/const"_json_pointer, "model")] =
        structure["required"];
  EXPECT_EQ(required["model"], nlohmann::json({"model", "sections", "groups"}));
  EXPECT_EQ(required["perimeter-truss"], nlohmann::json({"reflector", "sections", "groups"}));
  EXPECT_EQ(required["rod-umbrella"], nlohmann::json::array({"reflector"}));
}

}  // namespace
}  // namespace tautline::deck
