// Net patterns of the umbrella after Belov (2021), section 3.3.3: what there is, and that it can be balanced.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <reflector/tables.hpp>
#include <set>
#include <tautline/core/error.hpp>
#include <tautline/formfinding/balanced.hpp>
#include <tautline/formfinding/force_density.hpp>
#include <tautline/reflector/umbrella.hpp>
#include <tuple>

namespace tautline::reflector {
namespace {

using enum NetPattern;

/// The six variants of the source: front and rear pattern.
const std::vector<std::array<NetPattern, 2>> variants{
    {triangles, triangles}, {belts, belts},      {triangles, coarse_triangles},
    {triangles, belts},     {rectangles, belts}, {right_triangles, right_triangles}};

UmbrellaOptions umbrella(NetPattern front, NetPattern rear, int spokes = 6, int rings = 6) {
  UmbrellaOptions options;
  options.aperture = 48;
  options.focal_length = 28.8;
  options.surface_height = 1;
  options.spokes = spokes;
  options.rings = rings;
  options.hub_radius = 1.2;
  options.joint_radius = 10;
  options.apex_radius = 20;
  options.tip_radius = {25};
  options.cord_sag = 0.06;
  options.ring_sag = 0;
  options.front_pattern = front;
  options.rear_pattern = rear;
  options.separate_rings = true;
  options.end_cords = true;
  return options;
}

std::size_t count(const model::Model& model, const std::string& group) {
  return model.find_group(group) < 0 ? 0 : cables_of(model, group).size();
}

/// Groups front_... or rear_... of cables.
std::vector<std::string> net_groups(const model::Model& model, const std::string& prefix) {
  std::vector<std::string> names;
  for (const auto& group : model.groups)
    if (group.kind == model::ElementKind::cable && group.name.rfind(prefix, 0) == 0)
      names.push_back(group.name);
  return names;
}

TEST(UmbrellaPatterns, HaveThePartsCounted) {
  for (const int n : {6, 8, 12})
    for (const int r : {4, 6}) {
      const auto belt = make_umbrella(umbrella(belts, belts, n, r));
      EXPECT_EQ(count(belt, "front_net"), std::size_t(n * r));
      EXPECT_EQ(count(belt, "front_rings"), std::size_t(n * r * (r + 1) / 2));
      EXPECT_EQ(count(belt, "front_connectors"), 0u);
      EXPECT_EQ(belt.selections.at("front_net_nodes").nodes.size(),
                std::size_t(n * (r + r * (r - 1) / 2 + r - 1)));
      EXPECT_EQ(belt.membranes.size(), std::size_t(n * (r * r + 1)));

      const auto coarse = make_umbrella(umbrella(triangles, coarse_triangles, n, r));
      // Lines parallel to a spoke begin on the other one at each even ring and end at the last: r - k parts.
      int diagonals = 0;
      for (int k = 2; k < r; k += 2) diagonals += 2 * (r - k);
      EXPECT_EQ(count(coarse, "rear_net"), std::size_t(n * (r + diagonals)));
      EXPECT_EQ(count(coarse, "rear_rings"), std::size_t(n * (r / 2) * (r / 2 + 1)));  // 2 + 4 + ... + r
      EXPECT_EQ(count(coarse, "rear_connectors"), std::size_t(n * (r / 2 - 1)));

      const auto rectangle = make_umbrella(umbrella(rectangles, belts, n, r));
      EXPECT_EQ(count(rectangle, "front_rings"), std::size_t(n * r * r));          // 1 + 3 + ... + 2r - 1
      EXPECT_EQ(count(rectangle, "front_columns"), std::size_t(n * r * (r - 1)));  // 2 + 4 + ... + 2(r - 1)
      EXPECT_EQ(count(rectangle, "front_connectors"), std::size_t(n * (2 * r - 2)));
      EXPECT_EQ(rectangle.membranes.size(), std::size_t(n * (2 * r * r - 2 * r + 2)));
      EXPECT_EQ(rectangle.selections.at("front_net_nodes").nodes.size(),
                std::size_t(n * (r * r + 2 * r - 2)));
      EXPECT_EQ(rectangle.selections.at("rear_net_nodes").nodes.size(),
                rectangle.selections.at("front_net_nodes").nodes.size());

      const auto right = make_umbrella(umbrella(right_triangles, right_triangles, n, r));
      EXPECT_EQ(count(right, "front_rings"), std::size_t(n * (r * (r + 1) - 1)));  // 2 + 4 + ... less one
      EXPECT_EQ(right.membranes.size(), std::size_t(n * (2 * r * r - 1)));
      EXPECT_EQ(right.selections.at("front_net_nodes").nodes.size(), std::size_t(n * (r * r + 3 * r - 2)));
      EXPECT_EQ(count(right, "front_columns"), std::size_t(n * (r * r - 2)));  // 3 + 5 + ... + 2r - 1, and 2
      EXPECT_EQ(count(right, "front_net"), std::size_t(n * (r + r * (r - 1))));  // spokes, 2k diagonals
    }
}

TEST(UmbrellaPatterns, GroupsAreThoseThatADeckHasToName) {
  for (const bool separate : {false, true})
    for (const bool ends : {false, true})
      for (const auto& [front, rear] : variants) {
        auto options = umbrella(front, rear);
        options.separate_rings = separate;
        options.end_cords = ends;
        const auto model = make_umbrella(options);
        for (const char* part :
             {"net", "rings", "columns", "connectors", "end_connectors", "peripheral", "end_peripheral",
              "crossing_a_inner", "crossing_a_outer", "crossing_b_inner", "crossing_b_outer", "end_cords"}) {
          const std::string name = part;
          EXPECT_EQ(model.find_group("front_" + name) >= 0, has_cords(options, front, name)) << name;
          EXPECT_EQ(model.find_group("rear_" + name) >= 0, has_cords(options, rear, name)) << name;
        }
      }
}

TEST(UmbrellaPatterns, EveryFreeNodeHangsInItsNetAndOnATie) {
  for (const auto& [front, rear] : variants) {
    const auto model = make_umbrella(umbrella(front, rear));
    std::map<int, int> cords;
    for (const std::string net : {"front_", "rear_"})
      for (const auto& group : net_groups(model, net))
        for (const auto& [a, b] : cables_of(model, group)) {
          EXPECT_NE(a, b);
          ++cords[a];
          ++cords[b];
        }
    std::set<int> tied;
    for (const auto& tie : cables_of(model, "ties")) tied.insert(tie.begin(), tie.end());
    for (const char* nodes : {"front_net_nodes", "rear_net_nodes"})
      for (const int node : model.selections.at(nodes).nodes) {
        EXPECT_GE(cords[node], 2);
        EXPECT_TRUE(tied.count(node));
      }
  }
}

TEST(UmbrellaPatterns, NoTwoCordsJoinTheSameNodes) {
  for (const auto& [front, rear] : variants) {
    const auto model = make_umbrella(umbrella(front, rear));
    std::set<std::array<int, 2>> joined;
    for (const auto& cable : model.cables) {
      const auto [a, b] = cable.nodes;
      EXPECT_TRUE(joined.insert({std::min(a, b), std::max(a, b)}).second) << a << " and " << b;
    }
  }
}

// The cords across the rings run in plan like the spokes, or, where they are columns, like the bisectors
// between them.
TEST(UmbrellaPatterns, ColumnsAreParallelToTheBisectorsOfTheSpokes) {
  for (const auto& [front, group, bisect] :
       {std::tuple{rectangles, "front_columns", true}, std::tuple{right_triangles, "front_columns", true},
        std::tuple{rectangles, "front_net", false}}) {
    const int n = 6;
    const auto model = make_umbrella(umbrella(front, belts, n));
    const auto cords = cables_of(model, group);
    ASSERT_FALSE(cords.empty());
    for (const auto& [a, b] : cords) {
      const Vec3 along = model.nodes[b] - model.nodes[a];
      const double angle = std::atan2(along.y(), along.x());  // spokes at 2 k pi / n, bisectors between
      EXPECT_NEAR(std::cos(n * angle), bisect ? -1 : 1, 1e-12) << group << " " << a << " to " << b;
    }
  }
}

TEST(UmbrellaPatterns, PeripheralCordsOfCoarseNetsAreStraightWhereNoConnectorPulls) {
  const auto model = make_umbrella(umbrella(triangles, coarse_triangles));
  std::set<int> pulled;
  for (const auto& cord : cables_of(model, "rear_connectors")) pulled.insert(cord.begin(), cord.end());
  std::map<int, std::vector<int>> next;  // along the peripheral cord
  for (const char* group : {"rear_peripheral", "rear_end_peripheral"})
    for (const auto& [a, b] : cables_of(model, group)) {
      next[a].push_back(b);
      next[b].push_back(a);
    }
  const auto& tips = model.selections.at("tips").nodes;
  int straight = 0, bent = 0;
  for (const auto& [node, ends] : next) {
    if (std::find(tips.begin(), tips.end(), node) != tips.end()) continue;
    ASSERT_EQ(ends.size(), 2u);
    const Vec3 a = model.nodes[ends[0]] - model.nodes[node], b = model.nodes[ends[1]] - model.nodes[node];
    const double bend = std::abs(a.x() * b.y() - a.y() * b.x()) / (a.norm() * b.norm());
    if (pulled.count(node)) {
      EXPECT_GT(bend, 1e-2) << node;
      ++bent;
    } else {
      EXPECT_LT(bend, 1e-12) << node;
      ++straight;
    }
  }
  EXPECT_EQ(straight, 6 * (3 + 2));  // every second node, and those on the cord before its ends
  EXPECT_EQ(bent, 6 * 2);
}

TEST(UmbrellaPatterns, ClothCoversTheLastRingWithoutGapOrOverlap) {
  // In plan, facets look up and their areas add up to that of the polygon through the ends of the spokes.
  for (const NetPattern front : {belts, rectangles, right_triangles})
    for (const int n : {6, 8}) {
      const auto options = umbrella(front, front, n);
      const auto model = make_umbrella(options);
      double area = 0;
      for (const auto& membrane : model.membranes) {
        const Vec3 a = model.nodes[membrane.nodes[0]], b = model.nodes[membrane.nodes[1]],
                   c = model.nodes[membrane.nodes[2]];
        const double facet = 0.5 * (b - a).head<2>().dot(Eigen::Vector2d((c - a).y(), -(c - a).x()));
        EXPECT_GT(facet, 0);
        area += facet;
      }
      const auto sector = [&](double r) { return 0.5 * n * r * r * std::sin(2 * std::acos(-1) / n); };
      const double hub = sector(options.hub_radius);
      EXPECT_NEAR(area, sector(options.last_ring * 25) - hub, 1e-9 * area);
    }
}

/// A net of the model, hub nodes and tips fixed, and the wanted tension of each branch.
struct Problem {
  formfinding::Net net;
  VecX wanted;
};

/// Tensions with which straight cords balance in plan, see docs/theory/umbrella.md.
double wanted_tension(const std::string& part, NetPattern pattern, int spokes) {
  const double half = std::acos(-1) / spokes;
  if (part == "peripheral" || part == "end_peripheral") return pattern == belts ? 600 : 720;
  if (part == "rings")
    return pattern == belts        ? 120
           : pattern == rectangles ? 29 / std::tan(half)
                                   : 40 * std::cos(2 * half) / std::sin(half);
  if (part == "net" || part == "end_cords") return pattern == belts ? 600 : 40;
  if (part == "connectors") return pattern == rectangles ? 29 : pattern == coarse_triangles ? 144 : 69;
  return part == "columns" ? 29 : 50;
}

Problem problem_of(const model::Model& model, const std::string& prefix, NetPattern pattern, int spokes) {
  Problem problem;
  const auto& free = model.selections.at(prefix + "net_nodes").nodes;
  problem.net.nodes = model.nodes;
  problem.net.fixed.assign(model.nodes.size(), true);
  for (const int node : free) problem.net.fixed[node] = false;
  std::vector<double> wanted;
  for (const auto& group : net_groups(model, prefix))
    for (const auto& side : cables_of(model, group)) {
      problem.net.branches.push_back(side);
      wanted.push_back(wanted_tension(group.substr(prefix.size()), pattern, spokes));
    }
  problem.wanted = Eigen::Map<VecX>(wanted.data(), static_cast<Eigen::Index>(wanted.size()));
  return problem;
}

/// Forces of the branches and loads on every node, anew.
Points forces(const formfinding::Net& net, const Points& nodes, const VecX& tension) {
  Points force = net.load.empty() ? Points(nodes.size(), Vec3::Zero()) : net.load;
  for (std::size_t b = 0; b < net.branches.size(); ++b) {
    const auto [i, j] = net.branches[b];
    const Vec3 pull = tension[static_cast<Eigen::Index>(b)] * (nodes[j] - nodes[i]).normalized();
    force[i] += pull;
    force[j] -= pull;
  }
  return force;
}

TEST(UmbrellaPatterns, FrontAndRearNetsOfAllVariantsAreBalanced) {
  for (const auto& [front, rear] : variants)
    for (const int spokes : {6, 8, 12}) {
      SCOPED_TRACE(testing::Message() << int(front) << "/" << int(rear) << ", " << spokes << " spokes");
      const auto options = umbrella(front, rear, spokes);
      const auto model = make_umbrella(options);
      const Paraboloid surface = make_paraboloid(options);
      auto before = problem_of(model, "front_", front, spokes);
      const auto found = formfinding::find_linear_form(
          before.net, formfinding::balancing_force_densities(before.net, before.wanted, {}, &surface),
          &surface);
      const Points left = forces(before.net, found.nodes, found.tension);
      auto behind = problem_of(model, "rear_", rear, spokes);
      behind.net.load.assign(model.nodes.size(), Vec3::Zero());
      for (const auto& [a, b] : cables_of(model, "ties")) {
        EXPECT_LE(left[a].head<2>().norm(), 1e-9);
        EXPECT_GT(left[a].z(), 0);  // which the tie balances
        behind.net.load[b] = Vec3(0, 0, left[a].z());
      }
      formfinding::BalancedOptions fit;
      fit.height_weight = 0;
      const auto hung = formfinding::find_linear_form(
          behind.net, formfinding::balancing_force_densities(behind.net, behind.wanted, {}, nullptr, fit));
      const Points rest = forces(behind.net, hung.nodes, hung.tension);
      for (const auto& tie : cables_of(model, "ties")) {
        EXPECT_LE(rest[tie[1]].norm(), 1e-9);
        EXPECT_LT(hung.nodes[tie[1]].z(), found.nodes[tie[0]].z());
      }
      EXPECT_GT(found.tension.minCoeff(), 0);
      EXPECT_GT(hung.tension.minCoeff(), 0);
    }
}

std::string error_of(const UmbrellaOptions& options) {
  try {
    make_umbrella(options);
  } catch (const ModelError& error) {
    return error.what();
  }
  return "no error";
}

TEST(UmbrellaPatterns, ThatDoNotFitAreExplained) {
  EXPECT_NE(error_of(umbrella(belts, triangles)).find("rear_pattern does not fit"), std::string::npos);
  EXPECT_NE(error_of(umbrella(rectangles, coarse_triangles)).find("rear_pattern does not fit"),
            std::string::npos);
  EXPECT_NE(error_of(umbrella(coarse_triangles, coarse_triangles)).find("is a rear net's"),
            std::string::npos);
  EXPECT_NE(error_of(umbrella(triangles, coarse_triangles, 6, 5)).find("even number of rings, not 5"),
            std::string::npos);
}

}  // namespace
}  // namespace tautline::reflector
