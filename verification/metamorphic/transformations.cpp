#include "transformations.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <set>

#include <fmt/format.h>

namespace tautline::metamorphic {

namespace {

using Names = std::set<std::string>;

const Names points{"centre"};
const Names polar{"force",  "displacement", "line_force",   "surface_force", "acceleration", "orientation",
                  "x_axis", "y_axis",       "offset_start", "offset_end",    "direction"};
const Names axial{"moment", "rotation", "line_moment", "axis"};

bool is_vector(const Json& value) {
  return value.is_array() && value.size() == 3 && value[0].is_number();
}

/// Does something with every key of a tree.
template <class Change>
void visit(Json& tree, Change&& change) {
  if (tree.is_array())
    for (auto& item : tree) visit(item, change);
  if (!tree.is_object()) return;
  for (auto& item : tree.items()) {
    change(item.key(), item.value());
    visit(item.value(), change);
  }
}

/// A formula of new coordinates: each of the old ones written with the new.
std::string rewritten(const std::string& formula, const std::map<std::string, std::string>& old) {
  static const std::regex variable("\\b[xyz]\\b");
  std::string text;
  auto rest = formula.cbegin();
  for (std::sregex_iterator it(formula.begin(), formula.end(), variable), end; it != end; ++it) {
    text.append(rest, (*it)[0].first);
    text += "(" + old.at(it->str()) + ")";
    rest = (*it)[0].second;
  }
  return text.append(rest, formula.cend());
}

std::string moved_formula(const std::string& formula, const Motion& motion) {
  std::map<std::string, std::string> old;
  const Mat3 back = motion.turn.transpose();
  const Vec3 shift = back * motion.shift;
  const char* names[] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i)
    old[names[i]] = fmt::format("({:.17g})*x + ({:.17g})*y + ({:.17g})*z - ({:.17g})", back(i, 0), back(i, 1),
                                back(i, 2), shift[i]);
  return rewritten(formula, old);
}

/// As documented: without an x_axis the global axes, without a y_axis the one that is level.
void write_axes(Json& support) {
  if (!support.contains("fix") || support["fix"] == "all" || support["fix"] == "pinned") return;
  const Vec3 x = support.contains("x_axis") ? to_vec3(support["x_axis"]) : Vec3::UnitX();
  if (!support.contains("y_axis")) {
    const Vec3 level = Vec3::UnitZ().cross(x);
    if (!support.contains("x_axis"))
      support["y_axis"] = to_json(Vec3::UnitY());
    else if (level.norm() > 1e-9 * x.norm())
      support["y_axis"] = to_json(level);
  }
  support["x_axis"] = to_json(x);
}

/// Places that `inverse` is asked for; each is given by all three coordinates.
void move_targets(Json& step, const Motion& motion) {
  if (!step.contains("targets")) return;
  for (auto& target : step["targets"]) {
    const Vec3 x =
        motion.turn * Vec3(target["x"].get<double>(), target["y"].get<double>(), target["z"].get<double>()) +
        motion.shift;
    target["x"] = x[0];
    target["y"] = x[1];
    target["z"] = x[2];
  }
}

/// Facets of a mirrored structure go round the other way, so that their normals are mirrored, too.
void reverse_facets(Json& deck) {
  for (auto& [group, elements] : deck["model"]["elements"].items()) {
    const auto kind = kind_of(deck, group);
    if (kind != "membrane" && kind != "shell") continue;
    for (auto& element : elements) element = reversed_nodes(element);
  }
}

/// Units of keys; the same word means the same everywhere but where `in_units` says otherwise.
const std::map<std::string, std::string> units_of_keys{{"young_modulus", "N/m^2"},
                                                       {"density", "kg/m^3"},
                                                       {"diameter", "m"},
                                                       {"area", "m^2"},
                                                       {"axial_stiffness", "N"},
                                                       {"mass_per_length", "kg/m"},
                                                       {"width", "m"},
                                                       {"height", "m"},
                                                       {"thickness", "m"},
                                                       {"side", "m"},
                                                       {"diameter_start", "m"},
                                                       {"diameter_end", "m"},
                                                       {"thickness_start", "m"},
                                                       {"thickness_end", "m"},
                                                       {"web_thickness", "m"},
                                                       {"flange_thickness", "m"},
                                                       {"inertia_2", "m^4"},
                                                       {"inertia_3", "m^4"},
                                                       {"torsion", "m^4"},
                                                       {"bending_stiffness_2", "N m^2"},
                                                       {"bending_stiffness_3", "N m^2"},
                                                       {"torsion_stiffness", "N m^2"},
                                                       {"shear_stiffness_2", "N"},
                                                       {"shear_stiffness_3", "N"},
                                                       {"rotary_inertia_2", "kg m"},
                                                       {"rotary_inertia_3", "kg m"},
                                                       {"tension_stiffness", "N/m"},
                                                       {"tension_stiffness_2", "N/m"},
                                                       {"mass_per_area", "kg/m^2"},
                                                       {"shear_stiffness", "N/m"},
                                                       {"stiffness", "N/m"},
                                                       {"rotational_stiffness", "N m"},
                                                       {"mass", "kg"},
                                                       {"inertia", "kg m^2"},
                                                       {"tension", "N"},
                                                       {"unstressed_length", "m"},
                                                       {"force_density", "N/m"},
                                                       {"prestress", "N/m"},
                                                       {"initial_stress", "N/m^2"},
                                                       {"offset_start", "m"},
                                                       {"offset_end", "m"},
                                                       {"force", "N"},
                                                       {"moment", "N m"},
                                                       {"displacement", "m"},
                                                       {"line_force", "N/m"},
                                                       {"line_moment", "N"},
                                                       {"surface_force", "N/m^2"},
                                                       {"pressure", "N/m^2"},
                                                       {"acceleration", "m/s^2"},
                                                       {"centre", "m"},
                                                       {"amplitude", "m"},
                                                       {"initial_force_density", "N/m"},
                                                       {"aperture", "m"},
                                                       {"focal_length", "m"},
                                                       {"clearance", "m"},
                                                       {"gap", "m"},
                                                       {"rim_height", "m"},
                                                       {"evaluation_radius", "m"},
                                                       {"hub_radius", "m"},
                                                       {"joint_radius", "m"},
                                                       {"apex_radius", "m"},
                                                       {"fork_length", "m"},
                                                       {"tip_radius", "m"},
                                                       {"surface_height", "m"},
                                                       {"tension_min", "N"},
                                                       {"tension_max", "N"},
                                                       {"max_change", "m"},
                                                       {"x", "m"},
                                                       {"y", "m"},
                                                       {"z", "m"},
                                                       {"radius", "m"},
                                                       {"min", "m"},
                                                       {"max", "m"}};

void scale(Json& value, double factor) {
  if (value.is_number()) {
    value = value.get<double>() * factor;
  } else if (value.is_array()) {
    for (auto& item : value) scale(item, factor);
  }
}

template <class T>
void shuffle(T& list, Random& random) {
  const auto order = random.order(static_cast<int>(list.size()));
  T before = list;
  for (std::size_t i = 0; i < order.size(); ++i) list[i] = before[static_cast<std::size_t>(order[i])];
}

Json shuffled_object(const Json& object, Random& random) {
  std::vector<std::string> keys;
  for (const auto& item : object.items()) keys.push_back(item.key());
  shuffle(keys, random);
  Json result = Json::object();
  for (const auto& key : keys) result[key] = object[key];
  return result;
}

void swap_keys(Json& object, const std::string& a, const std::string& b) {
  const Json first = object.contains(a) ? object[a] : Json(),
             second = object.contains(b) ? object[b] : Json();
  object.erase(a);
  object.erase(b);
  if (!second.is_null()) object[a] = second;
  if (!first.is_null()) object[b] = first;
}

/// A beam group the other way round: what is said of its ends changes places.
void reverse_ends(Json& deck, const std::string& group) {
  auto& entry = deck["groups"][group];
  swap_keys(entry, "release_start", "release_end");
  swap_keys(entry, "offset_start", "offset_end");
  Json section = section_of(deck, group);
  if (section["kind"] != "tapered_tube") return;
  swap_keys(section, "diameter_start", "diameter_end");
  swap_keys(section, "thickness_start", "thickness_end");
  const std::string name = group + "_reversed";
  deck["sections"][name] = section;
  entry["section"] = name;
}

/// Groups of facets on which a pressure acts.
Names pressed(const Json& deck) {
  Names names;
  for (const auto& load : deck["loads"])
    if (load.contains("pressure"))
      for (const auto& on : load["on"]) names.insert(on);
  return names;
}

}  // namespace

Json moved(const Json& deck, const Motion& motion) {
  Json result = deck;
  for (auto& support : result["supports"]) write_axes(support);
  const bool mirrors = motion.turn.determinant() < 0;
  const auto change = [&](const std::string& key, Json& value) {
    if (key == "temperature_field") value = moved_formula(value, motion);
    if (!is_vector(value)) return;
    const Vec3 v = to_vec3(value);
    if (points.count(key) != 0) value = to_json(motion.turn * v + motion.shift);
    if (polar.count(key) != 0) value = to_json(motion.turn * v);
    if (axial.count(key) != 0) value = to_json((mirrors ? -1.0 : 1.0) * (motion.turn * v));
  };
  for (const char* block : {"groups", "supports", "loads", "steps"}) visit(result[block], change);
  visit(result["sections"], [&](const std::string& key, Json& value) {
    if (key == "axis") change(key, value);
  });
  if (result["model"].contains("cyclic")) visit(result["model"]["cyclic"], change);
  for (auto& item : result["model"]["nodes"].items())
    item.value() = to_json(motion.turn * to_vec3(item.value()) + motion.shift);
  for (auto& step : result["steps"]) move_targets(step, motion);
  if (mirrors) reverse_facets(result);
  return result;
}

Outcome moved(const Outcome& outcome, const Motion& motion) {
  Outcome result = outcome;
  const double sign = motion.turn.determinant() < 0 ? -1 : 1;
  for (auto& [key, quantity] : result.numbers) {
    if (quantity.nature == Nature::polar) quantity.value = motion.turn * quantity.value;
    if (quantity.nature == Nature::axial) quantity.value = sign * (motion.turn * quantity.value);
  }
  return result;
}

double Units::time() const {
  return std::sqrt(mass * length / force);
}

double Units::factor(const std::string& unit) const {
  static const std::regex part("(/?)\\b(kg|m|N|s|Hz)\\b(?:\\^([0-9]))?");
  double product = 1;
  for (std::sregex_iterator it(unit.begin(), unit.end(), part), end; it != end; ++it) {
    const std::string base = (*it)[2].str();
    const double one = base == "m"    ? length
                       : base == "N"  ? force
                       : base == "kg" ? mass
                       : base == "s"  ? time()
                                      : 1 / time();
    const int power = (*it)[3].matched ? std::stoi((*it)[3].str()) : 1;
    product *= std::pow(one, (*it)[1].length() > 0 ? -power : power);
  }
  return product;
}

Json in_units(const Json& deck, const Units& units) {
  Json result = deck;
  const auto change = [&](const std::string& key, Json& value) {
    if (key == "temperature_field") {
      std::map<std::string, std::string> old;
      for (const char* name : {"x", "y", "z"}) old[name] = fmt::format("{}/({:.17g})", name, units.length);
      value = rewritten(value, old);
    }
    const auto unit = units_of_keys.find(key);
    if (unit != units_of_keys.end() && !value.is_object()) scale(value, units.factor(unit->second));
  };
  for (const char* block : {"materials", "sections", "groups", "supports", "loads", "steps", "reflector"})
    if (result.contains(block)) visit(result[block], change);
  for (auto& step : result["steps"])
    if (step["kind"] == "inverse" && step.contains("tolerance")) scale(step["tolerance"], units.length);
  if (!result.contains("model")) return result;
  for (auto& item : result["model"]["nodes"].items()) scale(item.value(), units.length);
  if (result["model"].contains("cyclic")) visit(result["model"]["cyclic"], change);
  return result;
}

Outcome in_units(const Outcome& outcome, const Units& units) {
  Outcome result = outcome;
  result.size *= units.length;
  result.stiffness *= units.force;
  for (auto& [key, quantity] : result.numbers) quantity.value *= units.factor(quantity.unit);
  return result;
}

Json shuffled(const Json& deck, Random& random) {
  Json result = deck;
  auto& model = result["model"];
  model["nodes"] = shuffled_object(model["nodes"], random);
  model["elements"] = shuffled_object(model["elements"], random);
  for (auto& item : model["elements"].items()) shuffle(item.value(), random);
  for (const char* block : {"materials", "sections", "groups"})
    result[block] = shuffled_object(result[block], random);
  for (const char* block : {"supports", "loads"}) shuffle(result[block], random);
  for (auto& item : result["groups"].items())
    if (item.value().contains("nodes")) shuffle(item.value()["nodes"], random);
  return result;
}

Json reversed_nodes(const Json& element) {
  Json result = Json::array();
  for (auto it = element.rbegin(); it != element.rend(); ++it) result.push_back(*it);
  return result;
}

Json reversed(const Json& deck, Random& random) {
  Json result = deck;
  const Names stay = pressed(deck);
  for (auto& [group, elements] : result["model"]["elements"].items()) {
    const auto kind = kind_of(result, group);
    const bool facet = kind == "membrane" || kind == "shell",
               cord = kind == "cable" || kind == "bar" || kind == "catenary";
    const bool beam =
        !facet && !cord && kind != "spring" && kind != "mass" && kind != "rigid_link" && kind != "hinge";
    const auto& entry = result["groups"][group];
    const bool ends =
        beam && (entry.contains("release_start") || entry.contains("release_end") ||
                 entry.contains("offset_start") || entry.contains("offset_end") || kind == "tapered_tube");
    if (ends) {  // what is said of an end is said of the whole group
      for (auto& element : elements) element = reversed_nodes(element);
      reverse_ends(result, group);
      continue;
    }
    for (auto& element : elements) {
      if (facet) {
        std::vector<Json> nodes(element.begin(), element.end());
        std::rotate(nodes.begin(), nodes.begin() + random.whole(0, static_cast<int>(nodes.size()) - 1),
                    nodes.end());
        element = Json(nodes);
      }
      const bool turnable = cord || beam || (facet && stay.count(group) == 0);
      if (turnable && random.chance(0.5)) element = reversed_nodes(element);
    }
  }
  return result;
}

}  // namespace tautline::metamorphic
