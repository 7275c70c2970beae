#include <fmt/format.h>

#include <cmath>
#include <deck/keyword.hpp>
#include <deck/scalars.hpp>
#include <tautline/core/text.hpp>

namespace tautline::deck {

namespace {

void collect(const BlockSet& set, std::vector<const Block*>& list) {
  for (const auto& block : set.alternatives) {
    list.push_back(&block);
    for (const auto& keyword : block.keywords)
      if (keyword.blocks != nullptr) collect(*keyword.blocks, list);
  }
}

std::string with_range(std::string text, const Keyword& keyword) {
  const std::string range = keyword.range.text();
  if (!range.empty()) text += " " + range;
  if (keyword.unit != "-") text += fmt::format(" [{}]", keyword.unit);
  return text;
}

std::string block_expectation(const Keyword& keyword) {
  if (keyword.shape == Shape::list) return "a list of blocks (\"- key: value\")";
  return keyword.shape == Shape::map ? "a mapping (name: ...)" : "a mapping (key: value)";
}

}  // namespace

bool Range::contains(double value) const {
  const bool above = low_open ? value > low : value >= low;
  return above && (high_open ? value < high : value <= high);
}

std::string Range::text() const {
  const bool has_low = std::isfinite(low), has_high = std::isfinite(high);
  if (has_low && has_high)
    return fmt::format("in {}{}, {}{}", low_open ? '(' : '[', format_number(low), format_number(high),
                       high_open ? ')' : ']');
  if (has_low) return fmt::format("{} {}", low_open ? ">" : ">=", format_number(low));
  if (has_high) return fmt::format("{} {}", high_open ? "<" : "<=", format_number(high));
  return {};
}

Keyword& Keyword::in(std::string unit_text) {
  unit = std::move(unit_text);
  return *this;
}
Keyword& Keyword::above(double low) {
  range.low = low;
  range.low_open = true;
  return *this;
}
Keyword& Keyword::at_least(double low) {
  range.low = low;
  return *this;
}
Keyword& Keyword::below(double high) {
  range.high = high;
  range.high_open = true;
  return *this;
}
Keyword& Keyword::at_most(double high) {
  range.high = high;
  return *this;
}
Keyword& Keyword::required() {
  is_required = true;
  fallback.clear();
  return *this;
}
Keyword& Keyword::required_unless(std::function<bool(const Node&)> other) {
  spared = std::move(other);
  return required();
}
Keyword& Keyword::one_of(std::vector<std::string> words) {
  choices = std::move(words);
  return *this;
}
Keyword& Keyword::refers(std::string kind) {
  refers_to = std::move(kind);
  return *this;
}
Keyword& Keyword::also_called(std::vector<std::string> names) {
  other_names = std::move(names);
  return *this;
}
Keyword& Keyword::by_default(std::string text) {
  fallback = std::move(text);
  return *this;
}
Keyword& Keyword::says(std::string text) {
  sentence = std::move(text);
  return *this;
}

std::string Keyword::expectation() const {
  switch (type) {
    case Type::number:
      return with_range("a number", *this);
    case Type::integer:
      return with_range("a whole number", *this);
    case Type::boolean:
      return "true or false";
    case Type::text:
      return refers_to.empty() ? "text" : "the name of a " + refers_to;
    case Type::choice:
      return "one of: " + join(choices);
    case Type::names:
      return "a list of names";
    case Type::vector:
      return with_range("three numbers [x, y, z]", *this);
    case Type::directions:
      return "all, pinned, symmetry, or a list of x, y, z, rx, ry, rz";
    case Type::pair:
      return with_range("a number, or two numbers [first, second]", *this);
    case Type::numbers:
      return with_range("a number for all, or a list of numbers", *this);
    case Type::points:
      return with_range("a list of points [x, y]", *this);
    case Type::table:
      return with_range("a list of lists of numbers", *this);
    case Type::releases:
      return "all, or a list of torsion, bending_2, bending_3";
    case Type::edges:
      return "a list of [node, node]";
    case Type::terms:
      return "a list of [node, direction, coefficient]";
    case Type::coordinates:
      return with_range("node names, each with [x, y, z]", *this);
    case Type::elements:
      return "group names, each with a list of elements [node, ...] of 1 to 4 nodes";
    case Type::counts:
      return "group names, each with a whole number >= 1";
    case Type::parameters:
      return "names, each with a number or a text";
    case Type::blocks:
      return block_expectation(*this);
  }
  return {};
}

const Keyword* Block::find(std::string_view name) const {
  for (const auto& keyword : keywords)
    if (keyword.name == name) return &keyword;
  return nullptr;
}

std::vector<std::string> Block::names() const {
  std::vector<std::string> result;
  if (!kind.empty()) result.emplace_back("kind");
  for (const auto& keyword : keywords) result.push_back(keyword.name);
  return result;
}

const Block* BlockSet::find(std::string_view kind) const {
  for (const auto& block : alternatives)
    if (block.kind == kind) return &block;
  return nullptr;
}

std::vector<std::string> BlockSet::kinds() const {
  std::vector<std::string> result;
  for (const auto& block : alternatives) result.push_back(block.kind);
  return result;
}

std::vector<const Block*> all_blocks() {
  std::vector<const Block*> result;
  collect(root_blocks(), result);
  return result;
}

std::vector<std::string> homes_of(std::string_view key, const Block* but) {
  std::vector<std::string> result;
  for (const Block* block : all_blocks())
    if (block != but && block->find(key) != nullptr)
      result.push_back(block->path.empty() ? "the top level" : block->path);
  return result;
}

}  // namespace tautline::deck
