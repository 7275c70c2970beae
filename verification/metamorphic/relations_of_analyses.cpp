/// @file
/// One analysis against another.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "relation.hpp"
#include "structures.hpp"
#include "transformations.hpp"

namespace tautline::metamorphic {

namespace {

/// A structure without mass but for one point, which all of its vibrations are of.
Json with_one_mass(Random& random) {
  Json deck;
  do deck = random.chance(0.5) ? cable_net(random) : random.chance(0.5) ? frame(random) : tent(random);
  while (!deck["groups"].contains("one") || deck["steps"][0]["kind"] == "form_finding" ||
         kind_of(deck, element_groups(deck)[0]) == "tapered_tube");
  for (auto& material : deck["materials"]) material["density"] = 0.0;
  for (auto& section : deck["sections"])
    for (const char* key : {"mass_per_length", "mass_per_area"})
      if (section.contains(key)) section[key] = 0.0;
  const std::string node = deck["groups"]["one"]["nodes"][0];
  deck["sections"]["point"] = {{"kind", "mass"}, {"mass", random.magnitude(0.1, 10)}};
  deck["groups"]["point"] = {{"section", "point"}};
  deck["model"]["elements"]["point"] = Json::array({Json::array({node})});
  Json steps = Json::array(), loads = Json::array();
  for (const auto& load : deck["loads"])
    if (!load.contains("moment") && load["name"] != "crush" && !load.contains("pressure"))
      loads.push_back(load);
  deck["loads"] = loads;
  for (const auto& step : deck["steps"])
    if (step["kind"] == "equilibrium") steps.push_back(step);
  steps.push_back({{"kind", "modal"}, {"modes", 1}});
  deck["steps"] = steps;
  deck["solver"] = {{"force_tolerance", 1e-12}, {"increment_tolerance", 1e-10}};
  tidy(deck);
  return deck;
}

/// omega^2 m is one over the largest eigenvalue of the flexibility that small forces at the mass show.
std::optional<Trial> frequency_and_probe(const Json& deck, Random&) {
  if (!deck["model"]["elements"].contains("point")) return std::nullopt;
  if (deck["steps"].size() < 2 || deck["steps"].back()["kind"] != "modal") return std::nullopt;
  const std::string node = deck["model"]["elements"]["point"][0][0];
  const double mass = deck["sections"]["point"]["mass"], size = size_of(deck);
  Trial trial;
  trial.jobs = {{deck}};
  const auto frequency = [](const Outcome& o) {
    for (const auto& [key, q] : o.numbers)
      if (key.find("frequencies 1") != std::string::npos) return q.value[0];
    return 0.0;
  };
  const auto force = [=](const Outcome& o) {
    return mass * std::pow(2 * std::numbers::pi * frequency(o), 2) * 1e-5 * size;
  };
  trial.then = [=](const Outcomes& o) {
    std::vector<Job> jobs;
    for (int k = 0; k < 6; ++k) {
      Json probe = deck;
      probe["groups"]["probed"] = {{"nodes", Json::array({node})}};
      probe["loads"].push_back(
          {{"name", "probe"},
           {"on", Json::array({"probed"})},
           {"force", to_json((k % 2 == 0 ? 1.0 : -1.0) * force(o[0]) * Vec3::Unit(k / 2))}});
      probe["steps"].erase(probe["steps"].size() - 1);
      probe["steps"].back()["loads"].push_back("probe");
      jobs.push_back({probe});
    }
    return jobs;
  };
  trial.judge = [=](const Outcomes& o) {
    Mat3 flexibility;
    const std::string key = "node " + node + " displacement";
    for (int k = 0; k < 3; ++k) {
      const Vec3 &there = o[static_cast<std::size_t>(1 + 2 * k)].at(key),
                 &back = o[static_cast<std::size_t>(2 + 2 * k)].at(key);
      // Near an instability the forces that show the softest direction lead to another equilibrium across it.
      if ((there + back - 2 * o[0].at(key)).norm() > 1e-3 * size) return std::vector<Difference>{};
      flexibility.col(k) = (there - back) / (2 * force(o[0]));
    }
    const Mat3 symmetric = (flexibility + flexibility.transpose()) / 2;
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(symmetric);
    const double softest = solver.eigenvalues().cwiseAbs().maxCoeff();
    const double expected = std::sqrt(1 / (mass * softest)) / (2 * std::numbers::pi);
    return std::vector<Difference>{difference("frequency from the flexibility at the mass, Hz", expected,
                                              frequency(o[0]), 1e-4 * expected)};
  };
  return trial;
}

double find(const Outcome& o, const std::string& part) {
  for (const auto& [key, q] : o.numbers)
    if (key.find(part) != std::string::npos) return q.value[0];
  return std::numeric_limits<double>::quiet_NaN();
}

/// Lattices strain more before they buckle and are left out. The strain before buckling, P / EA, is below
/// 3e-4 in these columns: (pi / 60)^2 / 12 of four times Euler's load.
std::optional<Trial> buckling_and_path(const Json& deck, Random&) {
  if (deck["steps"].empty() || deck["loads"].empty() || kind_of(deck, "column") == "bar") return std::nullopt;
  Json path = deck;
  auto& last = path["steps"].back();
  if (last["kind"] != "buckling") return std::nullopt;
  last = {{"kind", "collapse"}, {"loads", {"press"}}, {"monitor", {"middle"}}};
  Trial trial;
  trial.jobs = {{deck}, {path}};
  trial.judge = [](const Outcomes& o) {
    const double linear = find(o[0], "factors 1"), bifurcation = find(o[1], "bifurcation_lambda");
    return std::vector<Difference>{
        difference("first bifurcation on the path", linear, bifurcation, 3e-3 * linear)};
  };
  return trial;
}

/// With a small lateral force the rule of collapse stops short of the bifurcation, by what a bow grows 1.5
/// times in a step of 5 %: (1 - 0.85) = 1.5 (1 - 0.9); two steps and the growth of the first mode alone are
/// allowed for.
Difference within_the_rule(double critical, double rule) {
  return difference("the rule's factor", 0.875 * critical, rule, 0.125 * critical);
}

/// The step `collapse` under "press", watched in the middle, with a ten thousandth of the load to a side.
void disturb(Json& deck, Random& random) {
  deck["steps"].back() = {
      {"kind", "collapse"}, {"loads", {"press"}}, {"monitor", {"middle"}}, {"disturbance", {"lateral"}}};
  const Vec3 force = to_vec3(deck["loads"][0]["force"]);
  Vec3 side = force.cross(random.direction());
  side *= 1e-4 * force.norm() / side.norm();
  deck["loads"].push_back({{"name", "lateral"}, {"on", {"middle"}}, {"force", to_json(side)}});
}

bool is_pressed(const Json& deck, const std::string& last) {
  return !deck["steps"].empty() && deck["steps"].back()["kind"] == last && !deck["loads"].empty() &&
         deck["loads"][0]["name"] == "press" && deck["groups"].contains("middle");
}

std::optional<Trial> collapse_rule(const Json& deck, Random& random) {
  if (!is_pressed(deck, "buckling")) return std::nullopt;
  Json ruled = deck;
  disturb(ruled, random);
  Trial trial;
  trial.jobs = {{deck}, {ruled}};
  trial.judge = [](const Outcomes& o) {
    return std::vector<Difference>{within_the_rule(find(o[0], "factors 1"), find(o[1], "critical_lambda"))};
  };
  return trial;
}

/// Where deformation before buckling counts, the first critical point of the undisturbed path takes the place
/// of the linear factor.
std::optional<Trial> collapse_rule_of_arches(const Json& deck, Random& random) {
  if (!is_pressed(deck, "collapse")) return std::nullopt;
  Json ruled = deck;
  disturb(ruled, random);
  Trial trial;
  trial.jobs = {{deck}, {ruled}};
  trial.judge = [](const Outcomes& o) {
    double first = std::numeric_limits<double>::infinity();
    for (const char* key : {"bifurcation_lambda", "limit_lambda"})
      if (const double at = find(o[0], key); at < first) first = at;
    return std::vector<Difference>{within_the_rule(first, find(o[1], "critical_lambda"))};
  };
  return trial;
}

Json frame_with_buckling(Random& random) {
  Json deck;
  do deck = random.chance(0.5) ? frame(random) : pressed_column(random);
  while (deck["steps"].back()["kind"] != "buckling");
  return deck;
}

/// Loads reversed: factors change their sign; loads doubled: they are halved.
std::optional<Trial> buckling_reversed(const Json& deck, Random& random) {
  if (deck["steps"].empty() || deck["steps"].back()["kind"] != "buckling" ||
      deck["steps"].back()["loads"].empty())
    return std::nullopt;
  Json first = deck;
  first["steps"].back()["sign"] = "both";
  first["steps"].back()["modes"] = 2;
  Json second = first;
  const std::string name = first["steps"].back()["loads"][0];
  const double factor = -random.magnitude(0.5, 3);
  for (auto& load : second["loads"])
    if (load["name"] == name) load["force"] = to_json(factor * to_vec3(load["force"]));
  Trial trial;
  trial.jobs = {{first}, {second}};
  trial.judge = [factor](const Outcomes& o) {
    Outcome a = o[0], b = o[1];
    for (auto* side : {&a, &b})
      std::erase_if(side->numbers,
                    [](const auto& item) { return item.first.find("factors") == std::string::npos; });
    for (auto& [key, q] : a.numbers) q.value /= factor;
    return compare(a, b, usual_tolerance);
  };
  return trial;
}

/// Nets and tents whose shape is found.
Json found_structure(Random& random) {
  Json deck;
  do deck = random.chance(0.6) ? cable_net(random) : tent(random);
  while (deck["steps"][0]["kind"] != "form_finding");
  deck["steps"] =
      Json::array({deck["steps"][0], {{"kind", "equilibrium"}, {"name", "rest"}, {"loads", Json::array()}}});
  deck["loads"] = Json::array();
  tidy(deck);
  return deck;
}

/// What was found is in balance: the equilibrium after it moves nothing. 1e-6 of the size is what
/// form-finding goes to; where a film slides in its surface a hundredth of a facet is allowed, and 3 % of its
/// tension.
std::optional<Trial> found_shape_rests(const Json& deck, Random&) {
  if (deck["steps"].size() != 2 || deck["steps"][0]["kind"] != "form_finding") return std::nullopt;
  Json found = deck;
  found["steps"].erase(1);
  const Json held{{"name", "held"}, {"hold", element_groups(deck)}};
  found["steps"].push_back(
      Json{{"kind", "equilibrium"}, {"loads", Json::array()}, {"stages", Json::array({held})}});
  Trial trial;
  trial.jobs = {{found}, {deck}};
  const bool film = deck["steps"][0]["method"] == "film";
  double asked = 0, facets = 0;
  if (film) {
    if (!deck["model"]["elements"].contains("cloth") || !deck["groups"]["cloth"].contains("prestress"))
      return std::nullopt;
    asked = deck["groups"]["cloth"]["prestress"];
    facets = std::sqrt(static_cast<double>(deck["model"]["elements"]["cloth"].size()));
  }
  trial.judge = [=](const Outcomes& o) {
    auto list = compare(o[0].only("node "), o[1].only("node "), usual_tolerance);
    if (!film) {
      std::erase_if(list, [](const auto& d) { return d.what.find("displacement") == std::string::npos; });
      return list;
    }
    list.clear();
    // Where more than 3 % is told, up to the 30 % that end a step are allowed.
    const double uneven = o[1].warnings.count("film_unevenness") > 0 ? 0.3 : 0.03;
    for (const auto& [key, q] : o[1].numbers) {
      if (key.find("displacement") != std::string::npos && key.rfind("node ", 0) == 0)
        list.push_back(difference(key, 0, (q.value - o[0].at(key)).norm(), 0.01 * o[1].size / facets));
      if (key.rfind("membrane ", 0) == 0) list.push_back(difference(key, asked, q.value[0], uneven * asked));
    }
    std::sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a.measure > b.measure; });
    return list;
  };
  return trial;
}

/// A net for its tensions, by force densities and by dynamic relaxation.
std::optional<Trial> two_form_findings(const Json& deck, Random&) {
  if (deck["steps"].empty() || deck["steps"][0]["kind"] != "form_finding") return std::nullopt;
  for (const auto& group : element_groups(deck))
    if (!deck["groups"][group].contains("tension") || kind_of(deck, group) != "cable") return std::nullopt;
  Json tension = deck, relaxed = deck;
  tension["steps"][0]["method"] = "tension";
  relaxed["steps"][0] = {
      {"kind", "form_finding"}, {"method", "dynamic_relaxation"}, {"constant_tension", element_groups(deck)}};
  Trial trial;
  trial.jobs = {{tension}, {relaxed}};
  trial.judge = [](const Outcomes& o) { return compare(o[0].only("node "), o[1].only("node "), 1e-5); };
  return trial;
}

Json found_net(Random& random) {
  Json deck;
  do deck = cable_net(random);
  while (deck["steps"][0]["kind"] != "form_finding" || kind_of(deck, "warp") != "cable" ||
         kind_of(deck, "weft") != "cable");
  deck["steps"] =
      Json::array({deck["steps"][0], {{"kind", "equilibrium"}, {"name", "rest"}, {"loads", Json::array()}}});
  deck["loads"] = Json::array();
  tidy(deck);
  return deck;
}

Json rested_net(Random& random) {
  Json deck;
  do deck = cable_net(random);
  while (deck["steps"][0]["kind"] == "form_finding");
  Json step = deck["steps"][0];
  step["loads"] = Json::array();
  deck["steps"] = Json::array({step});
  deck["loads"] = Json::array();
  tidy(deck);
  return deck;
}

/// A net is changed in some cables; `inverse` is asked for the places that it then has, and finds them.
std::optional<Trial> inverse_round_trip(const Json& deck, Random& random) {
  Json changed = deck;
  for (const auto& group : element_groups(deck)) {
    auto& state = changed["groups"][group];
    for (const char* key : {"tension", "prestrain", "force_density"})
      if (state.contains(key)) state[key] = state[key].get<double>() * random.between(0.85, 1.2);
  }
  const double size = size_of(deck);
  const auto held = supported_nodes(deck);
  Trial trial;
  trial.jobs = {{changed}, {deck}};
  trial.any_end = true;  // a net that cannot stand says nothing of the search for another
  trial.then = [=](const Outcomes& o) {
    Json inverse = deck;
    Json targets = Json::array();
    for (const auto& item : deck["model"]["nodes"].items()) {
      if (std::find(held.begin(), held.end(), item.key()) != held.end()) continue;
      const Vec3 x = to_vec3(item.value()) + o[0].at("node " + item.key() + " displacement");
      inverse["groups"]["at_" + item.key()] = {{"nodes", Json::array({item.key()})}};
      targets.push_back({{"on", Json::array({"at_" + item.key()})}, {"x", x[0]}, {"y", x[1]}, {"z", x[2]}});
    }
    inverse["steps"].push_back(
        {{"kind", "inverse"},
         {"targets", targets},
         {"tolerance", 1e-8 * size},
         {"unknowns", Json::array({{{"on", element_groups(deck)}, {"each", "cable"}}})}});
    return std::vector<Job>{{inverse}};
  };
  trial.judge = [size](const Outcomes& o) {
    std::vector<Difference> list;
    if (o.size() < 3) return list;
    // the length of a slack cable has no influence to go by
    if (!all_taut(o[0]) || !all_taut(o[1])) return list;
    if (!o[2].done()) return std::vector<Difference>{{"inverse: " + o[2].message, 10}};
    if (!all_taut(o[2])) return list;
    for (const auto& [key, q] : o[0].numbers)
      if (key.rfind("node ", 0) == 0 && q.unit == "m")
        list.push_back(difference(key, 0, (q.value - o[2].at(key)).norm(), 1e-7 * size));
    std::sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a.measure > b.measure; });
    return list;
  };
  return trial;
}

}  // namespace

std::vector<Relation> relations_of_analyses() {
  return {
      {"frequency_and_probe",
       "The frequency of one mass on a structure without mass is that of the stiffness that small forces "
       "show.",
       "1e-4: forces that move the mass by 1e-5 of the size, differences of both signs", with_one_mass,
       frequency_and_probe},
      {"buckling_and_path",
       "The factor of linear buckling of a straight column is the first bifurcation on its path.",
       "0.3 %: ten times the strain before buckling", pressed_column, buckling_and_path},
      {"collapse_rule", "The rule of collapse lies within its steps below the factor of linear buckling.",
       "between 0.75 and 1 of it", pressed_column, collapse_rule},
      {"collapse_rule_of_arches",
       "The rule of collapse of an arch lies within its steps below the first critical point of its path.",
       "between 0.75 and 1 of it", pressed_arch, collapse_rule_of_arches},
      {"buckling_reversed", "Loads times c: factors over c, also where c is negative.",
       "2e-5: factors are printed to seven digits", frame_with_buckling, buckling_reversed},
      {"found_shape_rests", "The equilibrium after form-finding moves nothing.",
       "1e-6 of the size; films 1 % of a facet and 3 % of the tension, 30 % where it is told",
       found_structure, found_shape_rests},
      {"two_form_findings", "Force densities and dynamic relaxation find the same net.",
       "1e-5 of the largest: relaxation stops at 1e-9 of the forces", found_net, two_form_findings},
      {"inverse_round_trip", "Places of a net whose cables were changed are met by `inverse`.",
       "1e-7 of the size: ten times its tolerance", rested_net, inverse_round_trip},
  };
}

}  // namespace tautline::metamorphic
