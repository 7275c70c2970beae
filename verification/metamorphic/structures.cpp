#include "structures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "transformations.hpp"

namespace tautline::metamorphic {

namespace {

using NodeNames = std::vector<std::string>;

/// Half of all structures lie askew in space.
Json placed(const Json& deck, Random& random) {
  if (random.chance(0.5)) return deck;
  const double size = size_of(deck);
  return moved(deck, {random.rotation(), Vec3(size * random.direction())});
}

/// Some of the loads, at least one.
NodeNames some(const NodeNames& all, Random& random) {
  NodeNames list;
  for (const auto& name : all)
    if (random.chance(0.5)) list.push_back(name);
  if (list.empty() && !all.empty()) list.push_back(random.one_of(all));
  return list;
}

Json equilibrium(const std::string& name, const NodeNames& loads) {
  return {{"kind", "equilibrium"}, {"name", name}, {"loads", loads}};
}

/// A rectangular net of places with a random outline: nodes by row and column, of which the rim is marked.
class Grid {
 public:
  Grid(Builder& builder, Random& random, int n, int m, double cell,
       const std::function<double(double, double)>& height)
      : n_(n), m_(m) {
    const double shake = 0.15 * cell, width = random.between(0.8, 1.3) * cell;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= m; ++j) {
        const double x = i * cell + random.between(-shake, shake),
                     y = j * width + random.between(-shake, shake);
        names_.push_back(builder.node({x, y, height(x / (n * cell) - 0.5, y / (m * width) - 0.5)}));
      }
  }
  const std::string& at(int i, int j) const { return names_[static_cast<std::size_t>(i * (m_ + 1) + j)]; }
  bool on_rim(int i, int j) const { return i == 0 || j == 0 || i == n_ || j == m_; }
  NodeNames rim() const { return nodes(true); }
  NodeNames inner() const { return nodes(false); }
  NodeNames corners() const { return {at(0, 0), at(n_, 0), at(n_, m_), at(0, m_)}; }
  int rows() const { return n_; }
  int columns() const { return m_; }

  /// A facet for each cell, or two.
  void facets(Builder& builder, const std::string& group, Random& random, double triangles) const {
    for (int i = 0; i < n_; ++i)
      for (int j = 0; j < m_; ++j) {
        const auto &a = at(i, j), &b = at(i + 1, j), &c = at(i + 1, j + 1), &d = at(i, j + 1);
        if (!random.chance(triangles)) {
          builder.element(group, {a, b, c, d});
        } else if (random.chance(0.5)) {
          builder.element(group, {a, b, c});
          builder.element(group, {a, c, d});
        } else {
          builder.element(group, {a, b, d});
          builder.element(group, {b, c, d});
        }
      }
  }

 private:
  NodeNames nodes(bool rim) const {
    NodeNames list;
    for (int i = 0; i <= n_; ++i)
      for (int j = 0; j <= m_; ++j)
        if (on_rim(i, j) == rim) list.push_back(at(i, j));
    return list;
  }

  int n_, m_;
  NodeNames names_;
};

std::function<double(double, double)> saddle(Random& random, double rise) {
  const double a = random.between(-1, 1) * rise, b = random.between(-1, 1) * rise,
               c = random.between(-1, 1) * rise;
  return [=](double x, double y) { return a * x * y * 4 + b * x * x - c * y * y; };
}

/// Initial state of cables of one tension, said in one of the ways there are.
Json state(Random& random, double tension, double stiffness, double length) {
  switch (random.whole(0, 3)) {
    case 0:
      return {{"tension", tension}};
    case 1:
      return {{"prestrain", tension / stiffness}};
    case 2:
      return {{"force_density", tension / length}};
    default:
      return {{"tension", tension * random.between(0.8, 1.2)}};
  }
}

/// A beam section of about the height given, of a random kind.
Json beam_section(Random& random, double h) {
  switch (random.whole(0, 6)) {
    case 0:
      return {
          {"kind", "rectangle"}, {"material", "metal"}, {"width", h * random.between(0.4, 1)}, {"height", h}};
    case 1:
      return {{"kind", "round"}, {"material", "metal"}, {"diameter", h}};
    case 2:
      return {{"kind", "tube"},
              {"material", "metal"},
              {"diameter", h},
              {"thickness", h * random.between(0.03, 0.2)}};
    case 3:
      return {{"kind", "square_tube"},
              {"material", "metal"},
              {"side", h},
              {"thickness", h * random.between(0.03, 0.1)}};
    case 4:
      return {{"kind", "i"},
              {"material", "metal"},
              {"height", h},
              {"width", h * random.between(0.5, 1)},
              {"web_thickness", h / 20},
              {"flange_thickness", h / 12}};
    case 5:
      return {{"kind", "tapered_tube"},    {"material", "metal"},
              {"diameter_start", h},       {"diameter_end", h * random.between(0.6, 1)},
              {"thickness_start", h / 10}, {"thickness_end", h / 12}};
    default: {
      const double e = 2e11, area = h * h / 3, inertia = area * h * h / 10;
      return {{"kind", "beam"},
              {"axial_stiffness", e * area},
              {"bending_stiffness_2", e * inertia},
              {"bending_stiffness_3", e * inertia * random.between(0.3, 1)},
              {"torsion_stiffness", e * inertia * 0.5},
              {"mass_per_length", 7850 * area},
              {"thermal_expansion", 1.2e-5}};
    }
  }
}

void add_metal(Builder& builder) {
  builder.deck["materials"]["metal"] = {
      {"young_modulus", 2e11}, {"poisson_ratio", 0.3}, {"density", 7850.0}, {"thermal_expansion", 1.2e-5}};
}

Vec3 across(const Vec3& axis, Random& random) {
  Vec3 v;
  do v = random.direction();
  while (std::abs(v.dot(axis.normalized())) > 0.8);
  return v;
}

}  // namespace

Json cable_net(Random& random) {
  Builder b;
  const double cell = random.magnitude(0.5, 10), stiffness = random.magnitude(2e4, 2e6);
  const double tension = stiffness * random.magnitude(1e-3, 5e-3);
  const int n = random.whole(2, 4), m = random.whole(2, 4);
  const bool found = random.chance(0.4);  // form-finding wants tensions
  const Grid grid(b, random, n, m, cell, saddle(random, 0.15 * cell * n));
  for (const char* name : {"warp", "weft"}) {
    b.section(name, {{"kind", random.chance(0.8) ? "cable" : "bar"},
                     {"axial_stiffness", stiffness * random.between(0.7, 1.3)},
                     {"mass_per_length", tension / cell * random.magnitude(1e-4, 3e-3)},
                     {"thermal_expansion", 1.2e-5}});
    const bool bar = b.deck["sections"][name]["kind"] == "bar";
    b.group(name, bar || found ? Json{{"tension", tension}} : state(random, tension, stiffness, cell));
  }
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= m; ++j) {
      if (i < n && j > 0 && j < m) b.element("warp", {grid.at(i, j), grid.at(i + 1, j)});
      if (j < m && i > 0 && i < n) b.element("weft", {grid.at(i, j), grid.at(i, j + 1)});
    }
  b.nodes("rim", grid.rim());
  const auto inner = grid.inner();
  b.nodes("one", {random.one_of(inner)});
  b.nodes("moving", {grid.at(0, random.whole(1, m - 1))});
  b.support("rim", "pinned");
  b.load("weight", {{"acceleration", to_json(Vec3(0, 0, -9.81))}});
  b.load("push", {{"on", {"one"}}, {"force", to_json(0.2 * tension * random.direction())}});
  b.load("snow", {{"on", {random.chance(0.5) ? "warp" : "weft"}},
                  {"line_force", to_json(0.1 * tension / cell * random.direction())}});
  b.load("heat", {{"on", {"warp"}}, {"temperature_change", random.between(-40, 40)}});
  b.load("gradient",
         {{"on", {"weft"}},
          {"temperature_field", fmt::format("{:.6g} + {:.6g}*x - {:.6g}*y", random.between(-20, 20),
                                            random.between(0, 10) / cell, random.between(0, 10) / cell)}});
  b.load("motion", {{"on", {"moving"}}, {"displacement", to_json(0.02 * cell * random.direction())}});
  if (found)
    b.step({{"kind", "form_finding"},
            {"method", random.chance(0.5) ? "tension" : "linear"},
            {"net", {"warp", "weft"}},
            {"initial_force_density", tension / cell}});
  b.step(equilibrium("prestress", {}));
  b.step(equilibrium("loaded", some(load_names(b.deck), random)));
  b.step({{"kind", "modal"}, {"modes", std::min(3, 3 * (n - 1) * (m - 1))}});
  if (!found && random.chance(0.3)) {
    const Vec3 wanted =
        place_of(b.deck, b.deck["groups"]["one"]["nodes"][0]) + 0.02 * cell * random.direction();
    b.step(
        {{"kind", "inverse"},
         {"tolerance", 1e-9 * cell},
         {"targets", Json::array({{{"on", {"one"}}, {"x", wanted[0]}, {"y", wanted[1]}, {"z", wanted[2]}}})},
         {"unknowns", Json::array({{{"on", {"warp", "weft"}}, {"each", "cable"}}})}});
  }
  tidy(b.deck);
  return placed(b.deck, random);
}

Json tent(Random& random) {
  Builder b;
  const double cell = random.magnitude(0.5, 5), prestress = random.magnitude(300, 5000);
  const double stiffness = prestress * random.magnitude(100, 1000);
  const int n = random.whole(2, 3), m = random.whole(2, 4);
  const double width = cell * m;
  const Grid grid(b, random, n, m, cell, saddle(random, 0.2 * cell * n));
  const bool orthotropic = random.chance(0.3);
  Json section{{"kind", "membrane"},
               {"tension_stiffness", stiffness},
               {"poisson_ratio", random.between(0, 0.4)},
               {"mass_per_area", prestress / width * 1e-3},
               {"thermal_expansion", 1e-5}};
  if (orthotropic) {
    section["tension_stiffness_2"] = stiffness * random.between(0.4, 0.9);
    section["shear_stiffness"] = stiffness * random.between(0.05, 0.3);
  }
  b.section("cloth", section);
  Json state{{"prestress", prestress}};
  if (orthotropic || random.chance(0.3)) {
    state["orientation"] = to_json(Vec3(1, random.between(-1, 1), 0.1));
    state["prestress"] = {prestress, prestress * random.between(0.6, 1.4)};
  }
  b.group("cloth", state);
  const bool film = !orthotropic && state["prestress"].is_number() && random.chance(0.25);  // of triangles
  grid.facets(b, "cloth", random, film ? 1 : random.one_of(std::vector<double>{0, 0.5, 1}));
  b.nodes("corners", grid.corners());
  if (random.chance(0.4)) {
    b.section("rope",
              {{"kind", "cable"}, {"axial_stiffness", 100 * prestress * width}, {"mass_per_length", 0.1}});
    b.group("rope", {{"tension", prestress * width * random.between(1.5, 2.5)}});
    for (int i = 0; i < n; ++i)
      for (const int j : {0, m}) b.element("rope", {grid.at(i, j), grid.at(i + 1, j)});
    for (int j = 0; j < m; ++j)
      for (const int i : {0, n}) b.element("rope", {grid.at(i, j), grid.at(i, j + 1)});
    b.support("corners", "pinned");
  } else {
    b.nodes("rim", grid.rim());
    b.support("rim", "pinned");
  }
  b.nodes("one", {random.one_of(grid.inner())});
  const double pressure = prestress / width * random.magnitude(0.03, 0.3);
  b.load("weight", {{"acceleration", to_json(Vec3(0, 0, -9.81))}});
  b.load("wind", {{"on", {"cloth"}}, {"pressure", random.chance(0.5) ? pressure : -pressure}});
  b.load("snow", {{"on", {"cloth"}}, {"surface_force", to_json(pressure * random.direction())}});
  b.load("push", {{"on", {"one"}}, {"force", to_json(pressure * cell * cell * random.direction())}});
  b.load("heat", {{"on", {"cloth"}}, {"temperature_change", random.between(-30, 20)}});
  b.load("gradient", {{"on", {"cloth"}},
                      {"temperature_field", fmt::format("{:.6g}*x - {:.6g}*y*x", random.between(0, 10) / cell,
                                                        random.between(0, 10) / (cell * cell))}});
  if (film) b.step({{"kind", "form_finding"}, {"method", "film"}});
  b.step(equilibrium("prestress", {}));
  b.step(equilibrium("loaded", some(load_names(b.deck), random)));
  b.step({{"kind", "modal"}, {"modes", 3}});
  return placed(b.deck, random);
}

namespace {

/// Columns under a ring of beams, braced here and there.
void build_storey(Builder& b, Random& random, double length, int n, NodeNames& base, NodeNames& top) {
  const double radius = length * random.between(0.5, 1);
  for (int k = 0; k < n; ++k) {
    const double angle = 2 * std::numbers::pi * (k + random.between(-0.15, 0.15)) / n;
    const Vec3 out(std::cos(angle), std::sin(angle), 0);
    base.push_back(b.node(radius * out));
    top.push_back(
        b.node(radius * random.between(0.7, 1) * out + Vec3(0, 0, length * random.between(0.8, 1.1))));
    b.element("columns", {base.back(), top.back()});
  }
  for (int k = 0; k < n; ++k) {
    const auto next = static_cast<std::size_t>((k + 1) % n), here = static_cast<std::size_t>(k);
    b.element("beams", {top[here], top[next]});
    if (random.chance(0.4)) b.element("braces", {base[here], top[next]});
  }
}

/// A stem of a few members with a side arm.
void build_tree(Builder& b, Random& random, double length, NodeNames& base, NodeNames& top) {
  Vec3 at = Vec3::Zero(), way = Vec3::UnitZ();
  base.push_back(b.node(at));
  std::string last = base.back();
  const int n = random.whole(2, 4);
  for (int k = 0; k < n; ++k) {
    way = (way + 0.6 * random.direction()).normalized();
    at += length / n * way;
    const auto next = b.node(at);
    b.element(k % 2 == 0 ? "columns" : "beams", {last, next});
    if (k == n / 2) {
      top.push_back(b.node(at + 0.4 * length * across(way, random)));
      b.element("braces", {next, top.back()});
    }
    last = next;
  }
  top.push_back(last);
}

void add_frame_loads(Builder& b, Random& random, double length, double bending) {
  const double force = bending / (length * length) * random.magnitude(0.03, 0.3);
  b.load("weight", {{"acceleration", to_json(Vec3(0, 0, -9.81))}});
  b.load("push", {{"on", {"top"}}, {"force", to_json(force * random.direction())}});
  b.load("turn", {{"on", {"one"}}, {"moment", to_json(0.3 * force * length * random.direction())}});
  b.load("wind", {{"on", {"columns"}}, {"line_force", to_json(force / length * random.direction())}});
  b.load("twist", {{"on", {"columns"}}, {"line_moment", to_json(0.1 * force * random.direction())}});
  b.load("heat", {{"on", {"columns"}}, {"temperature_change", random.between(-60, 60)}});
  b.load("gradient", {{"on", {"columns"}},
                      {"temperature_field",
                       fmt::format("{:.6g} + {:.6g}*x + {:.6g}*z", random.between(-10, 10),
                                   random.between(-30, 30) / length, random.between(-30, 30) / length)}});
  b.load("settlement", {{"on", {"foot"}}, {"displacement", to_json(0.01 * length * random.direction())}});
  b.load("tilt", {{"on", {"foot"}}, {"rotation", to_json(0.03 * random.direction())}});
}

}  // namespace

Json frame(Random& random) {
  Builder b;
  add_metal(b);
  const double length = random.magnitude(1, 10), height = length / random.between(12, 35);
  const bool tree = random.chance(0.4);
  NodeNames base, top;
  if (tree)
    build_tree(b, random, length, base, top);
  else
    build_storey(b, random, length, random.whole(3, 4), base, top);
  for (const auto& group : element_groups(b.deck)) {
    Json section = beam_section(random, height);
    if (random.chance(0.2)) section["shear_flexible"] = false;
    if (section["kind"] == "beam") section.erase("shear_flexible");
    b.section(group, section);
    Json entry{{"orientation", to_json(Vec3(0.3, 0.1, 0) + 0.1 * random.direction())}};
    if (group == "braces" && !tree && random.chance(0.5)) {
      entry["release_start"] = random.chance(0.5) ? Json("all") : Json({"bending_2"});
      entry["release_end"] = {"bending_2", "bending_3"};
    }
    if (group == "beams" && random.chance(0.3))
      entry["offset_end"] = to_json(0.5 * height * random.direction());
    b.group(group, entry);
  }
  b.nodes("base", base);
  b.nodes("foot", {base.front()});
  b.nodes("top", top);
  b.nodes("one", {top.back()});
  b.support("base", "all");
  if (!tree && random.chance(0.3)) b.support("one", {"x"}, {{"x_axis", to_json(random.direction())}});
  const double bending = 2e11 * std::pow(height, 4) / 60;
  add_frame_loads(b, random, length, bending);
  auto loads = some(load_names(b.deck), random);
  if (loads.size() > 1 && random.chance(0.5)) loads.pop_back();
  b.step(equilibrium("loaded", loads));
  b.step({{"kind", "modal"}, {"modes", random.whole(2, 4)}});
  const double force = bending / (length * length);
  if (random.chance(0.5)) {
    b.load("crush", {{"on", {"top"}}, {"force", to_json(0.2 * force * Vec3(0.1, 0.05, -1))}});
    b.step({{"kind", "buckling"}, {"loads", {"crush"}}, {"modes", 2}, {"sign", "positive"}});
  }
  tidy(b.deck);
  return placed(b.deck, random);
}

Json shell(Random& random) {
  Builder b;
  b.deck["materials"]["metal"] = {{"young_modulus", random.magnitude(1e9, 2e11)},
                                  {"poisson_ratio", random.between(0, 0.4)},
                                  {"density", 2000.0},
                                  {"thermal_expansion", 1.2e-5}};
  const double modulus = b.deck["materials"]["metal"]["young_modulus"];
  const double cell = random.magnitude(0.2, 3);
  const int n = random.whole(1, 3), m = random.whole(2, 4);
  const double length = n * cell, thickness = length / random.between(15, 50), rise = 0.15 * length;
  const Grid grid(b, random, n, m, cell,
                  random.chance(0.4) ? [](double, double) { return 0.0; } : saddle(random, rise));
  b.section("plate", {{"kind", "shell"}, {"material", "metal"}, {"thickness", thickness}});
  b.group("plate");
  grid.facets(b, "plate", random, random.one_of(std::vector<double>{0, 0.3, 1}));
  NodeNames clamped, free;
  Json edges = Json::array();
  for (int j = 0; j <= m; ++j) {
    clamped.push_back(grid.at(0, j));
    free.push_back(grid.at(n, j));
    if (j > 0) edges.push_back({grid.at(n, j - 1), grid.at(n, j)});
  }
  b.nodes("clamped", clamped);
  b.nodes("free", free);
  b.nodes("one", {free.front()});
  b.deck["groups"]["rim"] = {{"edges", edges}};
  b.support("clamped", "all");
  const double force = modulus * std::pow(thickness, 3) / 12 / length * random.magnitude(0.02, 0.3);
  b.load("weight", {{"acceleration", to_json(Vec3(0, 0, -9.81))}});
  b.load("pressure", {{"on", {"plate"}}, {"pressure", force / (length * length)}});
  b.load("snow",
         {{"on", {"plate"}}, {"surface_force", to_json(force / (length * length) * random.direction())}});
  b.load("edge", {{"on", {"rim"}}, {"line_force", to_json(force / length * random.direction())}});
  b.load("edge_moment", {{"on", {"rim"}}, {"line_moment", to_json(0.1 * force * random.direction())}});
  b.load("push", {{"on", {"one"}}, {"force", to_json(0.3 * force * random.direction())}});
  b.load("heat", {{"on", {"plate"}}, {"temperature_change", random.between(-40, 40)}});
  b.step(equilibrium("loaded", some(load_names(b.deck), random)));
  b.step({{"kind", "modal"}, {"modes", 3}});
  tidy(b.deck);
  return placed(b.deck, random);
}

namespace {

/// A stem on a foot that springs may hold, with guys from its top and middle to the ground.
struct Mast {
  std::string foot, middle, top;
  NodeNames anchors;
};

Mast build_mast(Builder& b, Random& random, double height) {
  Mast mast;
  mast.foot = b.node(Vec3::Zero());
  mast.middle = b.node(Vec3(0, 0, 0.55 * height) + 0.02 * height * random.direction());
  mast.top = b.node(Vec3(0, 0, height) + 0.03 * height * random.direction());
  b.element("stem", {mast.foot, mast.middle});
  b.element("stem", {mast.middle, mast.top});
  const int n = random.whole(3, 4);
  for (int k = 0; k < n; ++k) {
    const double angle = 2 * std::numbers::pi * (k + random.between(-0.2, 0.2)) / n,
                 r = height * random.between(0.5, 0.9);
    mast.anchors.push_back(
        b.node({r * std::cos(angle), r * std::sin(angle), height * random.between(-0.05, 0.05)}));
    b.element("guys", {mast.top, mast.anchors.back()});
    if (random.chance(0.5)) b.element("guys", {mast.middle, mast.anchors.back()});
  }
  return mast;
}

}  // namespace

Json mast(Random& random) {
  Builder b;
  add_metal(b);
  const double height = random.magnitude(3, 30), side = height / random.between(25, 50);
  const Mast mast = build_mast(b, random, height);
  b.section("stem", beam_section(random, side));
  b.group("stem", {{"orientation", to_json(Vec3(1, random.between(-1, 1), 0))}});
  const double bending = 2e11 * std::pow(side, 4) / 60, critical = 9.87 * bending / (height * height);
  const double tension = 0.05 * critical;
  b.section("guys", {{"kind", "cable"},
                     {"axial_stiffness", 500 * tension},
                     {"mass_per_length", 1e-3 * tension / height},
                     {"thermal_expansion", 1e-5}});
  b.group("guys", {{"tension", tension}});
  if (random.chance(0.5)) {  // a sail between the top and two anchors
    b.section("sail", {{"kind", "membrane"},
                       {"tension_stiffness", 100 * tension / height},
                       {"poisson_ratio", 0.3},
                       {"mass_per_area", 1e-3 * tension / (height * height)}});
    b.group("sail", {{"prestress", 0.1 * tension / height}});
    b.element("sail", {mast.anchors[0], mast.anchors[1], mast.top});
    b.load("wind", {{"on", {"sail"}}, {"pressure", 0.02 * tension / (height * height)}});
  }
  if (random.chance(0.6)) {
    b.section("lamp", {{"kind", "mass"}, {"mass", 0.02 * tension / 9.81}});
    b.group("lamp");
    b.element("lamp", {mast.top});
  }
  std::string loaded = mast.top;
  if (random.chance(0.5)) {
    loaded = b.node(place_of(b.deck, mast.top) + 0.05 * height * random.direction());
    b.section("arm", {{"kind", "rigid_link"}});
    b.group("arm");
    b.element("arm", {mast.top, loaded});
  }
  b.nodes("foot", {mast.foot});
  b.nodes("anchors", mast.anchors);
  b.nodes("loaded", {loaded});
  b.support("anchors", "pinned");
  if (random.chance(0.5)) {
    b.support("foot", "pinned");
    const double k = bending / height * random.between(0.5, 5);
    b.section("soil", {{"kind", "spring"}, {"rotational_stiffness", {k, k, k}}});
    b.group("soil");
    b.element("soil", {mast.foot});
  } else {
    b.support("foot", "all");
  }
  b.load("weight", {{"acceleration", to_json(Vec3(0, 0, -9.81))}});
  b.load("push", {{"on", {"loaded"}}, {"force", to_json(0.1 * tension * random.direction())}});
  b.load("storm", {{"on", {"stem"}}, {"line_force", to_json(0.2 * tension / height * random.direction())}});
  b.load("heat", {{"on", {"guys"}}, {"temperature_change", random.between(-30, 30)}});
  b.step(equilibrium("prestress", {}));
  b.step(equilibrium("loaded", some(load_names(b.deck), random)));
  b.step({{"kind", "modal"}, {"modes", 3}});
  if (random.chance(0.5)) {
    b.nodes("top", {mast.top});
    b.load("crush", {{"on", {"top"}}, {"force", {0.0, 0.0, -critical}}});
    b.step({{"kind", "buckling"}, {"loads", {"crush"}}, {"modes", 1}, {"sign", "positive"}});
  }
  return placed(b.deck, random);
}

Json truss(Random& random) {
  Builder b;
  const double radius = random.magnitude(0.5, 10), rise = radius * random.between(0.15, 0.6),
               stiffness = random.magnitude(1e5, 1e8);
  b.section("bars", {{"kind", "bar"},
                     {"axial_stiffness", stiffness},
                     {"mass_per_length", 1.0},
                     {"thermal_expansion", 1e-5}});
  b.group("bars");
  const auto apex =
      b.node({0.05 * radius * random.between(-1, 1), 0.05 * radius * random.between(-1, 1), rise});
  const int n = random.whole(3, 6);
  NodeNames ring;
  for (int k = 0; k < n; ++k) {
    const double angle = 2 * std::numbers::pi * (k + random.between(-0.15, 0.15)) / n,
                 r = radius * random.between(0.85, 1.15);
    ring.push_back(b.node({r * std::cos(angle), r * std::sin(angle), 0}));
    b.element("bars", {apex, ring.back()});
  }
  b.nodes("ring", ring);
  b.nodes("apex", {apex});
  b.support("ring", "pinned");
  const double length = std::hypot(radius, rise), limit = n * stiffness * 0.385 * std::pow(rise / length, 3);
  b.load("press",
         {{"on", {"apex"}}, {"force", to_json(limit * (-Vec3::UnitZ() + 0.03 * random.direction()))}});
  b.load("side", {{"on", {"apex"}}, {"force", to_json(0.02 * limit * random.direction())}});
  b.load("heat", {{"on", {"bars"}}, {"temperature_change", random.between(-20, 20)}});
  if (random.chance(0.5)) b.step(equilibrium("working", {random.chance(0.5) ? "heat" : "side"}));
  if (random.chance(0.5)) {
    b.step({{"kind", "collapse"}, {"loads", {"press"}}, {"monitor", {"apex"}}, {"linear_factor", 1.0}});
  } else {
    b.step({{"kind", "equilibrium"},
            {"name", "path"},
            {"loads", {"press"}},
            {"control", "arc_length"},
            {"until", {{"load_factor", 0.5}}},
            {"monitor", {"apex"}}});
    b.step({{"kind", "modal"}, {"modes", 3}});
  }
  tidy(b.deck);
  return placed(b.deck, random);
}

Json any_structure(Random& random) {
  static const std::vector<Json (*)(Random&)> families{cable_net, tent, frame, shell, mast, truss};
  return random.one_of(families)(random);
}

Json any_structure_or_reflector(Random& random) {
  return random.chance(0.15) ? reflector(random) : any_structure(random);
}

}  // namespace tautline::metamorphic
