#include "deck.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

namespace tautline::metamorphic {

namespace {

bool is_plain(const std::string& text) {
  return !text.empty() && std::isalpha(static_cast<unsigned char>(text[0])) != 0 &&
         std::all_of(text.begin(), text.end(),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; });
}

std::string flow(const Json& value) {
  if (value.is_string()) {
    const auto text = value.get<std::string>();
    return is_plain(text) ? text : "\"" + text + "\"";
  }
  if (value.is_number_float()) return fmt::format("{}", value.get<double>());
  if (!value.is_structured()) return value.dump();
  std::string text;
  for (const auto& item : value.items()) {
    if (!text.empty()) text += ", ";
    if (value.is_object()) text += flow(Json(item.key())) + ": ";
    text += flow(item.value());
  }
  return value.is_object() ? "{" + text + "}" : "[" + text + "]";
}

/// The model: one line for each node and each group.
std::string model_block(const Json& model) {
  std::string text = "model:\n";
  for (const auto& part : model.items()) {
    if (!part.value().is_structured()) {
      text += fmt::format("  {}: {}\n", part.key(), flow(part.value()));
      continue;
    }
    text += fmt::format("  {}:\n", part.key());
    for (const auto& item : part.value().items())
      text += part.value().is_object()
                  ? fmt::format("    {}: {}\n", flow(Json(item.key())), flow(item.value()))
                  : fmt::format("    - {}\n", flow(item.value()));
  }
  return text;
}

}  // namespace

std::string yaml(const Json& deck) {
  std::string text;
  for (const auto& block : deck.items()) {
    const Json& value = block.value();
    if (block.key() == "model") {
      text += model_block(value);
    } else if (!value.is_structured() || value.empty()) {
      text += fmt::format("{}: {}\n", block.key(), flow(value));
    } else {
      text += block.key() + ":\n";
      for (const auto& item : value.items())
        text += value.is_object() ? fmt::format("  {}: {}\n", flow(Json(item.key())), flow(item.value()))
                                  : fmt::format("  - {}\n", flow(item.value()));
    }
  }
  return text;
}

Json to_json(const Vec3& v) {
  return Json::array({v[0], v[1], v[2]});
}

Vec3 to_vec3(const Json& list) {
  return {list[0].get<double>(), list[1].get<double>(), list[2].get<double>()};
}

Builder::Builder() {
  deck = {{"title", "random structure"},
          {"units", "SI"},
          {"model", {{"nodes", Json::object()}, {"elements", Json::object()}}},
          {"materials", Json::object()},
          {"sections", Json::object()},
          {"groups", Json::object()},
          {"supports", Json::array()},
          {"loads", Json::array()},
          {"steps", Json::array()}};
}

std::string Builder::node(const Vec3& at) {
  const std::string name = fmt::format("n{}", deck["model"]["nodes"].size() + 1);
  deck["model"]["nodes"][name] = to_json(at);
  return name;
}

void Builder::element(const std::string& group, const std::vector<std::string>& nodes) {
  deck["model"]["elements"][group].push_back(nodes);
}

void Builder::group(const std::string& name, const Json& state) {
  Json entry = {{"section", name}};
  entry.update(state);
  deck["groups"][name] = entry;
}

void Builder::section(const std::string& name, const Json& section) {
  deck["sections"][name] = section;
}

void Builder::nodes(const std::string& name, const std::vector<std::string>& list) {
  deck["groups"][name] = {{"nodes", list}};
}

void Builder::support(const std::string& on, const Json& fix, const Json& more) {
  Json entry = {{"name", fmt::format("support_{}", deck["supports"].size() + 1)}, {"on", {on}}, {"fix", fix}};
  entry.update(more);
  deck["supports"].push_back(entry);
}

void Builder::load(const std::string& name, const Json& load) {
  Json entry = {{"name", name}};
  entry.update(load);
  deck["loads"].push_back(entry);
}

void Builder::step(const Json& step) {
  deck["steps"].push_back(step);
}

std::vector<std::string> load_names(const Json& deck) {
  std::vector<std::string> names;
  if (deck.contains("loads"))
    for (const auto& load : deck["loads"]) names.push_back(load["name"]);
  return names;
}

std::vector<std::string> element_groups(const Json& deck) {
  std::vector<std::string> names;
  if (deck.contains("model"))
    for (const auto& item : deck["model"]["elements"].items()) names.push_back(item.key());
  return names;
}

const Json& section_of(const Json& deck, const std::string& group) {
  return deck["sections"][deck["groups"][group]["section"].get<std::string>()];
}

std::string kind_of(const Json& deck, const std::string& group) {
  return section_of(deck, group)["kind"];
}

std::vector<std::string> nodes_of(const Json& deck, const std::string& name) {
  std::set<std::string> found;
  const auto& group = deck["groups"][name];
  if (group.contains("nodes"))
    for (const auto& node : group["nodes"]) found.insert(node);
  if (group.contains("edges"))
    for (const auto& edge : group["edges"])
      for (const auto& node : edge) found.insert(node);
  if (deck["model"]["elements"].contains(name))
    for (const auto& element : deck["model"]["elements"][name])
      for (const auto& node : element) found.insert(node);
  return {found.begin(), found.end()};
}

std::vector<std::string> supported_nodes(const Json& deck) {
  std::set<std::string> found;
  for (const auto& support : deck["supports"])
    for (const auto& on : support["on"])
      for (const auto& node : nodes_of(deck, on)) found.insert(node);
  return {found.begin(), found.end()};
}

bool has_rotations(const Json& deck, const std::string& node) {
  static const std::set<std::string> without{"cable", "bar", "catenary", "membrane", "spring", "mass"};
  for (const auto& [group, elements] : deck["model"]["elements"].items()) {
    if (without.count(kind_of(deck, group)) != 0) continue;
    for (const auto& element : elements)
      if (std::find(element.begin(), element.end(), node) != element.end()) return true;
  }
  return false;
}

Vec3 place_of(const Json& deck, const std::string& node) {
  return to_vec3(deck["model"]["nodes"][node]);
}

double size_of(const Json& deck) {
  Vec3 low = Vec3::Constant(1e300), high = -low;
  for (const auto& item : deck["model"]["nodes"].items()) {
    low = low.cwiseMin(to_vec3(item.value()));
    high = high.cwiseMax(to_vec3(item.value()));
  }
  return (high - low).maxCoeff();
}

double stiffness_of(const Json& deck) {
  double most = 0;
  const double size = size_of(deck);
  for (const auto& [name, section] : deck["sections"].items()) {
    const auto value = [&](const char* key) { return section.value(key, 0.0); };
    most = std::max({most, value("axial_stiffness"), value("tension_stiffness") * size});
    if (!section.contains("material")) continue;
    const double modulus = deck["materials"][section["material"].get<std::string>()]["young_modulus"];
    const double width =
        std::max({value("width"), value("diameter"), value("side"), value("diameter_start")});
    const double area =
        std::max({value("area"), std::pow(std::max(width, value("height")), 2), value("thickness") * size});
    most = std::max(most, modulus * area);
  }
  return most;
}

namespace {

/// Entries of a list for which the condition holds.
template <class Condition>
Json kept(const Json& list, Condition&& holds) {
  Json result = Json::array();
  for (const auto& entry : list)
    if (holds(entry)) result.push_back(entry);
  return result;
}

void keep_known(Json& entry, const std::string& key, const std::set<std::string>& known) {
  if (entry.contains(key) && entry[key].is_array())
    entry[key] = kept(entry[key], [&](const Json& name) { return known.count(name) != 0; });
}

bool acts_on_something(const Json& load) {
  return load.contains("acceleration") || !load["on"].empty();
}

void tidy_groups(Json& deck, const std::set<std::string>& nodes) {
  Json groups = Json::object();
  const Json& elements = deck["model"]["elements"];
  for (auto [name, group] : deck["groups"].items()) {
    if (group.contains("nodes")) {
      Json left = group;
      left["nodes"] = kept(group["nodes"], [&](const Json& n) { return nodes.count(n) != 0; });
      if (!left["nodes"].empty()) groups[name] = left;
    } else if (group.contains("edges")) {
      Json left = group;
      left["edges"] = kept(group["edges"], [&](const Json& edge) {
        return nodes.count(edge[0]) != 0 && nodes.count(edge[1]) != 0;
      });
      if (!left["edges"].empty()) groups[name] = left;
    } else if (elements.contains(name)) {
      groups[name] = group;
    }
  }
  deck["groups"] = groups;
}

void tidy_steps(Json& deck, const std::set<std::string>& groups) {
  const auto names = load_names(deck);
  const std::set<std::string> loads(names.begin(), names.end());
  for (auto& step : deck["steps"]) {
    for (const char* key : {"loads", "disturbance"}) keep_known(step, key, loads);
    for (const char* key : {"monitor", "net", "fixed", "cloth", "constant_tension"})
      keep_known(step, key, groups);
    if (step.contains("monitor") && step["monitor"].empty()) step.erase("monitor");
    if (step.contains("stages"))
      for (auto& stage : step["stages"]) keep_known(stage, "hold", groups);
  }
}

}  // namespace

void tidy(Json& deck) {
  if (!deck.contains("model")) return;
  auto& model = deck["model"];
  Json elements = Json::object();
  std::set<std::string> used;
  for (const auto& [group, list] : model["elements"].items()) {
    if (list.empty()) continue;
    elements[group] = list;
    for (const auto& element : list)
      for (const auto& node : element) used.insert(node);
  }
  model["elements"] = elements;
  Json nodes = Json::object();
  for (const auto& item : model["nodes"].items())
    if (used.count(item.key()) != 0) nodes[item.key()] = item.value();
  model["nodes"] = nodes;
  tidy_groups(deck, used);
  std::set<std::string> groups, sections;
  for (const auto& item : deck["groups"].items()) {
    groups.insert(item.key());
    if (item.value().contains("section")) sections.insert(item.value()["section"]);
  }
  for (auto* list : {&deck["supports"], &deck["loads"]})
    for (auto& entry : *list) keep_known(entry, "on", groups);
  deck["supports"] = kept(deck["supports"], [](const Json& s) { return !s["on"].empty(); });
  deck["loads"] = kept(deck["loads"], acts_on_something);
  Json left = Json::object();
  std::set<std::string> materials;
  for (const auto& item : deck["sections"].items()) {
    if (sections.count(item.key()) == 0) continue;
    left[item.key()] = item.value();
    if (item.value().contains("material")) materials.insert(item.value()["material"]);
  }
  deck["sections"] = left;
  left = Json::object();
  for (const auto& item : deck["materials"].items())
    if (materials.count(item.key()) != 0) left[item.key()] = item.value();
  deck["materials"] = left;
  tidy_steps(deck, groups);
}

}  // namespace tautline::metamorphic
