#include <gtest/gtest.h>

#include <chrono>
#include <deck/files.hpp>
#include <tautline/deck/deck.hpp>

namespace tautline::deck {
namespace {

using namespace test;

/// What a user sees of a deck's faults, or "" if it has none.
std::string complaints(const std::string& path, const std::vector<std::string>& overrides = {}) {
  try {
    read_deck(path, overrides);
    return {};
  } catch (const DeckError& error) {
    return error.what();
  }
}

class BadDeck : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(BadDeck, IsToldAsExpected) {
  const auto file = GetParam();
  std::filesystem::current_path(file.parent_path());
  const std::string found = complaints(file.filename().string());
  EXPECT_FALSE(found.empty()) << "the deck was accepted";
  auto expected = file;
  expected.replace_extension(".txt");
  if (updating()) write_file(expected, found);
  EXPECT_EQ(found, read_file(expected));
}

INSTANTIATE_TEST_SUITE_P(Folder, BadDeck, testing::ValuesIn(files(source_dir / "tests/decks/bad", ".yaml")),
                         [](const auto& test) { return test.param.stem().string(); });

TEST(BadDecks, HaveNoOrphanedExpectations) {
  for (const auto& file : files(source_dir / "tests/decks/bad", ".txt"))
    EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(file).replace_extension(".yaml"))) << file;
}

TEST(BadDecks, AMissingFileIsTold) {
  EXPECT_EQ(complaints("nowhere/deck.yaml"), "nowhere/deck.yaml: error: this file does not exist\n");
}

TEST(BadDecks, AFolderIsTold) {
  const std::string folder = (source_dir / "tests").string();
  EXPECT_EQ(complaints(folder), folder + ": error: this is a folder, not a deck\n");
}

TEST(BadDecks, WithoutEndAreNotReadToTheEnd) {
  EXPECT_EQ(complaints("/dev/zero"), "/dev/zero: error: this file has more than 100000000 bytes\n");
}

/// However a deck is damaged, the answer is a deck or a DeckError.
TEST(BadDecks, DamagedTextNeverBreaksTheReader) {
  const std::string text = read_file(source_dir / "tests/decks/good/reflector_all_keys.yaml");
  const std::string damage = "[]{}:\"'#&*\t\n,-!|>%@`~\xC3";
  for (std::size_t i = 0; i < text.size(); i += 7) {
    for (const std::string& broken :
         {text.substr(0, i), text.substr(i), text.substr(0, i) + damage[i % damage.size()] + text.substr(i),
          text.substr(0, i) + damage[(i / 7) % damage.size()] + text.substr(i + 1)}) {
      try {
        parse_deck(broken, "broken.yaml");
      } catch (const DeckError& error) {
        EXPECT_FALSE(error.diagnostics().empty());
      }
    }
  }
}

TEST(BadDecks, AliasesThatMultiplyAreStopped) {
  std::string text = "a: &a [x, x, x, x, x, x, x, x, x, x]\n";
  for (char c = 'b'; c < 'n'; ++c) {
    const char before = static_cast<char>(c - 1);
    text += std::string(1, c) + ": &" + c + " [";
    for (int i = 0; i < 9; ++i) text += std::string("*") + before + ", ";
    text += std::string("*") + before + "]\n";
  }
  EXPECT_THROW(parse_deck(text, "laughs.yaml"), DeckError);
}

TEST(BadDecks, DeepNestingIsStopped) {
  EXPECT_THROW(parse_deck("title: " + std::string(100000, '['), "deep.yaml"), DeckError);
}

/// What a small deck is told.
std::string told(const std::string& text) {
  try {
    parse_deck(text, "deck.yaml");
    return {};
  } catch (const DeckError& error) {
    return error.what();
  }
}

/// Two nodes and a cable, held at the groups that are named.
std::string two_nodes(const std::string& parameters, const std::string& held, const std::string& cable) {
  return "units: SI\nparameters: {p: \"" + parameters +
         "\"}\nmodel:\n  nodes: {a: [0, 0, 0], b: [1, 0, 0]}\n  elements: {c: [" + cable +
         "]}\nsections: {c: {kind: cable, axial_stiffness: 1e5, mass_per_length: 1}}\n"
         "groups: {c: {section: c, tension: 5}}\nsupports: [{on: [" +
         held + "], fix: pinned}]\nsteps: [{kind: equilibrium}]\n";
}

std::string repeated(const std::string& part, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += part;
  return text;
}

TEST(HugeDecks, AreToldOfParametersThatMultiply) {
  const std::string text =
      told(two_nodes(std::string(1'000'000, 'y'), repeated("\"${p}\", ", 2000), "[a, b]"));
  EXPECT_NE(text.find("parameters make the deck too large"), std::string::npos) << text.substr(0, 400);
  EXPECT_LT(text.size(), 200'000U) << "values and lines are shown in part";
}

TEST(HugeDecks, OfManyUnknownNamesShowTheFirst) {
  std::string cables;
  for (int i = 0; i < 5000; ++i) cables += "[node_" + std::to_string(i) + ", a], ";
  const std::string text = told(two_nodes("1", "c", cables));
  EXPECT_NE(text.find("5000 errors in all; the first 20 are shown"), std::string::npos)
      << text.substr(0, 400);
  EXPECT_LT(text.size(), 20'000U);
}

/// Columns count characters however the places come; a line of a megabyte takes no quadratic time.
TEST(HugeDecks, OfOneLongLineArePlacedQuickly) {
  std::string names;
  for (int i = 0; i < 50'000; ++i) names += "\"ü" + std::to_string(i) + "\", ";
  const auto start = std::chrono::steady_clock::now();
  const std::string text = told(two_nodes("1", names + "a, a", "[a, b]"));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
  EXPECT_NE(text.find("errors in all"), std::string::npos) << text.substr(0, 400);
  EXPECT_NE(text.find("unknown group \"ü0\""), std::string::npos) << text.substr(0, 400);
  EXPECT_NE(text.find("deck.yaml:8:24: error: unknown group \"ü1\""), std::string::npos)
      << text.substr(0, 900);
}

TEST(HugeDecks, AreToldOfTheirNumberOfValues) {
  EXPECT_NE(told("title: [" + repeated("a, ", 1'000'001) + "a]").find("more than 1000000 values"),
            std::string::npos);
}

TEST(HugeDecks, ShowWhatStandsAboutAFaultOfALongLine) {
  const std::string space(3000, ' ');
  const std::string text = told(two_nodes("1", space + "x_y_z" + space, "[a, b]"));
  EXPECT_LT(text.size(), 1000U) << text;
  const auto line = text.find(" | "), name = text.find("x_y_z", line), mark = text.find('^'),
             below = text.rfind(" | ", mark);
  ASSERT_NE(name, std::string::npos) << text;
  ASSERT_NE(mark, std::string::npos) << text;
  EXPECT_EQ(name - line, mark - below) << text;
}

}  // namespace
}  // namespace tautline::deck
