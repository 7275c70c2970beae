#include <gtest/gtest.h>

#include <deck/yaml_tree.hpp>

namespace tautline::deck {
namespace {

Node parse(const std::string& text) {
  return parse_yaml(Source("deck.yaml", text), text);
}

void expect_place(const Place& place, int line, int column, int length) {
  EXPECT_EQ(place.line, line);
  EXPECT_EQ(place.column, column);
  EXPECT_EQ(place.length, length);
}

TEST(YamlTree, PlacesKeysAndValuesInCharacters) {
  const Node root = parse("groß: {länge: 12, b: \"öä\"}\n");
  expect_place(root.entries[0].place, 1, 1, 4);
  const Node& inner = root.entries[0].value;
  expect_place(inner.entries[0].place, 1, 8, 5);
  expect_place(inner.entries[0].value.place, 1, 15, 2);
  expect_place(inner.entries[1].value.place, 1, 22, 4);
}

TEST(YamlTree, PlacesAnEmptyValueAtItsKey) {
  const Node root = parse("a:\n  area:\n  other: 1\n");
  expect_place(root.entries[0].value.entries[0].value.place, 2, 3, 4);
  EXPECT_EQ(root.entries[0].value.entries[0].value.kind, Node::Kind::empty);
}

TEST(YamlTree, PlacesAnAliasWhereItIsUsed) {
  const Node root = parse("a: &x 12\nb: *x\nc: &y {d: 3}\ne: *y\n");
  expect_place(root.find("a")->place, 1, 7, 2);
  expect_place(root.find("b")->place, 2, 4, 2);
  EXPECT_EQ(root.find("b")->text, "12");
  EXPECT_EQ(root.find("b")->note, "the value comes from the anchor in line 1");
  expect_place(root.find("e")->place, 4, 4, 2);
  expect_place(root.at({"e", "d"})->place, 3, 11, 1);
}

TEST(YamlTree, KeepsDuplicateKeys) {
  EXPECT_EQ(parse("a: 1\na: 2\n").entries.size(), 2U);
}

TEST(YamlTree, TellsQuotedFromPlain) {
  const Node root = parse("a: 12\nb: \"12\"\nc: '12'\n");
  EXPECT_FALSE(root.find("a")->quoted);
  EXPECT_TRUE(root.find("b")->quoted);
  EXPECT_TRUE(root.find("c")->quoted);
}

TEST(YamlTree, FindsByPathOfKeysAndIndices) {
  const Node root = parse("steps:\n  - {kind: mesh}\n  - {kind: modal, modes: 3}\n");
  EXPECT_EQ(root.at({"steps", "1", "modes"})->text, "3");
  EXPECT_EQ(root.at({"steps", "2"}), nullptr);
  EXPECT_EQ(root.at({"steps", "x"}), nullptr);
}

}  // namespace
}  // namespace tautline::deck
