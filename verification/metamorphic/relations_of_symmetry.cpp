/// @file
/// Halves, sectors, wholes.

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "relation.hpp"
#include "structures.hpp"
#include "transformations.hpp"

namespace tautline::metamorphic {

namespace {

/// Kinds of members that a part of a symmetric structure is made of.
enum class Fabric { net, cloth, shell, frame };

const char* const fabric_group = "members";

void describe(Builder& b, Fabric fabric, double cell, Random& random) {
  const double stiffness = random.magnitude(1e4, 1e6);
  b.deck["materials"]["metal"] = {
      {"young_modulus", 1e10}, {"poisson_ratio", 0.3}, {"density", 2000.0}, {"thermal_expansion", 1e-5}};
  switch (fabric) {
    case Fabric::net:
      b.section(fabric_group, {{"kind", "cable"},
                               {"axial_stiffness", stiffness * cell},
                               {"mass_per_length", 1e-6 * stiffness},
                               {"thermal_expansion", 1e-5}});
      b.group(fabric_group, {{"tension", 0.003 * stiffness * cell}});
      break;
    case Fabric::cloth:
      b.section(fabric_group, {{"kind", "membrane"},
                               {"tension_stiffness", stiffness},
                               {"poisson_ratio", 0.3},
                               {"mass_per_area", 1e-6 * stiffness},
                               {"thermal_expansion", 1e-5}});
      b.group(fabric_group, {{"prestress", 0.003 * stiffness}});
      break;
    case Fabric::shell:
      b.section(fabric_group,
                {{"kind", "shell"}, {"material", "metal"}, {"thickness", cell / random.between(8, 20)}});
      b.group(fabric_group);
      break;
    case Fabric::frame:
      b.section(fabric_group,
                {{"kind", "round"}, {"material", "metal"}, {"diameter", cell / random.between(8, 20)}});
      b.group(fabric_group, {{"orientation", to_json(random.direction())}});
  }
}

/// A force per node that moves such a structure by a part of its size.
double force_of(const Json& deck, Fabric fabric, double cell) {
  const Json& section = section_of(deck, fabric_group);
  if (fabric == Fabric::net) return 2e-4 * section["axial_stiffness"].get<double>();
  if (fabric == Fabric::cloth) return 2e-4 * cell * section["tension_stiffness"].get<double>();
  const double h = section.value("thickness", section.value("diameter", 0.0));
  return 0.01 * 1e10 * std::pow(h, fabric == Fabric::shell ? 3 : 4) / 12 /
         (fabric == Fabric::shell ? cell : cell * cell);
}

/// Loads of a part: `plane` is the space of directions in which its images have the same load.
void load_part(Builder& b, Fabric fabric, double cell, const std::vector<std::string>& free,
               const std::function<Vec3()>& plane, Random& random) {
  const double force = force_of(b.deck, fabric, cell);
  if (!free.empty()) {
    b.nodes("some", {random.one_of(free)});
    b.load("push", {{"on", Json::array({"some"})}, {"force", to_json(force * plane())}});
  }
  if (fabric == Fabric::cloth || fabric == Fabric::shell) {
    b.load("wind", {{"on", Json::array({fabric_group})}, {"pressure", 0.3 * force / (cell * cell)}});
    b.load("snow", {{"on", Json::array({fabric_group})},
                    {"surface_force", to_json(0.3 * force / (cell * cell) * plane())}});
  } else {
    b.load("ice",
           {{"on", Json::array({fabric_group})}, {"line_force", to_json(0.3 * force / cell * plane())}});
  }
  b.load("heat", {{"on", Json::array({fabric_group})}, {"temperature_change", random.between(-20, 10)}});
  b.load("weight", {{"acceleration", to_json(9.81 * plane())}});
  std::vector<std::string> names;
  for (const auto& name : load_names(b.deck))
    if (random.chance(0.6)) names.push_back(name);
  if (names.empty()) names.push_back("heat");
  b.step({{"kind", "equilibrium"}, {"loads", names}});
}

/// Members on a grid of nodes; those along the first row and, with `closed`, along the last column of a grid
/// are in a plane of symmetry and left out.
void weave(Builder& b, Fabric fabric, int n, int m, const std::function<std::string(int, int)>& at,
           bool lines_in_first_row, Random& random) {
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= m; ++j) {
      if (fabric == Fabric::net || fabric == Fabric::frame) {
        if (i < n) b.element(fabric_group, {at(i, j), at(i + 1, j)});
        if (j < m && (i > 0 || lines_in_first_row)) b.element(fabric_group, {at(i, j), at(i, j + 1)});
      } else if (i < n && j < m) {
        if (random.chance(0.6)) {
          b.element(fabric_group, {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
        } else {
          b.element(fabric_group, {at(i, j), at(i + 1, j), at(i + 1, j + 1)});
          b.element(fabric_group, {at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
      }
    }
}

const std::vector<Fabric> fabrics{Fabric::net, Fabric::cloth, Fabric::shell, Fabric::frame};

/// The half at x >= 0 of a structure that is symmetric about x = 0; its far rim is held.
Json half_structure(Random& random) {
  Builder b;
  const Fabric fabric = random.one_of(fabrics);
  const double cell = random.magnitude(0.3, 5), slope = random.between(-0.5, 0.5),
               bend = random.between(-0.3, 0.3) / cell;
  const int n = random.whole(1, 3), m = random.whole(2, 3);
  describe(b, fabric, cell, random);
  std::vector<std::string> names, plane, rim, free;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= m; ++j) {
      const double x = i == 0 ? 0 : cell * (i + random.between(-0.15, 0.15)),
                   y = cell * (j + random.between(-0.15, 0.15));
      names.push_back(b.node({x, y, slope * x + bend * (y - m * cell / 2) * (y - m * cell / 2)}));
      const bool held = i == n || (fabric != Fabric::shell && (j == 0 || j == m));
      if (i == 0) plane.push_back(names.back());
      if (held) rim.push_back(names.back());
      if (!held && i > 0) free.push_back(names.back());
    }
  weave(
      b, fabric, n, m, [&](int i, int j) { return names[static_cast<std::size_t>(i * (m + 1) + j)]; }, false,
      random);
  b.nodes("plane", plane);
  b.nodes("rim", rim);
  b.support("rim", fabric == Fabric::shell || fabric == Fabric::frame ? "all" : "pinned");
  b.support("plane", "symmetry");
  load_part(
      b, fabric, cell, free,
      [&] {
        const double angle = random.between(0, 2 * std::numbers::pi);
        return Vec3(0, std::cos(angle), std::sin(angle));
      },
      random);
  tidy(b.deck);
  return b.deck;
}

std::string image(const std::string& node) {
  return node + "m";
}

/// The half and its mirror image.
Json whole_of(const Json& half) {
  Json whole = half;
  Json supports = Json::array();
  for (const auto& support : half["supports"])
    if (support["fix"] != "symmetry") supports.push_back(support);
  whole["supports"] = supports;
  const auto mirrored = [&](const std::string& node) {
    return place_of(half, node)[0] == 0 ? node : image(node);
  };
  for (const auto& item : half["model"]["nodes"].items()) {
    Vec3 x = to_vec3(item.value());
    if (x[0] == 0) continue;
    x[0] = -x[0];
    whole["model"]["nodes"][image(item.key())] = to_json(x);
  }
  for (const auto& [group, elements] : half["model"]["elements"].items())
    for (const auto& element : elements) {
      Json copy = Json::array();
      for (const auto& node : element) copy.push_back(mirrored(node));
      whole["model"]["elements"][group].push_back(copy.size() > 2 ? reversed_nodes(copy) : copy);
    }
  for (const auto& [name, group] : half["groups"].items())
    if (group.contains("nodes"))
      for (const auto& node : group["nodes"])
        if (mirrored(node) != node) whole["groups"][name]["nodes"].push_back(mirrored(node));
  return whole;
}

/// What the part says of itself, but for forces in its cuts.
std::vector<Difference> compare_part(const Outcome& part, const Outcome& whole,
                                     const std::vector<std::string>& cut, double tolerance) {
  Outcome a = part.without("step "), b = whole.without("step ");
  a.numbers.erase("mass");
  for (const auto& node : cut) {
    a.numbers.erase("node " + node + " reaction");
    a.numbers.erase("node " + node + " reaction moment");
  }
  for (const auto& [key, quantity] : part.numbers)
    if (key.find(" group ") != std::string::npos && key.find("mean") == std::string::npos) {
      a.numbers[key] = quantity;
      b.numbers[key] = whole.numbers.at(key);
    }
  std::erase_if(b.numbers, [&](const auto& item) { return a.numbers.count(item.first) == 0; });
  return compare(a, b, tolerance);
}

std::optional<Trial> half_and_whole(const Json& deck, Random& random) {
  if (!deck["groups"].contains("plane") || !deck["groups"].contains("rim") || deck["supports"].size() != 2)
    return std::nullopt;
  Json whole = whole_of(deck);
  tidy(whole);
  Json half = deck;
  if (random.chance(0.5)) {
    const Motion motion{random.rotation(), Vec3(random.direction())};
    half = moved(half, motion);
    whole = moved(whole, motion);
  }
  Trial trial;
  trial.jobs = {{half}, {whole}};
  const auto cut = nodes_of(deck, "plane");
  trial.judge = [cut](const Outcomes& o) { return compare_part(o[0], o[1], cut, usual_tolerance); };
  return trial;
}

/// A sector about z, its inner rim free or held, its outer rim held; faces at rows 0 and m.
Json sector_structure(Random& random) {
  Builder b;
  const Fabric fabric = random.one_of(fabrics);
  const double cell = random.magnitude(0.3, 5), slope = random.between(0.1, 0.7);
  const int n = random.whole(2, 3), m = random.whole(1, 3), sectors = random.whole(3, 7);
  const double angle = 2 * std::numbers::pi / sectors, start = random.between(0, 6);
  describe(b, fabric, cell, random);
  std::vector<std::string> names(static_cast<std::size_t>((n + 1) * (m + 1))), rim, from, to, free;
  const auto at = [&](int i, int j) -> std::string& {
    return names[static_cast<std::size_t>(i * (m + 1) + j)];
  };
  for (int i = 0; i <= n; ++i) {
    double first = 0, radius0 = 0;
    for (int j = 0; j <= m; ++j) {
      const double jitter = random.between(-0.15, 0.15);
      double theta = start + angle * (j + (j == m ? 0 : jitter)) / m,
             r = cell * (1 + i + (j == m ? 0 : random.between(-0.1, 0.1)));
      if (j == 0) first = theta, radius0 = r;
      if (j == m) theta = first + angle, r = radius0;
      at(i, j) = b.node({r * std::cos(theta), r * std::sin(theta), slope * r});
      if (j == 0) from.push_back(at(i, j));
      if (j == m) to.push_back(at(i, j));
      const bool held = i == n || (i == 0 && fabric != Fabric::shell && fabric != Fabric::frame);
      if (held && j < m) rim.push_back(at(i, j));
      if (!held && j > 0 && j < m) free.push_back(at(i, j));
    }
  }
  weave(b, fabric, n, m, at, true, random);
  if (fabric == Fabric::net ||
      fabric == Fabric::frame) {  // members along the last face belong to the next sector
    Json left = Json::array();
    const auto in_face = [&](const std::string& node) {
      return std::find(to.begin(), to.end(), node) != to.end();
    };
    for (const auto& element : b.deck["model"]["elements"][fabric_group])
      if (!in_face(element[0]) || !in_face(element[1])) left.push_back(element);
    b.deck["model"]["elements"][fabric_group] = left;
  }
  if (fabric == Fabric::frame) {  // an axis that turns with the sectors
    b.deck["groups"][fabric_group]["orientation"] = {0.0, 0.0, 1.0};
    b.deck["sections"][fabric_group]["kind"] = "round";
  }
  b.nodes("rim", rim);
  b.nodes("from", from);
  b.nodes("to", to);
  b.support("rim", fabric == Fabric::shell || fabric == Fabric::frame ? "all" : "pinned");
  load_part(
      b, fabric, cell, free, [&] { return Vec3(0, 0, random.chance(0.5) ? 1 : -1); }, random);
  b.deck["model"]["cyclic"] = Json::array({{{"from", {"from"}},
                                            {"to", {"to"}},
                                            {"angle", 360.0 / sectors},
                                            {"axis", {0.0, 0.0, 1.0}},
                                            {"centre", {0.0, 0.0, 0.0}}}});
  return b.deck;
}

/// Every sector by itself, joined at the faces.
Json ring_of(const Json& sector) {
  Json ring = sector;
  ring["model"].erase("cyclic");
  const int sectors =
      static_cast<int>(std::lround(360.0 / sector["model"]["cyclic"][0]["angle"].get<double>()));
  const Json from = sector["groups"]["from"]["nodes"], to = sector["groups"]["to"]["nodes"];
  const auto position = [](const Json& list, const std::string& node) {
    for (std::size_t i = 0; i < list.size(); ++i)
      if (list[i] == node) return static_cast<int>(i);
    return -1;
  };
  /// Name of a node of sector k; the end of one is the beginning of the next.
  const std::function<std::string(std::string, int)> name = [&](const std::string& node,
                                                                int k) -> std::string {
    k = k % sectors;
    if (const int i = position(to, node); i >= 0) {
      if (k == 0) return node;
      return name(from[static_cast<std::size_t>(i)], k + 1);
    }
    if (const int i = position(from, node); i >= 0 && k == 1) return to[static_cast<std::size_t>(i)];
    return k == 0 ? node : fmt::format("{}s{}", node, k);
  };
  for (int k = 1; k < sectors; ++k) {
    const Mat3 turn = Eigen::AngleAxisd(2 * std::numbers::pi * k / sectors, Vec3::UnitZ()).toRotationMatrix();
    for (const auto& item : sector["model"]["nodes"].items()) {
      const auto copy = name(item.key(), k);
      if (!ring["model"]["nodes"].contains(copy))
        ring["model"]["nodes"][copy] = to_json(turn * to_vec3(item.value()));
    }
    for (const auto& [group, elements] : sector["model"]["elements"].items())
      for (const auto& element : elements) {
        Json copy = Json::array();
        for (const auto& node : element) copy.push_back(name(node, k));
        ring["model"]["elements"][group].push_back(copy);
      }
    for (const auto& group : {"rim", "some"})
      if (sector["groups"].contains(group))
        for (const auto& node : sector["groups"][group]["nodes"]) {
          const auto copy = name(node, k);
          auto& list = ring["groups"][group]["nodes"];
          if (std::find(list.begin(), list.end(), copy) == list.end()) list.push_back(copy);
        }
  }
  return ring;
}

std::optional<Trial> sector_and_whole(const Json& deck, Random& random) {
  if (!deck["groups"].contains("from") || !deck["groups"].contains("to") ||
      !deck["model"].contains("cyclic") || !deck["groups"].contains("rim") ||
      deck["groups"]["from"]["nodes"].size() != deck["groups"]["to"]["nodes"].size())
    return std::nullopt;
  Json ring = ring_of(deck), sector = deck;
  if (random.chance(0.5)) {
    const Motion motion{random.rotation(), Vec3(random.direction())};
    sector = moved(sector, motion);
    ring = moved(ring, motion);
  }
  tidy(ring);
  Trial trial;
  trial.jobs = {{sector}, {ring}};
  auto cut = nodes_of(deck, "from");
  for (const auto& node : nodes_of(deck, "to")) cut.push_back(node);
  trial.judge = [cut](const Outcomes& o) { return compare_part(o[0], o[1], cut, usual_tolerance); };
  return trial;
}

/// The one strut that holds a reflector, and its place: a dish about its own axis has the symmetry of its
/// net, an offset one that of its plane.
std::optional<Trial> reflector_turned(const Json& deck, Random& random) {
  if (!deck.contains("reflector")) return std::nullopt;
  Json first = deck, second = deck;
  const bool offset = deck["reflector"].contains("clearance");
  const int struts = deck["reflector"]["struts"];
  const double angle = 60.0 * random.whole(1, 2);
  if (offset && struts % 6 != 0) return std::nullopt;
  first["reflector"]["held_strut"] = offset ? angle : 0.0;
  second["reflector"]["held_strut"] = offset ? -angle : struts % 6 == 0 ? angle : 120.0;
  Trial trial;
  trial.jobs = {{first}, {second}};
  trial.judge = [](const Outcomes& o) {
    auto a = o[0].only("step "), b = o[1].only("step ");
    for (auto* side : {&a, &b})
      std::erase_if(side->numbers,
                    [](const auto& item) { return item.first.find("reaction") != std::string::npos; });
    return compare(a, b, 1e-5);
  };
  return trial;
}

}  // namespace

std::vector<Relation> relations_of_symmetry() {
  return {
      {"half_and_whole", "Half of a symmetric structure, held as symmetry says, moves as in the whole.",
       "1e-6 of the largest: only rounding differs", half_structure, half_and_whole},
      {"sector_and_whole", "A sector with cyclic faces moves as in the whole ring.",
       "1e-6 of the largest: only rounding differs", sector_structure, sector_and_whole},
      {"reflector_turned", "A reflector held at another strut of the same symmetry: the same figures.",
       "1e-5 of the largest: tuning stops by a criterion of its own", reflector, reflector_turned},
  };
}

}  // namespace tautline::metamorphic
