/// @file
/// Columns and arches to buckle, in any direction in space.

#include <cmath>
#include <numbers>

#include "structures.hpp"
#include "transformations.hpp"

namespace tautline::metamorphic {

namespace {

Vec3 sideways(const Vec3& way, Random& random) {
  Vec3 normal;
  do normal = random.direction();
  while (std::abs(normal.dot(way)) > 0.8);
  return normal;
}

void metal(Builder& b, Random& random) {
  b.deck["materials"]["metal"] = {{"young_modulus", random.magnitude(1e9, 2e11)},
                                  {"poisson_ratio", 0.3},
                                  {"density", 2000.0},
                                  {"thermal_expansion", 1e-5}};
}

double modulus(const Builder& b) {
  return b.deck["materials"]["metal"]["young_modulus"];
}

/// What acts before: a dead load along `way`, heat that nothing hinders, a motion of the whole.
void act_before(Builder& b, Random& random, double critical, const Vec3& way, const std::string& heated) {
  std::vector<std::string> acting;
  if (random.chance(0.4)) {
    b.load("dead",
           {{"on", {"head"}}, {"force", to_json(0.3 * critical * (random.chance(0.5) ? 1 : -1) * way)}});
    acting.push_back("dead");
  }
  if (random.chance(0.4)) {
    b.load("heat", {{"on", {heated}}, {"temperature_change", random.between(-50, 50)}});
    acting.push_back("heat");
  }
  if (!acting.empty()) b.step({{"kind", "equilibrium"}, {"loads", acting}});
}

/// Beams of unequal length from foot to head, with one of three kinds of ends. @return about its critical
/// load
double straight_beams(Builder& b, Random& random, double length, const Vec3& way) {
  const double h = length / random.between(60, 150), w = h * random.between(1.1, 2);
  b.section("column", {{"kind", "rectangle"}, {"material", "metal"}, {"width", w}, {"height", h}});
  const Vec3 normal = sideways(way, random);
  b.group("column", {{"orientation", to_json(normal)}});
  const int n = random.whole(4, 7);
  std::vector<double> at{0};
  for (int k = 0; k < n; ++k) at.push_back(at.back() + random.between(0.7, 1.3));
  std::vector<std::string> names;
  for (const double s : at) names.push_back(b.node(s / at.back() * length * way));
  for (int k = 0; k < n; ++k)
    b.element("column", {names[static_cast<std::size_t>(k)], names[static_cast<std::size_t>(k) + 1]});
  b.nodes("foot", {names.front()});
  b.nodes("head", {names.back()});
  b.nodes("middle", {names[static_cast<std::size_t>(n) / 2]});
  const double euler = 9.87 * modulus(b) * w * std::pow(h, 3) / 12 / (length * length);
  const Json along{{"x_axis", to_json(way)}, {"y_axis", to_json(normal)}};
  switch (random.whole(0, 2)) {
    case 0:  // free at the head
      b.support("foot", "all");
      return euler / 4;
    case 1:  // hinged at both ends, which do not twist
      b.support("foot", {"x", "y", "z", "rx"}, along);
      b.support("head", {"y", "z"}, along);
      return euler;
    default:
      b.support("foot", "all");
      b.support("head", {"y", "z"}, along);
      return 2 * euler;
  }
}

/// A mast of bars on a triangle, which bends as a whole: three chords, battens and diagonals.
/// @return about its critical load
double lattice(Builder& b, Random& random, double length, const Vec3& way) {
  const int bays = random.whole(8, 12);
  const double side = length / bays * random.between(0.5, 0.9), stiffness = random.magnitude(1e5, 1e8);
  b.section("column", {{"kind", "bar"},
                       {"axial_stiffness", stiffness},
                       {"mass_per_length", 1.0},
                       {"thermal_expansion", 1e-5}});
  b.group("column");
  const Vec3 u = sideways(way, random).cross(way).normalized(), v = way.cross(u);
  std::vector<std::string> names;
  for (int k = 0; k <= bays; ++k)
    for (int c = 0; c < 3; ++c) {
      const double angle = 2 * std::numbers::pi * c / 3;
      names.push_back(b.node(length * k / bays * way +
                             side / std::numbers::sqrt3 * (std::cos(angle) * u + std::sin(angle) * v)));
    }
  const auto at = [&](int k, int c) { return names[static_cast<std::size_t>(3 * k + c % 3)]; };
  for (int k = 0; k <= bays; ++k)
    for (int c = 0; c < 3; ++c) {
      if (k > 0) b.element("column", {at(k, c), at(k, c + 1)});
      if (k == bays) continue;
      b.element("column", {at(k, c), at(k + 1, c)});
      b.element("column", {at(k, c), at(k + 1, c + 1)});
    }
  b.nodes("foot", {at(0, 0), at(0, 1), at(0, 2)});
  b.nodes("head", {at(bays, 0), at(bays, 1), at(bays, 2)});
  b.nodes("middle", {at(bays, 0)});
  b.support("foot", "pinned");
  // a cantilever of E I = EA side^2 / 2, and three nodes that are loaded
  return 9.87 / 4 * stiffness * side * side / 2 / (length * length) / 3;
}

}  // namespace

Json pressed_column(Random& random) {
  Builder b;
  metal(b, random);
  const double length = random.magnitude(0.5, 20);
  const Vec3 way = random.direction();
  const bool truss = random.chance(0.25);
  const double critical = truss ? lattice(b, random, length, way) : straight_beams(b, random, length, way);
  b.load("press", {{"on", {"head"}}, {"force", to_json(-critical * random.between(0.5, 2) * way)}});
  act_before(b, random, critical, way, "column");
  if (random.chance(0.3) && b.deck["supports"].size() == 1 && !truss) {  // the foot is moved with all on it
    b.load("moved", {{"on", {"foot"}}, {"displacement", to_json(0.3 * length * random.direction())}});
    b.step({{"kind", "equilibrium"}, {"loads", {"moved"}}});
  }
  b.step({{"kind", "buckling"}, {"loads", {"press"}}, {"modes", 1}, {"sign", "positive"}});
  tidy(b.deck);
  return b.deck;
}

Json pressed_arch(Random& random) {
  Builder b;
  metal(b, random);
  const double span = random.magnitude(1, 20), rise = span * random.between(0.08, 0.4);
  const double h = rise / random.between(6, 15), w = h * random.between(1.5, 4);
  b.section("arch", {{"kind", "rectangle"}, {"material", "metal"}, {"width", w}, {"height", h}});
  b.group("arch", {{"orientation", {0.0, 1.0, 0.0}}});
  const int n = 2 * random.whole(4, 6);
  std::vector<std::string> names;
  for (int k = 0; k <= n; ++k) {
    const double s = 2.0 * k / n - 1;
    names.push_back(b.node({span / 2 * s, 0, rise * (1 - s * s)}));
  }
  for (int k = 0; k < n; ++k)
    b.element("arch", {names[static_cast<std::size_t>(k)], names[static_cast<std::size_t>(k) + 1]});
  b.nodes("feet", {names.front(), names.back()});
  b.nodes("head", {names.begin() + 1, names.end() - 1});
  b.nodes("middle", {names[static_cast<std::size_t>(n) / 4]});
  b.support("feet", random.chance(0.5) ? Json("all") : Json({"x", "y", "z", "rx", "rz"}));
  const double inertia = w * std::pow(h, 3) / 12, radius = span * span / (8 * rise);
  // a thrust of four times Euler's of half the arch, which balances n - 1 equal forces
  const double critical = 20 * modulus(b) * inertia / (span * span / 4) / radius * span / n / 4;
  b.load("press", {{"on", {"head"}}, {"force", {0.0, 0.0, -critical}}});
  act_before(b, random, 0.3 * critical, Vec3::UnitZ(), "arch");
  b.step({{"kind", "collapse"}, {"loads", {"press"}}, {"monitor", {"middle"}}});
  return moved(b.deck, {random.rotation(), Vec3(span * random.direction())});
}

}  // namespace tautline::metamorphic
