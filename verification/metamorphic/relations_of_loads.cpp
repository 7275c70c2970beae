/// @file
/// Loads that are the same, a support and its reaction, superposition.

#include <cmath>

#include <fmt/format.h>

#include "relation.hpp"
#include "structures.hpp"
#include "transformations.hpp"

namespace tautline::metamorphic {

namespace {

bool all_loads(const Json& step) {
  return step["kind"] == "equilibrium" && !step.contains("control");
}

/// Puts `names` in place of `name` wherever loads act.
void put_in_place(Json& deck, const std::string& name, const std::vector<std::string>& names) {
  for (auto& step : deck["steps"]) {
    if (!step.contains("loads")) continue;
    Json list = Json::array();
    for (const auto& load : step["loads"]) {
      if (load != name)
        list.push_back(load);
      else
        for (const auto& other : names) list.push_back(other);
    }
    step["loads"] = list;
  }
}

/// Loads of a deck that have one of these keys.
std::vector<std::size_t> with_key(const Json& deck, const std::vector<const char*>& keys) {
  std::vector<std::size_t> list;
  for (std::size_t i = 0; i < deck["loads"].size(); ++i)
    for (const char* key : keys)
      if (deck["loads"][i].contains(key)) list.push_back(i);
  return list;
}

/// Every load acts in every equilibrium, so that none is without effect.
void let_all_act(Json& deck) {
  for (auto& step : deck["steps"])
    if (all_loads(step) && !step["loads"].empty()) step["loads"] = load_names(deck);
}

/// A load as the sum of two of its kind.
std::optional<Trial> sum_of_loads(const Json& deck, Random& random) {
  const auto can = with_key(
      deck, {"force", "moment", "line_force", "line_moment", "surface_force", "pressure", "acceleration"});
  if (can.empty()) return std::nullopt;
  Json whole = deck;
  let_all_act(whole);
  Json parts = whole;
  const std::size_t index = random.one_of(can);
  const std::string name = whole["loads"][index]["name"];
  Json second = parts["loads"][index];
  second["name"] = "rest";
  for (auto& item : parts["loads"][index].items()) {
    auto& value = item.value();
    if (value.is_number()) {
      const double all = value, part = all * random.between(-1, 2);
      value = part;
      second[item.key()] = all - part;
    } else if (item.key() != "on" && value.is_array()) {
      const Vec3 all = to_vec3(value), part = all.norm() * random.direction();
      value = to_json(part);
      second[item.key()] = to_json(all - part);
    }
  }
  parts["loads"].push_back(second);
  put_in_place(parts, name, {name, "rest"});
  Trial trial;
  trial.jobs = {{whole}, {parts}};
  trial.judge = [](const Outcomes& o) {
    auto a = o[0], b = o[1];
    for (auto* side : {&a, &b})  // critical loads are factors times the sum of the sizes of the loads' forces
      std::erase_if(side->numbers, [](const auto& item) { return item.second.unit == "critical N"; });
    return compare(a, b, usual_tolerance);
  };
  return trial;
}

/// Adds a force to a node of a table.
using NodeForces = std::map<std::string, Vec3>;

void add(NodeForces& forces, const std::string& node, const Vec3& force) {
  forces.try_emplace(node, Vec3::Zero()).first->second += force;
}

/// A load along cables and bars, or over triangles, as forces on nodes.
NodeForces at_nodes(const Json& deck, const Json& load) {
  NodeForces forces;
  for (const auto& on : load["on"]) {
    for (const auto& element : deck["model"]["elements"][on.get<std::string>()]) {
      std::vector<Vec3> x;
      for (const auto& node : element) x.push_back(place_of(deck, node));
      Vec3 share = Vec3::Zero();
      if (load.contains("line_force")) share = to_vec3(load["line_force"]) * (x[1] - x[0]).norm() / 2;
      if (load.contains("surface_force"))
        share = to_vec3(load["surface_force"]) * (x[1] - x[0]).cross(x[2] - x[0]).norm() / 6;
      for (const auto& node : element) add(forces, node, share);
    }
  }
  return forces;
}

bool acts_on(const Json& deck, const Json& load, const std::vector<std::string>& kinds, std::size_t corners) {
  for (const auto& on : load["on"]) {
    const std::string group = on;
    if (!deck["model"]["elements"].contains(group)) return false;
    bool known = false;
    for (const auto& kind : kinds) known = known || kind_of(deck, group) == kind;
    if (!known) return false;
    for (const auto& element : deck["model"]["elements"][group])
      if (element.size() != corners) return false;
  }
  return true;
}

/// Line loads on cables, bars and surface loads on triangles are forces on nodes; the weight of cables and
/// membranes is such a load; a constant temperature is a field.
std::optional<Trial> equivalent_loads(const Json& deck, Random&) {
  Json first = deck;
  let_all_act(first);
  Json second = first;
  bool any = false;
  for (const auto& load : first["loads"]) {
    const std::string name = load["name"];
    const bool line = load.contains("line_force") && acts_on(deck, load, {"cable", "bar"}, 2);
    const bool surface = load.contains("surface_force") && acts_on(deck, load, {"membrane", "shell"}, 3);
    if (load.contains("temperature_change")) {
      for (auto& other : second["loads"])
        if (other["name"] == name) {
          other["temperature_field"] = fmt::format("{:.17g} + 0*x", load["temperature_change"].get<double>());
          other.erase("temperature_change");
        }
      any = true;
    }
    if (!line && !surface) continue;
    any = true;
    std::vector<std::string> names;
    for (const auto& [node, force] : at_nodes(deck, load)) {
      names.push_back(name + "_" + node);
      second["groups"]["at_" + node] = {{"nodes", Json::array({node})}};
      second["loads"].push_back(
          {{"name", names.back()}, {"on", Json::array({"at_" + node})}, {"force", to_json(force)}});
    }
    put_in_place(second, name, names);
  }
  if (!any) return std::nullopt;
  tidy(second);
  return pair(first, second, unchanged, usual_tolerance);
}

/// The weight of massive cables, bars and membranes is a load along or over them.
std::optional<Trial> weight_as_load(const Json& deck, Random&) {
  Json weight = deck;
  const auto masses = with_key(deck, {"acceleration"});
  if (masses.empty()) return std::nullopt;
  let_all_act(weight);
  Json load = weight;
  const Vec3 g = to_vec3(deck["loads"][masses.front()]["acceleration"]);
  const std::string name = deck["loads"][masses.front()]["name"];
  std::vector<std::string> names;
  for (const auto& group : element_groups(deck)) {
    const Json& section = section_of(deck, group);
    const char* key = section.contains("mass_per_length") ? "mass_per_length" : "mass_per_area";
    const bool cord = section["kind"] == "cable" || section["kind"] == "bar",
               cloth = section["kind"] == "membrane";
    if ((!cord && !cloth) || !section.contains(key)) return std::nullopt;
    if (cord && !deck["groups"][group].contains("tension")) return std::nullopt;
    for (std::size_t i = 0; i < deck["model"]["elements"][group].size(); ++i) {
      const Json& element = deck["model"]["elements"][group][i];
      const std::string own = fmt::format("{}_{}", group, i + 1);
      double mass = section[key];
      if (cord)  // the mass is that of the unstressed length
        mass /= 1 + deck["groups"][group]["tension"].get<double>() / section["axial_stiffness"].get<double>();
      load["model"]["elements"][own] = Json::array({element});
      load["groups"][own] = deck["groups"][group];
      names.push_back("weight_" + own);
      load["loads"].push_back({{"name", names.back()},
                               {"on", Json::array({own})},
                               {cord ? "line_force" : "surface_force", to_json(mass * g)}});
    }
    load["model"]["elements"].erase(group);
    for (auto& other : load["loads"]) {
      if (!other.contains("on")) continue;
      Json on = Json::array();
      for (const auto& item : other["on"]) {
        if (item != group)
          on.push_back(item);
        else
          for (std::size_t i = 0; i < deck["model"]["elements"][group].size(); ++i)
            on.push_back(fmt::format("{}_{}", group, i + 1));
      }
      other["on"] = on;
    }
    load["groups"].erase(group);
  }
  put_in_place(load, name, names);
  tidy(load);
  Trial trial;
  trial.jobs = {{weight}, {load}};
  trial.judge = [](const Outcomes& o) {
    return compare(o[0].only("node "), o[1].only("node "), usual_tolerance);
  };
  return trial;
}

/// Nets and tents whose shape is as drawn, so that lengths and areas are.
Json drawn_structure(Random& random) {
  Json deck;
  do deck = random.chance(0.5) ? cable_net(random) : tent(random);
  while (deck["steps"][0]["kind"] == "form_finding");
  return deck;
}

/// The same without states but tensions, and without what names groups in steps.
Json light_structure(Random& random) {
  Json deck = drawn_structure(random);
  Json steps = Json::array();
  for (const auto& step : deck["steps"])
    if (step["kind"] == "equilibrium") steps.push_back(step);
  deck["steps"] = steps;
  for (auto& [name, group] : deck["groups"].items())
    if (group.contains("section") && section_of(deck, name)["kind"] == "cable" &&
        !group.contains("tension")) {
      group.erase("prestrain");
      group.erase("force_density");
      group["tension"] = section_of(deck, name)["axial_stiffness"].get<double>() * 0.003;
    }
  return deck;
}

/// One support taken away and its reaction put there as a force: nothing moves.
std::optional<Trial> reaction_for_support(const Json& deck, Random& random) {
  if (deck["supports"].size() != 1 || deck["supports"][0]["fix"] != "pinned") return std::nullopt;
  const auto held = supported_nodes(deck);
  if (held.size() < 5) return std::nullopt;
  Json supported = deck;
  Json loads = Json::array(), steps = Json::array();
  for (const auto& load : deck["loads"])
    if (!load.contains("displacement") && !load.contains("rotation")) loads.push_back(load);
  supported["loads"] = loads;
  for (const auto& step : deck["steps"])
    if (all_loads(step) && step["loads"].size() > 0) steps.push_back(step);
  if (steps.empty()) return std::nullopt;
  supported["steps"] = steps;
  tidy(supported);
  const std::string node = random.one_of(held);
  Trial trial;
  trial.jobs = {{supported}};
  trial.then = [supported, node](const Outcomes& o) {
    const Vec3 reaction = o[0].at("node " + node + " reaction");
    if (reaction.norm() < 1e-6 * Scales(o[0]).of({Nature::polar, "N", Vec3::Zero()}, {}))
      return std::vector<Job>{};  // a slack cable would leave the node free to go anywhere
    Json released = supported;
    released["groups"]["freed"] = {{"nodes", Json::array({node})}};
    Json left = Json::array();
    for (const auto& name : supported_nodes(supported))
      if (name != node) left.push_back(name);
    released["groups"]["still held"] = {{"nodes", left}};
    released["supports"][0]["on"] = Json::array({"still held"});
    released["loads"].push_back(
        {{"name", "reaction"}, {"on", Json::array({"freed"})}, {"force", to_json(reaction)}});
    for (auto& step : released["steps"]) step["loads"].push_back("reaction");
    return std::vector<Job>{{released}};
  };
  trial.judge = [node](const Outcomes& o) {
    if (o.size() < 2) return std::vector<Difference>{};
    auto a = o[0].without("step "), b = o[1].without("step ");
    for (auto* side : {&a, &b}) side->numbers.erase("node " + node + " reaction");
    return compare(a, b, 1e-5);
  };
  return trial;
}

/// A structure with two loads so small that their effects add.
Json with_two_small_loads(Random& random) {
  Json deck;
  do deck = any_structure(random);
  while (deck["steps"][0]["kind"] == "form_finding" ||
         section_of(deck, element_groups(deck)[0]).contains("wrinkling"));
  return deck;
}

/// The change that two small loads make together is the sum of the changes that each makes. Between loads of
/// 1e-4 of what the structure can bear, products are 1e-4 of the changes.
std::optional<Trial> superposition(const Json& deck, Random&) {
  Json base = deck;
  Json loads = Json::array();
  for (const auto& load : deck["loads"])
    for (const char* key :
         {"force", "moment", "line_force", "line_moment", "surface_force", "pressure", "acceleration"})
      if (load.contains(key) && loads.size() < 2) {
        Json small = load;
        for (auto& item : small.items()) {
          if (item.value().is_number()) item.value() = item.value().get<double>() * 1e-4;
          if (item.key() != "on" && item.value().is_array())
            item.value() = to_json(1e-4 * to_vec3(item.value()));
        }
        loads.push_back(small);
      }
  if (loads.size() < 2) return std::nullopt;
  base["loads"] = loads;
  base["solver"] = {{"force_tolerance", 1e-12}, {"increment_tolerance", 1e-10}};
  const std::string a = loads[0]["name"], b = loads[1]["name"];
  Trial trial;
  for (const Json& acting : {Json::array(), Json::array({a}), Json::array({b}), Json::array({a, b})}) {
    Json one = base;
    one["steps"] = Json::array({{{"kind", "equilibrium"}, {"loads", acting}}});
    tidy(one);
    trial.jobs.push_back({one});
  }
  trial.judge = [](const Outcomes& o) {
    Outcome sum = o[0], both = o[0];
    sum.numbers.clear();
    both.numbers.clear();
    sum.stiffness = 0;
    double most = 0;
    for (const auto& [key, rest] : o[0].numbers) {
      if (key.rfind("node ", 0) != 0 || rest.unit != "m") continue;
      Quantity q = rest, r = rest;
      q.value = o[1].at(key) + o[2].at(key) - 2 * rest.value;
      r.value = o[3].at(key) - rest.value;
      most = std::max(most, r.value.norm());
      sum.numbers[key] = q;
      both.numbers[key] = r;
    }
    sum.size = 1e3 * most;  // measured by the changes themselves
    return compare(sum, both, 3e-3);
  };
  return trial;
}

}  // namespace

std::vector<Relation> relations_of_loads() {
  const std::string exact = "1e-6 of the largest: only rounding differs";
  return {
      {"sum_of_loads", "A load is the sum of any two of its kind.", exact, any_structure, sum_of_loads},
      {"equivalent_loads",
       "Loads along cables and over triangles are forces at nodes, an even temperature is a field.", exact,
       drawn_structure, equivalent_loads},
      {"weight_as_load", "The weight of cables and membranes is a load along or over them.", exact,
       light_structure, weight_as_load},
      {"reaction_for_support", "A support replaced by its reaction: nothing moves.",
       "1e-5 of the largest: reactions are printed to 1e-10, and a freed node is softer",
       [](Random& r) { return r.chance(0.5) ? cable_net(r) : tent(r); }, reaction_for_support},
      {"superposition", "Changes by two small loads add.",
       "0.3 % of the largest: loads are 1e-4 of what moves the structure by a part of its size",
       with_two_small_loads, superposition},
  };
}

}  // namespace tautline::metamorphic
