#include "deck_mutator.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include <deck/keyword.hpp>
#include <deck/source.hpp>
#include <deck/yaml_tree.hpp>
#include <tautline/core/error.hpp>

namespace tautline::fuzz {

namespace {

using deck::Entry;
using deck::Node;
namespace fs = std::filesystem;

void collect(Node& node, std::vector<Node*>& list) {
  list.push_back(&node);
  for (auto& item : node.items) collect(item, list);
  for (auto& entry : node.entries) collect(entry.value, list);
}

void collect(const Node& node, const std::string& key, std::vector<const Node*>& list) {
  for (const auto& item : node.items) collect(item, key, list);
  for (const auto& entry : node.entries) {
    if (entry.key == key) list.push_back(&entry.value);
    collect(entry.value, key, list);
  }
}

void forget_notes(Node& node) {
  node.note.clear();
  for (auto& item : node.items) forget_notes(item);
  for (auto& entry : node.entries) forget_notes(entry.value);
}

Node scalar(std::string text, bool quoted = false) {
  Node node;
  node.kind = Node::Kind::scalar;
  node.text = std::move(text);
  node.quoted = quoted;
  return node;
}

/// What is written as it stands.
Node raw(std::string text) {
  Node node = scalar(std::move(text));
  node.kind = Node::Kind::broken;
  return node;
}

Node wrapped(Node node, Random& random) {
  Node outer;
  if (random.chance(0.5)) {
    outer.kind = Node::Kind::sequence;
    outer.items.push_back(std::move(node));
  } else {
    outer.kind = Node::Kind::mapping;
    outer.entries.push_back({random.chance(0.5) ? "name" : "a", {}, std::move(node)});
  }
  return outer;
}

template <class List>
std::size_t index_in(const List& list, Random& random) {
  return static_cast<std::size_t>(random.whole(0, static_cast<int>(list.size()) - 1));
}

std::string misspelt(std::string word, Random& random) {
  if (word.empty()) return "a";
  const std::size_t at = index_in(word, random);
  if (random.chance(0.3))
    word.erase(at, 1);
  else if (random.chance(0.3))
    word.insert(at, 1, static_cast<char>(random.whole('a', 'z')));
  else if (random.chance(0.5))
    std::replace(word.begin(), word.end(), '_', '-');
  else
    word[at] = static_cast<char>(random.whole('A', 'z'));
  return word;
}

/// A number that the deck holds, by another factor or with something attached.
std::string other_number(const std::string& text, Random& random) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end == text.c_str() || *end != '\0') return strange_number(random);
  static const std::vector<double> factors{-1,  0,    2,   0.5,  10,   0.1,   1e3,   1e-3,
                                           1e6, 1e-6, 1e9, 1e-9, 1e15, 1e-15, 1e100, 1e-100};
  if (random.chance(0.6)) return std::to_string(value * random.one_of(factors));
  if (random.chance(0.3))
    return std::to_string(static_cast<long>(std::clamp(value, -1e15, 1e15)) + random.whole(-2, 2));
  static const std::vector<std::string> tails{" mm", "kN", " GPa", "e",  "e400",
                                              ",5",  " %", "x",    "*2", " # x"};
  return text + random.one_of(tails);
}

/// Text of a node, in blocks or brackets.
class Writer {
 public:
  explicit Writer(Random& random) : random_(random), blocks_(random.between(0, 1)) {}

  std::string write(const Node& root) {
    block(root, 0);
    return text_;
  }

 private:
  static bool needs_quotes(const std::string& text) {
    if (text.empty() || text.find_first_of(",[]{}#&*!|>'\"%@`\\\n\r\t") != std::string::npos) return true;
    if (text.find(": ") != std::string::npos || text.back() == ':' || text.front() == ' ' ||
        text.back() == ' ')
      return true;
    return text.front() == '-' && text.size() > 1 && text[1] == ' ';
  }
  static std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) {
      if (c == '"' || c == '\\') result += '\\';
      if (c == '\n')
        result += "\\n";
      else
        result += c;
    }
    return result + '"';
  }
  static std::string word(const Node& node) {
    if (node.kind == Node::Kind::broken) return node.text;
    return node.quoted || needs_quotes(node.text) ? quoted(node.text) : node.text;
  }
  static std::string key(const std::string& name) { return needs_quotes(name) ? quoted(name) : name; }

  void flow(const Node& node) {
    text_ += node.note;
    if (node.is_sequence()) {
      text_ += '[';
      for (std::size_t i = 0; i < node.items.size(); ++i) {
        if (i > 0) text_ += ", ";
        flow(node.items[i]);
      }
      text_ += ']';
    } else if (node.is_mapping()) {
      text_ += '{';
      for (std::size_t i = 0; i < node.entries.size(); ++i) {
        if (i > 0) text_ += ", ";
        text_ += key(node.entries[i].key) + ": ";
        flow(node.entries[i].value);
      }
      text_ += '}';
    } else if (node.kind != Node::Kind::empty) {
      text_ += word(node);
    }
  }

  void block(const Node& node, int indent) {
    const std::string space(static_cast<std::size_t>(indent), ' ');
    for (const auto& item : node.items) {
      text_ += space + "-";
      below(item, indent + 2);
    }
    for (const auto& entry : node.entries) {
      text_ += space + key(entry.key) + ":";
      below(entry.value, indent + 2);
    }
    if (node.items.empty() && node.entries.empty()) {
      text_ += space;
      flow(node);
      text_ += '\n';
    }
  }

  void below(const Node& node, int indent) {
    const bool holds = !node.items.empty() || !node.entries.empty();
    if (!holds || indent > 100 || !random_.chance(blocks_)) {
      text_ += ' ';
      flow(node);
      text_ += '\n';
      return;
    }
    text_ += (node.note.empty() ? "" : " ") + node.note + "\n";
    block(node, indent);
  }

  Random& random_;
  double blocks_;
  std::string text_;
};

std::string read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

std::string write_yaml(const Node& root, Random& random) {
  return Writer(random).write(root);
}

std::vector<SeedDeck> read_seeds(const std::vector<std::string>& places, std::size_t most_bytes) {
  std::vector<fs::path> files;
  for (const auto& place : places) {
    if (!fs::is_directory(place))
      files.emplace_back(place);
    else
      for (const auto& entry : fs::recursive_directory_iterator(place))
        if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<SeedDeck> seeds;
  for (const auto& file : files) {
    const std::string text = read(file);
    if (text.size() > most_bytes) continue;
    try {
      Node tree = deck::parse_yaml(deck::Source(file.string(), text), text);
      forget_notes(tree);
      if (tree.find("steps") != nullptr) seeds.push_back({file.string(), std::move(tree)});
    } catch (const DeckError&) {  // some are bad on purpose
    }
  }
  return seeds;
}

DeckMutator::DeckMutator(std::vector<SeedDeck> seeds) : seeds_(std::move(seeds)) {
  for (const auto* block : deck::all_blocks())
    for (const auto& name : block->names()) keys_.push_back(name);
  for (const char* other : {"<<", "", "0", "kind", "name", "~", "a b"}) keys_.emplace_back(other);
}

DeckMutator::Mutant DeckMutator::make(Random& random) const {
  const SeedDeck& seed = random.one_of(seeds_);
  Node tree = seed.tree;
  const int changes = static_cast<int>(random.magnitude(1, 8));
  if (random.chance(0.5)) {  // nearly always a deck still
    for (int i = 0; i < changes; ++i) change_number(tree, random);
    if (random.chance(0.3)) change(tree, random);
    return {write_yaml(tree, random), &seed};
  }
  const bool as_text_only = random.chance(0.1);
  for (int i = 0; i < changes && !as_text_only; ++i) change(tree, random);
  std::string text = write_yaml(tree, random);
  const int damages = as_text_only ? changes : random.chance(0.15) ? random.whole(1, 3) : 0;
  for (int i = 0; i < damages; ++i) damage_text(text, random);
  return {std::move(text), &seed};
}

Node& DeckMutator::any_node(Node& root, Random& random) const {
  Node* node = &root;  // by levels, so that long lists of nodes do not take all changes
  while (true) {
    const std::size_t below = node->items.size() + node->entries.size();
    if (below == 0 || (node != &root && random.chance(0.25))) return *node;
    const std::size_t i = static_cast<std::size_t>(random.whole(0, static_cast<int>(below) - 1));
    node = i < node->items.size() ? &node->items[i] : &node->entries[i - node->items.size()].value;
  }
}

const Node& DeckMutator::any_part(Random& random) const {
  return any_node(const_cast<Node&>(random.one_of(seeds_).tree), random);
}

void DeckMutator::change(Node& root, Random& random) const {
  Node& node = any_node(root, random);
  switch (random.whole(0, 11)) {
    case 0:
    case 1:
    case 2:
      return node.is_scalar() ? change_value(node, random) : change_items(node, random);
    case 3:
      return change_kind(node, random);
    case 4:
    case 5:
      return change_keys(node.entries.empty() ? root : node, random);
    case 6:
      return change_items(root, random);
    case 7:
      if (Node* steps = root.find("steps")) change_items(*steps, random);
      return;
    case 8:
    case 9:
      return splice(root, node, random);
    case 10:
      return use_alias(root, node, random);
    default:
      return use_parameter(root, node, random);
  }
}

void DeckMutator::change_value(Node& node, Random& random) const {
  const std::string before = node.text;
  switch (random.whole(0, 6)) {
    case 0:
    case 1:
      node = scalar(other_number(before, random));
      break;
    case 2:
      node = scalar(strange_number(random));
      break;
    case 3:
      node = scalar(strange_word(random), random.chance(0.3));
      break;
    case 4:
      node = scalar(misspelt(before, random));
      break;
    case 5:
      node = scalar(random.one_of(keys_));
      break;
    default: {
      const Node& other = any_part(random);
      node = other.is_scalar() ? other : scalar(before, !node.quoted);
    }
  }
}

/// Another number where one stands, a whole one where a whole one stands.
void DeckMutator::change_number(Node& root, Random& random) const {
  Node& node = any_node(root, random);
  char* end = nullptr;
  const double value = std::strtod(node.text.c_str(), &end);
  if (!node.is_scalar() || node.text.empty() || *end != '\0') return;
  static const std::vector<double> factors{-1, 0,   1e-3, 0.1,  0.5,  0.99,  1.01,  2,
                                           10, 1e3, 1e6,  1e-6, 1e12, 1e-12, 1e100, 1e-100};
  const bool whole = node.text.find_first_not_of("-0123456789") == std::string::npos;
  if (whole && random.chance(0.8))
    node.text = std::to_string(static_cast<long>(value) * random.whole(-1, 4) + random.whole(-2, 2));
  else if (random.chance(0.9))
    node.text = fmt::format("{:.10g}", value * random.one_of(factors));
  else
    node.text = strange_number(random);
}

void DeckMutator::change_kind(Node& node, Random& random) const {
  switch (random.whole(0, 6)) {
    case 0:
      node = Node();
      break;
    case 1:
      node = scalar(strange_number(random));
      break;
    case 2:
      node = any_part(random);
      break;
    case 3: {
      const int depth = random.chance(0.1) ? static_cast<int>(random.magnitude(2, 2000)) : 1;
      for (int i = 0; i < depth; ++i) node = wrapped(std::move(node), random);
      break;
    }
    case 4: {
      static const std::vector<std::string> kinds{"[]",
                                                  "{}",
                                                  "!!binary aGk=",
                                                  "|\n  block",
                                                  ">-\n   folded",
                                                  "!x 1",
                                                  "*none",
                                                  "? a",
                                                  "[[[[]]]]",
                                                  "{a: {b: {c: }}}",
                                                  "'",
                                                  "\"",
                                                  "- a"};
      node = raw(random.one_of(kinds));
      break;
    }
    case 5:
      if (!node.items.empty())
        node = Node(node.items[index_in(node.items, random)]);
      else if (!node.entries.empty())
        node = Node(node.entries[index_in(node.entries, random)].value);
      break;
    default:  // a list becomes a mapping and the other way round
      if (node.is_sequence()) {
        Node mapping;
        mapping.kind = Node::Kind::mapping;
        for (std::size_t i = 0; i < node.items.size(); ++i)
          mapping.entries.push_back({std::to_string(i), {}, node.items[i]});
        node = std::move(mapping);
      } else if (node.is_mapping()) {
        Node list;
        list.kind = Node::Kind::sequence;
        for (auto& entry : node.entries) list.items.push_back(entry.value);
        node = std::move(list);
      }
  }
}

void DeckMutator::change_keys(Node& node, Random& random) const {
  if (node.entries.empty()) return;
  const std::size_t at = index_in(node.entries, random);
  switch (random.whole(0, 5)) {
    case 0:
      node.entries.erase(node.entries.begin() + static_cast<std::ptrdiff_t>(at));
      break;
    case 1:
      node.entries.push_back(Entry(node.entries[at]));
      break;
    case 2:
      node.entries[at].key = misspelt(node.entries[at].key, random);
      break;
    case 3:
      node.entries[at].key = random.chance(0.5) ? random.one_of(keys_) : strange_word(random);
      break;
    case 4:
      node.entries.push_back({random.one_of(keys_), {}, any_part(random)});
      break;
    default:
      std::swap(node.entries[at], node.entries[index_in(node.entries, random)]);
  }
}

void DeckMutator::change_items(Node& node, Random& random) const {
  if (!node.entries.empty()) return change_keys(node, random);
  if (node.items.empty()) return change_value(node, random);
  const std::size_t at = index_in(node.items, random);
  switch (random.whole(0, 4)) {
    case 0:
      node.items.erase(node.items.begin() + static_cast<std::ptrdiff_t>(at));
      break;
    case 1: {
      const Node item = node.items[at];
      const int count = random.chance(0.03) ? random.whole(2, 300) : 1;
      for (int i = 0; i < count; ++i) node.items.push_back(item);
      break;
    }
    case 2:
      std::swap(node.items[at], node.items[index_in(node.items, random)]);
      break;
    case 3:
      node.items.push_back(any_part(random));
      break;
    default:
      if (node.items[at].is_scalar())
        change_value(node.items[at], random);
      else
        change_items(node.items[at], random);
  }
}

void DeckMutator::splice(Node& root, Node& node, Random& random) const {
  const Node& other = random.one_of(seeds_).tree;
  if (!node.entries.empty()) {  // the value of the same key in another deck
    auto& entry = node.entries[index_in(node.entries, random)];
    std::vector<const Node*> list;
    collect(other, entry.key, list);
    if (!list.empty()) entry.value = Node(*random.one_of(list));
    return;
  }
  if (random.chance(0.5)) {  // a step of another deck
    const Node* theirs = other.find("steps");
    Node* ours = root.find("steps");
    if (theirs == nullptr || ours == nullptr || theirs->items.empty() || !ours->is_sequence()) return;
    ours->items.insert(ours->items.begin() + random.whole(0, static_cast<int>(ours->items.size())),
                       random.one_of(theirs->items));
    return;
  }
  if (other.entries.empty() || !root.is_mapping()) return;
  const Entry entry = random.one_of(other.entries);  // a block of another deck
  if (Node* ours = root.find(entry.key))
    *ours = entry.value;
  else
    root.entries.push_back(entry);
}

void DeckMutator::use_alias(Node& root, Node& node, Random& random) const {
  std::vector<Node*> all;
  collect(root, all);
  Node& anchored = *random.one_of(all);
  static const std::vector<std::string> names{"a", "b", "c"};
  const std::string name = random.one_of(names);
  if (&node == &root) return;
  if (node.is_sequence() && random.chance(0.5)) {
    const int count = random.chance(0.1) ? random.whole(2, 30) : 1;
    for (int i = 0; i < count; ++i) node.items.push_back(raw("*" + name));
  } else if (node.is_mapping() && random.chance(0.2)) {
    node.entries.push_back({"<<", {}, raw("*" + name)});
  } else {
    node = raw("*" + name);
    return;  // the anchored node may have been below
  }
  all.clear();
  collect(root, all);
  if (std::find(all.begin(), all.end(), &anchored) != all.end()) anchored.note = "&" + name + " ";
}

void DeckMutator::use_parameter(Node& root, Node& node, Random& random) const {
  if (!node.is_scalar() || !root.is_mapping()) return;
  const Node value = scalar(random.chance(0.5)   ? node.text
                            : random.chance(0.5) ? strange_number(random)
                                                 : strange_word(random));
  node = scalar(random.chance(0.8) ? "${p}" : "${p}" + node.text);
  Node* parameters = root.find("parameters");
  if (parameters == nullptr) {
    Node block;
    block.kind = Node::Kind::mapping;
    root.entries.push_back({"parameters", {}, std::move(block)});
    parameters = &root.entries.back().value;
  }
  if (parameters->is_mapping()) parameters->entries.push_back({random.chance(0.9) ? "p" : "q", {}, value});
}

}  // namespace tautline::fuzz
