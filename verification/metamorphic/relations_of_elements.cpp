/// @file
/// One kind of element, division or initial state for another.

#include <cmath>

#include <fmt/format.h>

#include "relation.hpp"
#include "structures.hpp"
#include "transformations.hpp"

namespace tautline::metamorphic {

namespace {

double length_of(const Json& deck, const Json& element) {
  return (place_of(deck, element[1]) - place_of(deck, element[0])).norm();
}

bool is_cord(const Json& deck, const std::string& group) {
  return kind_of(deck, group) == "cable";
}

/// Prestrain of a cable said in any way.
double prestrain_of(const Json& deck, const std::string& group, const Json& element) {
  const Json& state = deck["groups"][group];
  const double length = length_of(deck, element), stiffness = section_of(deck, group)["axial_stiffness"];
  if (state.contains("prestrain")) return state["prestrain"];
  if (state.contains("unstressed_length")) return length / state["unstressed_length"].get<double>() - 1;
  if (state.contains("tension")) return state["tension"].get<double>() / stiffness;
  if (state.contains("force_density")) return state["force_density"].get<double>() * length / stiffness;
  return 0;
}

void keep_loads(Json& deck, const std::vector<const char*>& keys) {
  Json loads = Json::array();
  for (const auto& load : deck["loads"])
    for (const char* key : keys)
      if (load.contains(key)) loads.push_back(load);
  deck["loads"] = loads;
  tidy(deck);
}

void keep_equilibria(Json& deck) {
  Json steps = Json::array();
  for (const auto& step : deck["steps"])
    if (step["kind"] == "equilibrium") steps.push_back(step);
  deck["steps"] = steps;
}

void forget_state(Json& group) {
  for (const char* key : {"tension", "prestrain", "force_density", "unstressed_length"}) group.erase(key);
}

/// Each cable of a group a group of its own, so that each can have a state of its own.
template <class Change>
Json one_by_one(const Json& deck, const std::string& group, Change&& change) {
  Json result = deck;
  const Json elements = result["model"]["elements"][group];
  result["model"]["elements"].erase(group);
  Json entry = result["groups"][group];
  result["groups"].erase(group);
  std::vector<std::string> names;
  for (const auto& element : elements) {
    names.push_back(fmt::format("{}_{}", group, names.size() + 1));
    result["model"]["elements"][names.back()] = Json::array({element});
    Json own = entry;
    change(own, element);
    result["groups"][names.back()] = own;
  }
  for (const char* block : {"loads", "supports"})
    for (auto& item : result[block]) {
      if (!item.contains("on")) continue;
      Json on = Json::array();
      for (const auto& name : item["on"]) {
        if (name != group)
          on.push_back(name);
        else
          for (const auto& part : names) on.push_back(part);
      }
      item["on"] = on;
    }
  for (auto& step : result["steps"])
    if (step.contains("unknowns"))
      for (auto& unknown : step["unknowns"]) {
        Json on = Json::array();
        for (const auto& name : unknown["on"])
          if (name != group) on.push_back(name);
        for (const auto& name : names) on.push_back(name);
        unknown["on"] = on;
      }
  return result;
}

/// Numbers of nodes and steps; elements of groups that were renamed go under one name again.
Outcome under_one_name(const Outcome& outcome, const std::string& group) {
  Outcome result = outcome;
  result.numbers.clear();
  for (const auto& [key, quantity] : outcome.numbers) {
    const std::string prefix = "cable " + group + "_";
    if (key.find("group " + group) != std::string::npos) continue;
    if (key.rfind(prefix, 0) == 0)
      result.numbers["cable " + group + key.substr(key.find(' ', prefix.size()))] = quantity;
    else
      result.numbers[key] = quantity;
  }
  return result;
}

/// A net that is not form-found, whose cables have a state said in any way.
Json drawn_net(Random& random) {
  Json deck;
  do deck = cable_net(random);
  while (deck["steps"][0]["kind"] == "form_finding");
  return deck;
}

std::optional<std::string> cable_group(const Json& deck, Random& random) {
  std::vector<std::string> names;
  for (const auto& group : element_groups(deck))
    if (is_cord(deck, group)) names.push_back(group);
  if (names.empty()) return std::nullopt;
  return random.one_of(names);
}

/// tension, prestrain, force_density and unstressed_length of each cable mean the same.
std::optional<Trial> initial_state(const Json& deck, Random& random) {
  const auto group = cable_group(deck, random);
  if (!group) return std::nullopt;
  const double stiffness = section_of(deck, *group)["axial_stiffness"];
  const Json other = one_by_one(deck, *group, [&](Json& state, const Json& element) {
    const double strain = prestrain_of(deck, *group, element), length = length_of(deck, element);
    forget_state(state);
    switch (random.whole(0, 3)) {
      case 0:
        state["tension"] = stiffness * strain;
        break;
      case 1:
        state["prestrain"] = strain;
        break;
      case 2:
        state["force_density"] = stiffness * strain / length;
        break;
      default:
        state["unstressed_length"] = length / (1 + strain);
    }
  });
  Trial trial;
  trial.jobs = {{deck}, {other}};
  trial.judge = [g = *group](const Outcomes& o) {
    return compare(under_one_name(o[0], g), under_one_name(o[1], g), usual_tolerance);
  };
  return trial;
}

/// Cooled cables are shorter cables.
std::optional<Trial> heat_and_prestrain(const Json& deck, Random& random) {
  const auto group = cable_group(deck, random);
  if (!group) return std::nullopt;
  const double warm = random.between(-60, 40), grown = 1 + 1.2e-5 * warm;
  Json heated = deck;
  keep_loads(heated, {"force", "line_force", "displacement"});
  keep_equilibria(heated);
  heated["sections"][heated["groups"][*group]["section"].get<std::string>()]["thermal_expansion"] = 1.2e-5;
  Json strained = one_by_one(heated, *group, [&](Json& state, const Json& element) {
    const double strain = prestrain_of(heated, *group, element);
    forget_state(state);
    state["prestrain"] = (1 + strain) / grown - 1;
  });
  heated["loads"].push_back({{"name", "warmth"}, {"on", {*group}}, {"temperature_change", warm}});
  for (auto& step : heated["steps"])
    if (step["kind"] == "equilibrium") step["loads"].push_back("warmth");
  Trial trial;
  trial.jobs = {{heated}, {strained}};
  trial.judge = [g = *group](const Outcomes& o) {
    auto a = under_one_name(o[0], g), b = under_one_name(o[1], g);
    for (auto* side :
         {&a, &b})  // an unstressed length is that at the reference temperature, and so is the mass
      std::erase_if(side->numbers, [](const auto& item) {
        return item.first.find("group") != std::string::npos ||
               item.first.find("unstressed") != std::string::npos || item.first == "mass";
      });
    return compare(a, b, usual_tolerance);
  };
  return trial;
}

/// Whether no bar is in compression and no cable slack, in any step.
bool taut_all_along(const Outcome& outcome) {
  for (const auto& [key, q] : outcome.numbers)
    if (key.find(" tension_min") != std::string::npos && q.value[0] <= 0) return false;
  return all_taut(outcome);
}

/// Summaries of groups hold other figures for bars.
Outcome of_elements(const Outcome& outcome) {
  Outcome result = outcome;
  std::erase_if(result.numbers,
                [](const auto& item) { return item.first.find(" axial_") != std::string::npos; });
  return result;
}

/// Factors that cables go slack on the way to, which bars do not, are left out.
void leave_out_slack_factors(Outcome& a, Outcome& b) {
  const bool first =
      a.warnings.count("slack_at_first_factor") + b.warnings.count("slack_at_first_factor") > 0;
  const bool behind = a.warnings.count("buckling_slack") + b.warnings.count("buckling_slack") > 0;
  for (auto* outcome : {&a, &b})
    std::erase_if(outcome->numbers, [&](const auto& item) {
      const auto& unit = item.second.unit;
      if (unit != "factor" && unit != "critical N") return false;
      return first || (behind && item.first.back() != '1');
    });
}

std::optional<Trial> bar_for_cable(const Json& deck, Random& random) {
  Json other = deck;
  bool any = false;
  for (auto& item : other["sections"].items()) {
    auto& kind = item.value()["kind"];
    if (kind == "cable" && random.chance(0.7)) {
      bool can = true;  // bars know tensions and force densities only
      for (const auto& [name, group] : deck["groups"].items())
        if (group.value("section", "") == item.key())
          can = can && !group.contains("prestrain") && !group.contains("unstressed_length");
      if (can) kind = "bar", any = true;
    } else if (kind == "bar") {
      kind = "cable";
      any = true;
    }
  }
  if (!any) return std::nullopt;
  Trial trial;
  trial.jobs = {{deck}, {other}};
  trial.any_end = true;  // where cables go slack the other one may end otherwise
  trial.judge = [](const Outcomes& o) {
    if (o[0].done() != o[1].done()) {
      const auto& done = o[0].done() ? o[0] : o[1];
      const auto& failed = o[0].done() ? o[1] : o[0];
      if (!taut_all_along(done)) return std::vector<Difference>{};
      return std::vector<Difference>{{"taut all along, but one ends otherwise: " + failed.message, 10}};
    }
    if (!o[0].done()) return std::vector<Difference>{};
    if (!taut_all_along(o[0]) || !taut_all_along(o[1])) return std::vector<Difference>{};
    auto a = of_elements(o[0]), b = of_elements(o[1]);
    leave_out_slack_factors(a, b);
    return compare(a, b, usual_tolerance);
  };
  return trial;
}

/// Cables as catenaries of a thousandth of their mass. Without load along them their forces differ by (w L /
/// T)^2 / 24.
std::optional<Trial> light_catenary(const Json& deck, Random& random) {
  const auto group = cable_group(deck, random);
  if (!group) return std::nullopt;
  Json light = deck;
  keep_loads(light, {"force", "displacement", "acceleration", "temperature_change"});
  keep_equilibria(light);  // catenaries have masses of their own
  light["sections"][light["groups"][*group]["section"].get<std::string>()]["mass_per_length"] = 1e-9;
  Json hanging = one_by_one(light, *group, [&](Json& state, const Json& element) {
    const double strain = prestrain_of(light, *group, element);
    forget_state(state);
    state["unstressed_length"] = length_of(light, element) / (1 + strain);
  });
  hanging["sections"][light["groups"][*group]["section"].get<std::string>()]["kind"] = "catenary";
  Trial trial;
  trial.jobs = {{light}, {hanging}};
  trial.judge = [g = *group](const Outcomes& o) {
    if (!taut_all_along(o[0])) return std::vector<Difference>{};
    auto a = under_one_name(o[0], g), b = under_one_name(o[1], g);
    for (auto* side : {&a, &b}) side->numbers.erase("mass");
    return compare(a, b, usual_tolerance);
  };
  return trial;
}

/// Frames whose deformation is small: beams of one element are exact under loads at nodes.
Json slightly_loaded_frame(Random& random) {
  Json deck;
  bool tapered = true;
  while (tapered) {
    deck = frame(random);
    tapered = false;
    for (const auto& item : deck["sections"].items())
      tapered = tapered || item.value()["kind"] == "tapered_tube";
  }
  for (auto& load : deck["loads"])
    for (const char* key : {"force", "moment", "displacement", "rotation", "line_force"})
      if (load.contains(key)) load[key] = to_json(1e-5 * to_vec3(load[key]));
  keep_loads(deck, {"force", "moment", "displacement", "rotation", "line_force"});
  deck["steps"] = Json::array({{{"kind", "equilibrium"}}});
  tidy(deck);
  return deck;
}

/// In linear theory cubic beams are exact at their nodes; what is left is of the second order in the
/// rotations, which are some 1e-6, over the softness of the frame.
std::optional<Trial> divided_beams(const Json& deck, Random& random) {
  if (deck["loads"].empty()) return std::nullopt;
  Json divided = deck;
  const Json mesh{{"kind", "mesh"}, {"subdivisions", random.whole(2, 5)}};
  divided["steps"].insert(divided["steps"].begin(), mesh);
  Trial trial;
  trial.jobs = {{deck}, {divided}};
  trial.judge = [](const Outcomes& o) { return compare(o[0].only("node "), o[1].only("node "), 1e-4); };
  return trial;
}

/// A rectangle of membrane or shell, pulled at its straight edges so that it is in one state of stress all
/// over. Every division into facets carries that exactly.
Json stretched_patch(Random& random) {
  Builder b;
  const double cell = random.magnitude(0.3, 5), stiffness = random.magnitude(1e4, 1e6);
  const int n = random.whole(2, 4), m = random.whole(2, 4);
  std::vector<std::string> names;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= m; ++j) {
      const double shake = 0.2 * cell, x = i % n == 0 ? 0 : shake, y = j % m == 0 ? 0 : shake;
      names.push_back(b.node({i * cell + random.between(-x, x), j * cell + random.between(-y, y), 0}));
    }
  const auto at = [&](int i, int j) { return names[static_cast<std::size_t>(i * (m + 1) + j)]; };
  if (random.chance(0.3)) {
    b.deck["materials"]["film"] = {
        {"young_modulus", stiffness / (0.01 * cell)}, {"poisson_ratio", 0.3}, {"density", 1000.0}};
    b.section("cloth", {{"kind", "shell"}, {"material", "film"}, {"thickness", 0.01 * cell}});
  } else {
    b.section("cloth", {{"kind", "membrane"},
                        {"tension_stiffness", stiffness},
                        {"poisson_ratio", random.between(0, 0.45)},
                        {"mass_per_area", 0.1}});
  }
  const double prestress = stiffness * random.between(0.001, 0.01);
  b.group("cloth", {{"prestress", prestress}});
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) b.element("cloth", {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
  const double px = prestress * random.between(0.5, 2), py = prestress * random.between(0.5, 2);
  const auto pull = [&](const std::string& name, const Vec3& force, int count,
                        const std::function<std::string(int)>& node) {
    Json edges = Json::array();
    for (int k = 0; k < count; ++k) edges.push_back(Json::array({node(k), node(k + 1)}));
    b.deck["groups"][name] = {{"edges", edges}};
    b.load("pull_" + name, {{"on", Json::array({name})}, {"line_force", to_json(force)}});
  };
  pull("left", {-px, 0, 0}, m, [&](int k) { return at(0, k); });
  pull("right", {px, 0, 0}, m, [&](int k) { return at(n, k); });
  pull("lower", {0, -py, 0}, n, [&](int k) { return at(k, 0); });
  pull("upper", {0, py, 0}, n, [&](int k) { return at(k, m); });
  b.nodes("first", {at(0, 0)});
  b.nodes("second", {at(n, 0)});
  b.nodes("third", {at(0, m)});
  b.support("first", "pinned");
  b.support("second", {"y", "z"});
  b.support("third", Json::array({"z"}));
  b.step({{"kind", "equilibrium"}});
  if (random.chance(0.5)) return moved(b.deck, {random.rotation(), Vec3(cell * random.direction())});
  return b.deck;
}

Json as_triangles(const Json& deck, Random& random) {
  Json result = deck;
  Json facets = Json::array();
  for (const auto& f : deck["model"]["elements"]["cloth"]) {
    const int turn = random.whole(0, 1);
    const auto at = [&](int k) { return f[static_cast<std::size_t>((k + turn) % 4)]; };
    facets.push_back(Json::array({at(0), at(1), at(2)}));
    facets.push_back(Json::array({at(0), at(2), at(3)}));
  }
  result["model"]["elements"]["cloth"] = facets;
  return result;
}

std::optional<Trial> other_facets(const Json& deck, Random& random) {
  Json other = deck;
  if (!deck["model"]["elements"].contains("cloth") || deck["model"]["elements"]["cloth"][0].size() != 4)
    return std::nullopt;
  const Json mesh{{"kind", "mesh"}, {"subdivisions", random.whole(2, 3)}};
  if (random.chance(0.5))
    other["steps"].insert(other["steps"].begin(), mesh);
  else
    other = as_triangles(deck, random);
  Trial trial;
  trial.jobs = {{deck}, {other}};
  trial.judge = [](const Outcomes& o) {
    const auto known = [](const Outcome& outcome) {
      Outcome result = outcome.only("node ");
      for (const auto& [key, quantity] : outcome.numbers)
        if (key.find("group cloth principal") != std::string::npos)
          result.numbers[key.substr(key.find("group"))] = quantity;
      return result;
    };
    return compare(known(o[0]), known(o[1]), usual_tolerance);
  };
  return trial;
}

/// One group of elements told as two of one section and state.
std::optional<Trial> split_groups(const Json& deck, Random& random) {
  const auto groups = element_groups(deck);
  std::vector<std::string> can;
  for (const auto& group : groups)
    if (deck["model"]["elements"][group].size() > 1) can.push_back(group);
  if (can.empty()) return std::nullopt;
  const std::string group = random.one_of(can), second = group + "2";
  Json other = deck;
  Json here = Json::array(), there = Json::array();
  for (const auto& element : deck["model"]["elements"][group])
    (random.chance(0.5) ? here : there).push_back(element);
  if (here.empty() || there.empty()) return std::nullopt;
  other["model"]["elements"][group] = here;
  other["model"]["elements"][second] = there;
  other["groups"][second] = deck["groups"][group];
  for (auto& step : other["steps"]) {
    if (step.contains("net")) step["net"].push_back(second);
    if (step.contains("unknowns")) step["unknowns"][0]["on"].push_back(second);
  }
  for (const char* block : {"loads", "supports"})
    for (auto& item : other[block])
      if (item.contains("on")) {
        bool named = false;
        for (const auto& on : item["on"]) named = named || on == group;
        if (named) item["on"].push_back(second);
      }
  Trial trial;
  trial.jobs = {{deck}, {other}};
  trial.judge = [](const Outcomes& o) {
    auto a = o[0], b = o[1];
    for (auto* side : {&a, &b})
      std::erase_if(side->numbers, [](const auto& item) {
        return item.first.find(" group ") != std::string::npos ||
               (item.first.rfind("node ", 0) != 0 && item.first.rfind("step ", 0) != 0);
      });
    return compare(a, b, usual_tolerance);
  };
  return trial;
}

}  // namespace

std::vector<Relation> relations_of_elements() {
  const std::string exact = "1e-6 of the largest: only rounding differs";
  return {
      {"initial_state", "tension, prestrain, force_density and unstressed_length of cables say the same.",
       exact, drawn_net, initial_state},
      {"heat_and_prestrain", "A cable heated by dT is one of prestrain (1 + e)/(1 + alpha dT) - 1.", exact,
       drawn_net, heat_and_prestrain},
      {"bar_for_cable", "Cables in tension are bars.", exact,
       [](Random& r) { return r.chance(0.7) ? cable_net(r) : mast(r); }, bar_for_cable},
      {"light_catenary", "A cable is a catenary without weight.",
       "1e-6 of the largest; w L / T is below 1e-6", drawn_net, light_catenary},
      {"divided_beams", "Beams of one element or several, under small loads: the same motions of nodes.",
       "1e-4 of the largest: rotations of 1e-5 times the softness of the frame", slightly_loaded_frame,
       divided_beams},
      {"other_facets",
       "A flat membrane or shell in one state of stress, of quadrilaterals or triangles: one strain, one "
       "stress.",
       exact, stretched_patch, other_facets},
      {"split_groups", "One group of elements told as two: nothing changes.", exact, any_structure,
       split_groups},
  };
}

}  // namespace tautline::metamorphic
