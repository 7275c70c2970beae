#include <gtest/gtest.h>

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

}  // namespace
}  // namespace tautline::deck
