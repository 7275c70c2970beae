#include <gtest/gtest.h>

#include <deck/files.hpp>
#include <deck/keyword.hpp>
#include <deck/parameters.hpp>
#include <deck/reader.hpp>
#include <deck/topics.hpp>
#include <deck/yaml_tree.hpp>
#include <set>
#include <tautline/deck/deck.hpp>

namespace tautline::deck {
namespace {

using namespace test;

std::vector<std::filesystem::path> good_decks() {
  return files(source_dir / "tests/decks/good", ".yaml");
}

TEST(KeywordTable, SaysWhatEveryKeywordMeans) {
  for (const auto& [path, block, keyword] : all_topics()) {
    if (keyword == nullptr) {
      EXPECT_GE(block->sentence.size(), 15U) << path;
      continue;
    }
    EXPECT_FALSE(keyword->unit.empty()) << path;
    EXPECT_FALSE(type_text(*keyword).empty()) << path;
    EXPECT_GE(keyword->sentence.size(), 8U) << path;
    EXPECT_TRUE(keyword->sentence.ends_with('.')) << path;
    EXPECT_FALSE(keyword->expectation().empty()) << path;
    EXPECT_TRUE(keyword->read != nullptr) << path;
    EXPECT_EQ(keyword->type == Type::choice, !keyword->choices.empty()) << path;
  }
}

TEST(KeywordTable, HasNoKeyTwiceInABlock) {
  for (const Block* block : all_blocks()) {
    std::set<std::string> names;
    for (const auto& keyword : block->keywords) {
      EXPECT_TRUE(names.insert(keyword.name).second) << block->path << "." << keyword.name;
      for (const auto& other : keyword.other_names)
        EXPECT_EQ(block->find(other), nullptr) << block->path << "." << other;
    }
  }
}

TEST(KeywordTable, EveryKeywordStandsInAGoodDeck) {
  std::set<const Keyword*> used;
  for (const auto& file : good_decks()) {
    const std::string text = read_file(file);
    const Source source(file.string(), text);
    Complaints complaints;
    Node root = parse_yaml(source, text);
    substitute_parameters(root, source, complaints);
    Reader reader(source, complaints);
    Deck deck;
    reader.read_block(root_blocks(), root, &deck);
    EXPECT_TRUE(complaints.empty()) << file;
    used.insert(reader.used().begin(), reader.used().end());
  }
  for (const auto& [path, block, keyword] : all_topics())
    EXPECT_TRUE(keyword == nullptr || used.count(keyword) > 0)
        << path << " stands in no deck of tests/decks/good";
}

/// Paths of all single values of a tree.
void leaves(const Node& node, const std::string& path, std::vector<std::string>& list) {
  const std::string prefix = path.empty() ? "" : path + ".";
  if (node.is_scalar()) list.push_back(path);
  for (const auto& entry : node.entries) leaves(entry.value, prefix + entry.key, list);
  for (std::size_t i = 0; i < node.items.size(); ++i) leaves(node.items[i], prefix + std::to_string(i), list);
}

/// Titles and names are free; the groups of a mesh file are known only when it is read.
bool takes_any_text(const std::string& path, bool has_mesh) {
  if (has_mesh && path.find(".on.") != std::string::npos) return true;
  return path == "title" || path.ends_with(".name") || path.rfind("parameters.", 0) == 0;
}

class GoodDeck : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(GoodDeck, IsRead) {
  EXPECT_NO_THROW(read_deck(GetParam().string()));
}

/// Every value of the deck, spoilt, is complained about at its place.
TEST_P(GoodDeck, HasNoValueThatCanBeNonsense) {
  const std::string text = read_file(GetParam());
  const bool has_mesh = text.find("mesh: ") != std::string::npos;
  std::vector<std::string> paths;
  leaves(parse_yaml(Source("deck.yaml", text), text), "", paths);
  for (const auto& path : paths) {
    if (takes_any_text(path, has_mesh)) continue;
    const std::string override_text = path + "=nonsense!";
    try {
      read_deck(GetParam().string(), {override_text});
      ADD_FAILURE() << override_text << " was accepted";
    } catch (const DeckError& error) {
      EXPECT_EQ(error.diagnostics().front().where.file, "--set " + override_text) << error.what();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Folder, GoodDeck, testing::ValuesIn(good_decks()),
                         [](const auto& test) { return test.param.stem().string(); });

}  // namespace
}  // namespace tautline::deck
