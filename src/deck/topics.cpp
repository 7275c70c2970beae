#include <deck/topics.hpp>
#include <tautline/core/text.hpp>

namespace tautline::deck {

std::vector<Topic> all_topics() {
  std::vector<Topic> result;
  for (const Block* block : all_blocks()) {
    if (!block->kind.empty()) result.push_back({block->path, block, nullptr});
    for (const auto& keyword : block->keywords)
      result.push_back(
          {block->path.empty() ? keyword.name : block->path + "." + keyword.name, block, &keyword});
  }
  return result;
}

std::string type_text(const Keyword& keyword) {
  switch (keyword.type) {
    case Type::number:
      return "number";
    case Type::integer:
      return "whole number";
    case Type::boolean:
      return "true or false";
    case Type::text:
      return keyword.refers_to.empty() ? "text" : "name of a " + keyword.refers_to;
    case Type::choice:
      return "word";
    case Type::names:
      return "list of names";
    case Type::vector:
      return "[x, y, z]";
    case Type::directions:
      return "word or list";
    case Type::pair:
      return "number or [first, second]";
    case Type::numbers:
      return "number or list of numbers";
    case Type::points:
      return "[[x, y], ...]";
    case Type::table:
      return "[[number, ...], ...]";
    case Type::releases:
      return "word or list";
    case Type::edges:
      return "[[node, node], ...]";
    case Type::terms:
      return "[[node, direction, coefficient], ...]";
    case Type::coordinates:
      return "name: [x, y, z]";
    case Type::elements:
      return "group: [[node, node], ...]";
    case Type::counts:
      return "group: whole number";
    case Type::parameters:
      return "name: value";
    case Type::blocks:
      return keyword.shape == Shape::list  ? "list of blocks"
             : keyword.shape == Shape::map ? "name: block"
                                           : "block";
  }
  return {};
}

std::string default_text(const Keyword& keyword) {
  return keyword.is_required ? "required" : keyword.fallback;
}

std::string range_text(const Keyword& keyword) {
  if (keyword.type == Type::choice) return join(keyword.choices);
  if (keyword.type == Type::directions) return "all, pinned, symmetry, or a list of x, y, z, rx, ry, rz";
  if (keyword.type == Type::releases) return "all, or a list of torsion, bending_2, bending_3";
  return keyword.range.text();
}

}  // namespace tautline::deck
