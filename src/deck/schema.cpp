#include <cmath>
#include <deck/keywords.hpp>
#include <deck/topics.hpp>
#include <nlohmann/json.hpp>
#include <tautline/deck/deck.hpp>

namespace tautline::deck {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* parameter = "#/$defs/parameter";

Json block_schema(const Block& block);

/// The value, or a parameter that stands for it.
Json or_parameter(Json value) {
  return {{"anyOf", Json::array({std::move(value), {{"$ref", parameter}}})}};
}

Json number_schema(const Keyword& keyword, const char* type) {
  Json value{{"type", type}};
  const Range& range = keyword.range;
  if (std::isfinite(range.low)) value[range.low_open ? "exclusiveMinimum" : "minimum"] = range.low;
  if (std::isfinite(range.high)) value[range.high_open ? "exclusiveMaximum" : "maximum"] = range.high;
  return or_parameter(std::move(value));
}

Json list_of(Json items) {
  return {{"type", "array"}, {"items", std::move(items)}};
}
Json map_of(Json values) {
  return {{"type", "object"}, {"additionalProperties", std::move(values)}};
}
Json name_schema() {
  return {{"type", Json::array({"string", "number"})}};
}

/// A list of `n` entries.
Json tuple_of(Json items, int n) {
  Json list = list_of(std::move(items));
  list["minItems"] = n;
  list["maxItems"] = n;
  return list;
}

Json vector_schema() {
  return tuple_of(or_parameter({{"type", "number"}}), 3);
}

Json set_schema(const BlockSet& set) {
  if (!set.has_kind()) return block_schema(set.alternatives.front());
  Json alternatives = Json::array();
  for (const auto& block : set.alternatives) alternatives.push_back(block_schema(block));
  return {{"oneOf", std::move(alternatives)}};
}

Json blocks_schema(const Keyword& keyword) {
  Json inner = set_schema(*keyword.blocks);
  if (keyword.shape == Shape::list) return list_of(std::move(inner));
  return keyword.shape == Shape::map ? map_of(std::move(inner)) : inner;
}

Json directions_schema() {
  return {{"anyOf", Json::array({{{"enum", {"all", "pinned", "symmetry"}}},
                                 list_of({{"enum", {"x", "y", "z", "rx", "ry", "rz"}}}),
                                 {{"$ref", parameter}}})}};
}

Json releases_schema() {
  return {{"anyOf",
           Json::array({{{"enum", {"all"}}}, list_of({{"enum", {"torsion", "bending_2", "bending_3"}}})})}};
}

Json pair_schema(const Keyword& keyword) {
  const Json number = number_schema(keyword, "number");
  return {{"anyOf", Json::array({number, tuple_of(number, 2)})}};
}

Json value_schema(const Keyword& keyword) {
  switch (keyword.type) {
    case Type::number:
      return number_schema(keyword, "number");
    case Type::integer:
      return number_schema(keyword, "integer");
    case Type::boolean:
      return or_parameter({{"type", "boolean"}});
    case Type::text:
      return name_schema();
    case Type::choice:
      return or_parameter({{"enum", keyword.choices}});
    case Type::names:
      return {{"anyOf", Json::array({list_of(name_schema()), name_schema()})}};
    case Type::vector:
      return vector_schema();
    case Type::directions:
      return directions_schema();
    case Type::pair:
      return pair_schema(keyword);
    case Type::numbers: {
      const Json number = number_schema(keyword, "number");
      return {{"anyOf", Json::array({number, list_of(number)})}};
    }
    case Type::points:
      return list_of(tuple_of(number_schema(keyword, "number"), 2));
    case Type::table:
      return list_of(list_of(number_schema(keyword, "number")));
    case Type::releases:
      return releases_schema();
    case Type::edges:
      return list_of(tuple_of(name_schema(), 2));
    case Type::terms:
      return list_of(tuple_of(name_schema(), 3));
    case Type::coordinates:
      return map_of(vector_schema());
    case Type::elements:
      return map_of(list_of({{"type", "array"}, {"items", name_schema()}, {"minItems", 1}, {"maxItems", 4}}));
    case Type::counts:
      return map_of(number_schema(keyword, "integer"));
    case Type::parameters:
      return map_of({{"type", Json::array({"number", "string", "boolean"})}});
    case Type::blocks:
      return blocks_schema(keyword);
  }
  return {};
}

std::string description(const Keyword& keyword) {
  std::string text = keyword.sentence;
  if (keyword.unit != "-") text += " [" + keyword.unit + "]";
  if (!keyword.fallback.empty()) text += " Default: " + keyword.fallback + ".";
  return text;
}

Json block_schema(const Block& block) {
  Json properties = Json::object();
  Json required = Json::array();
  if (!block.kind.empty()) {
    properties["kind"] = {{"const", block.kind}, {"description", block.sentence}};
    required.push_back("kind");
  }
  for (const auto& keyword : block.keywords) {
    Json value = value_schema(keyword);
    value["description"] = description(keyword);
    properties[keyword.name] = std::move(value);
    if (keyword.is_required && !keyword.spared) required.push_back(keyword.name);
  }
  Json result{{"type", "object"}, {"additionalProperties", false}, {"properties", std::move(properties)}};
  if (!required.empty()) result["required"] = std::move(required);
  return result;
}

/// What each kind of structure needs at the top level besides what all need.
Json structures() {
  Json all = Json::array();
  for (const auto& kind : reflector_blocks().kinds()) {
    Json entry{{"properties", {{"reflector", {{"properties", {{"kind", {{"const", kind}}}}}}}}}};
    entry["required"] = {"reflector"};
    if (!is_complete_structure(kind)) entry["required"] = {"reflector", "sections", "groups"};
    all.push_back(std::move(entry));
  }
  all.push_back({{"required", {"model", "sections", "groups"}}});
  return all;
}

}  // namespace

std::string schema() {
  Json result{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "Tautline deck"}};
  result.update(block_schema(root_blocks().alternatives.front()));
  result["oneOf"] = structures();
  result["$defs"]["parameter"] = {
      {"type", "string"}, {"pattern", R"(\$\{[^}]+\})"}, {"description", "A parameter, ${name}."}};
  return result.dump(2) + "\n";
}

}  // namespace tautline::deck
