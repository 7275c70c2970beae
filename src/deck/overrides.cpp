#include <algorithm>
#include <sstream>

#include <fmt/format.h>

#include <deck/keyword.hpp>
#include <deck/parameters.hpp>
#include <deck/reader.hpp>
#include <optional>
#include <tautline/core/text.hpp>

namespace tautline::deck {

namespace {

/// What can follow in a path below this node.
std::vector<std::string> steps_below(const Node& node) {
  std::vector<std::string> result;
  for (const auto& entry : node.entries) result.push_back(entry.key);
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    result.push_back(std::to_string(i));
    if (const std::string label = label_of(node.items[i]); !label.empty()) result.push_back(label);
  }
  return result;
}

/// One --set: walks down its path, changes or adds the value.
class Override {
 public:
  Override(const std::string& text, Complaints& complaints) : text_(text), complaints_(complaints) {}

  void apply(Node& root) {
    if (const auto bad = first_bad_byte(text_); bad != std::string::npos)
      return fail(
          fmt::format("this holds the byte 0x{:02X}, which is no text in UTF-8 or a control character",
                      static_cast<unsigned char>(text_[bad])),
          "expected plain text", {});
    const auto equals = text_.find('=');
    if (equals == std::string::npos || equals == 0)
      return fail("this is no override", "expected path.to.key=value", {});
    std::string rest = text_.substr(0, equals);
    Node* node = &root;
    while (node != nullptr) {
      Node* next = step(*node, rest);
      if (next == nullptr && rest.find('.') == std::string::npos && node->is_mapping())
        return node == root.find("parameters") ? unknown(*node, rest)
                                               : add(*node, rest, text_.substr(equals + 1));
      if (next == nullptr) next = open_block(root, *node, rest);
      if (next == nullptr) return unknown(*node, rest);
      node = next;
      if (rest.empty()) return set(*node, text_.substr(equals + 1));
    }
  }

 private:
  /// Follows the longest key, index or name that begins `rest`, and cuts it off.
  Node* step(Node& node, std::string& rest) {
    Node* found = nullptr;
    std::size_t length = 0;
    const auto follow = [&](const std::string& word, Node& value) {
      const bool fits = rest == word || rest.rfind(word + ".", 0) == 0;
      if (!fits || word.size() <= length) return;
      found = &value;
      length = word.size();
    };
    for (auto& entry : node.entries) follow(entry.key, entry.value);
    for (std::size_t i = 0; i < node.items.size(); ++i) {
      follow(std::to_string(i), node.items[i]);
      if (const std::string label = label_of(node.items[i]); !label.empty() && is_unique(node, label))
        follow(label, node.items[i]);
    }
    if (found != nullptr) rest.erase(0, std::min(rest.size(), length + 1));
    return found;
  }

  static bool is_unique(const Node& list, const std::string& label) {
    int count = 0;
    for (const auto& item : list.items) count += label_of(item) == label ? 1 : 0;
    return count == 1;
  }

  /// A block of the top level the deck does not write, e.g. `solver` for solver.max_iterations.
  Node* open_block(Node& root, Node& node, std::string& rest) {
    const auto dot = rest.find('.');
    const std::string name = rest.substr(0, dot);
    const Keyword* keyword = root_blocks().alternatives.front().find(name);
    if (&node != &root || dot == std::string::npos || keyword == nullptr || keyword->type != Type::blocks ||
        keyword->shape != Shape::single || keyword->blocks->has_kind())
      return nullptr;
    Node block;
    block.kind = Node::Kind::mapping;
    insert(node, name, std::move(block));
    rest.erase(0, dot + 1);
    return &node.entries.back().value;
  }

  void insert(Node& mapping, const std::string& key, Node value) {
    value.place.origin = value.label.origin = "--set " + text_;
    Place place;
    place.origin = value.place.origin;
    mapping.entries.push_back({key, place, std::move(value)});
  }

  Node scalar(std::string value) const {
    Node node;
    node.kind = value.empty() ? Node::Kind::empty : Node::Kind::scalar;
    node.text = std::move(value);
    node.place.origin = node.label.origin = "--set " + text_;
    return node;
  }

  static bool is_list(const std::string& value) {
    return value.size() >= 2 && value.front() == '[' && value.back() == ']';
  }

  /// [a, b]: a list of single values.
  Node list(const std::string& value) const {
    Node node = scalar("");
    node.kind = Node::Kind::sequence;
    std::istringstream items(value.substr(1, value.size() - 2));
    for (std::string item; std::getline(items, item, ',');) {
      item.erase(0, item.find_first_not_of(" \"'"));
      item.erase(item.find_last_not_of(" \"'") + 1);
      node.items.push_back(scalar(item));
    }
    return node;
  }

  void add(Node& mapping, const std::string& key, const std::string& value) {
    insert(mapping, key, is_list(value) ? list(value) : scalar(value));
  }

  void set(Node& node, const std::string& value) {
    const bool of_values =
        node.is_sequence() && std::none_of(node.items.begin(), node.items.end(), [](const Node& item) {
          return item.is_mapping() || item.is_sequence();
        });
    if (of_values && is_list(value)) {
      node = list(value);
      return;
    }
    if (node.is_mapping() || node.is_sequence())
      return fail(fmt::format("this is {}, which cannot be set", node.describe()),
                  of_values ? "expected a list such as [a, b], or the path of a single value"
                            : "expected the path of a single value",
                  "below it: " + join(steps_below(node)));
    node = scalar(value);
  }

  void unknown(const Node& node, const std::string& rest) {
    const std::string word = rest.substr(0, rest.find('.'));
    const auto known = steps_below(node);
    fail(fmt::format("the deck has no \"{}\" here", word),
         known.empty() ? "" : "expected one of: " + join(known), did_you_mean(word, known));
  }

  void fail(std::string message, std::string expectation, std::string suggestion) {
    Diagnostic diagnostic;
    diagnostic.where.file = "--set " + text_;
    diagnostic.message = std::move(message);
    diagnostic.expectation = std::move(expectation);
    diagnostic.suggestion = std::move(suggestion);
    complaints_.add(std::move(diagnostic));
  }

  std::string text_;
  Complaints& complaints_;
};

}  // namespace

void apply_overrides(Node& root, const std::vector<std::string>& overrides, Complaints& complaints) {
  for (const auto& text : overrides) Override(text, complaints).apply(root);
}

}  // namespace tautline::deck
