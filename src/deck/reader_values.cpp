#include <fmt/format.h>

#include <algorithm>
#include <deck/reader.hpp>
#include <deck/scalars.hpp>
#include <tautline/core/text.hpp>

namespace tautline::deck {

void Reader::wrong_value(const Keyword& keyword, const Node& node, const std::string& fault,
                         const std::string& remedy) {
  const std::string value = !node.is_scalar() ? ""
                            : node.quoted     ? fmt::format(" = \"{}\"", node.text)
                                              : " = " + node.text;
  complain(node, fmt::format("{}{} {}", keyword.name, value, fault), "expected " + keyword.expectation(),
           remedy);
}

bool Reader::expect(Node::Kind kind, const Keyword& keyword, const Node& node) {
  if (node.kind == kind) return true;
  wrong_value(keyword, node, node.is_scalar() ? "does not fit here" : "is " + node.describe());
  return false;
}

bool Reader::plain_scalar(const Keyword& keyword, const Node& node) {
  if (!expect(Node::Kind::scalar, keyword, node)) return false;
  if (!node.quoted) return true;
  wrong_value(keyword, node, "is text, because of the quotes", fmt::format("write {}", node.text));
  return false;
}

std::optional<double> Reader::number(const Keyword& keyword, const Node& node) {
  if (!node.is_scalar()) {
    wrong_value(keyword, node, "is " + node.describe());
    return {};
  }
  const auto parsed = parse_number(node.text, keyword.unit);
  if (!parsed.value) {
    wrong_value(keyword, node, parsed.fault, parsed.remedy);
    return {};
  }
  if (!plain_scalar(keyword, node)) return {};
  if (keyword.range.contains(*parsed.value)) return parsed.value;
  wrong_value(keyword, node, "is out of range");
  return {};
}

std::optional<int> Reader::integer(const Keyword& keyword, const Node& node) {
  if (!plain_scalar(keyword, node)) return {};
  const auto parsed = parse_integer(node.text);
  if (!parsed.value) {
    wrong_value(keyword, node, parsed.fault, parsed.remedy);
    return {};
  }
  if (keyword.range.contains(*parsed.value)) return parsed.value;
  wrong_value(keyword, node, "is out of range");
  return {};
}

std::optional<bool> Reader::boolean(const Keyword& keyword, const Node& node) {
  if (!plain_scalar(keyword, node)) return {};
  const auto parsed = parse_boolean(node.text);
  if (!parsed.value) wrong_value(keyword, node, parsed.fault, parsed.remedy);
  return parsed.value;
}

std::optional<std::string> Reader::text(const Keyword& keyword, const Node& node) {
  if (!expect(Node::Kind::scalar, keyword, node)) return {};
  refer(keyword.refers_to, node);
  return node.text;
}

std::optional<std::string> Reader::choice(const Keyword& keyword, const Node& node) {
  if (!expect(Node::Kind::scalar, keyword, node)) return {};
  const auto& known = keyword.choices;
  if (std::find(known.begin(), known.end(), node.text) != known.end()) return node.text;
  complain(node, fmt::format("unknown {} \"{}\"", keyword.name, node.text),
           "expected " + keyword.expectation(), did_you_mean(node.text, known));
  return {};
}

std::optional<std::vector<std::string>> Reader::names(const Keyword& keyword, const Node& node) {
  if (node.is_scalar()) {
    refer(keyword.refers_to, node);
    return std::vector<std::string>{node.text};
  }
  if (!expect(Node::Kind::sequence, keyword, node)) return {};
  std::vector<std::string> result;
  std::set<std::string_view> seen;
  for (const auto& item : node.items) {
    if (!expect(Node::Kind::scalar, keyword, item)) continue;
    if (!seen.insert(item.text).second)
      complain(item, fmt::format("\"{}\" stands twice in \"{}\"", item.text, keyword.name));
    refer(keyword.refers_to, item);
    result.push_back(item.text);
  }
  return result;
}

std::optional<Vec3> Reader::vector(const Keyword& keyword, const Node& node) {
  if (!expect(Node::Kind::sequence, keyword, node)) return {};
  if (node.items.size() != 3) {
    wrong_value(keyword, node,
                fmt::format("has {} number{}", node.items.size(), node.items.size() == 1 ? "" : "s"));
    return {};
  }
  Vec3 result = Vec3::Zero();
  bool complete = true;
  for (int i = 0; i < 3; ++i) {
    const auto value = number(keyword, node.items[static_cast<std::size_t>(i)]);
    complete = complete && value.has_value();
    result[i] = value.value_or(0);
  }
  if (!complete) return {};
  return result;
}

std::optional<std::array<double, 2>> Reader::pair(const Keyword& keyword, const Node& node) {
  if (node.is_scalar()) {
    const auto both = number(keyword, node);
    if (!both) return {};
    return std::array{*both, *both};
  }
  if (!expect(Node::Kind::sequence, keyword, node)) return {};
  if (node.items.size() != 2) {
    wrong_value(keyword, node,
                fmt::format("has {} number{}", node.items.size(), node.items.size() == 1 ? "" : "s"));
    return {};
  }
  const auto first = number(keyword, node.items[0]), second = number(keyword, node.items[1]);
  if (!first || !second) return {};
  return std::array{*first, *second};
}

std::optional<std::vector<double>> Reader::numbers(const Keyword& keyword, const Node& node) {
  std::vector<double> result;
  if (node.is_sequence() && node.items.empty()) {
    wrong_value(keyword, node, "is an empty list");
    return {};
  }
  const std::vector<Node> one{node};
  bool complete = true;
  for (const Node& item : node.is_sequence() ? node.items : one) {
    const auto value = number(keyword, item);
    complete = complete && value.has_value();
    result.push_back(value.value_or(0));
  }
  if (!complete) return {};
  return result;
}

void Reader::refer(const std::string& kind, const Node& node) {
  if (!kind.empty()) references_.push_back({kind, node.text, node.place, node.note, context()});
}

void Reader::refer_key(const std::string& kind, const Entry& entry) {
  references_.push_back({kind, entry.key, entry.place, {}, context()});
}

}  // namespace tautline::deck
