#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>
#include <reflector/y_umbrella_layout.hpp>
#include <set>
#include <tautline/core/error.hpp>
#include <tautline/reflector/surface_error.hpp>
#include <tautline/reflector/y_umbrella.hpp>

namespace tautline::reflector {
namespace {

using Vec2 = Eigen::Vector2d;

YUmbrellaOptions options_50m() {
  YUmbrellaOptions options;
  options.aperture = 50;
  options.focal_length = 27.3;
  options.surface_height = 0.5;
  options.spokes = 12;
  options.rings = 6;
  options.parts = 4;
  options.beam_parts = 4;
  options.hub_radius = 1.5;
  options.fork_radius = 9;
  options.ring_radius = 17;
  return options;
}

std::string error_of(const YUmbrellaOptions& options) {
  try {
    make_y_umbrella(options);
  } catch (const ModelError& error) {
    return error.what();
  }
  return "no error";
}

Vec2 in_plan(const Vec3& p) {
  return p.head<2>();
}

TEST(YUmbrella, HasThePartsCounted) {
  const model::Model model = make_y_umbrella(options_50m());
  // Radii of the tangential cords: 1.5 + 15.5 k/7; parts = round(4 r/17): 1, 1, 2, 2, 3, 3; 12 inside one
  // sector make 6 nodes between spokes.
  const std::map<std::string, std::size_t> cables{
      {"front_radials", 84}, {"rear_radials", 84}, {"front_tangentials", 144}, {"rear_tangentials", 144},
      {"front_ring", 48},    {"rear_ring", 48},    {"front_outer", 48},        {"rear_outer", 48},
      {"ties", 144},         {"middle_ties", 36},  {"front_braces", 72},       {"rear_braces", 72},
      {"tip_cords", 12},     {"fork_cords", 12}};
  for (const auto& [group, count] : cables) EXPECT_EQ(model.select(group).cables.size(), count) << group;
  EXPECT_EQ(model.select("shaping_beams").beams.size(), 144u);
  EXPECT_EQ(model.select("stems").beams.size(), 12u);
  EXPECT_EQ(model.select("branches").beams.size(), 24u);
  EXPECT_EQ(model.select("ends").beams.size(), 24u);
  EXPECT_EQ(model.find_group("extensions"), -1);
  EXPECT_EQ(model.selections.at("hub_nodes").nodes.size(), 36u);
  EXPECT_EQ(model.selections.at("tips").nodes.size(), 24u);
  EXPECT_EQ(model.selections.at("spoke_11").beams.size(), 5u);
  // 144 with ties, 36 beams with 2 ends and 3 inner nodes
  EXPECT_EQ(model.selections.at("front_net_nodes").nodes.size(), 144u + 36 * 5);
}

TEST(YUmbrella, FrontNodesLieOnTheParaboloidAndTheRearMirrorsTheCentre) {
  const model::Model model = make_y_umbrella(options_50m());
  for (const int node : model.nodes_of({"front_surface"})) {
    const Vec3& p = model.nodes[node];
    EXPECT_NEAR(p.z(), 0.5 + p.head<2>().squaredNorm() / (4 * 27.3), 1e-12);
  }
  for (const int i : model.select("ties").cables) {
    const auto& [front, rear] = model.cables[i].nodes;
    const Vec3& p = model.nodes[front];
    EXPECT_EQ(model.nodes[rear], Vec3(p.x(), p.y(), -p.z()));
  }
}

TEST(YUmbrella, HasTheSymmetryOfItsSpokes) {
  const model::Model model = make_y_umbrella(options_50m());
  std::set<std::array<long, 3>> all;
  const auto key = [](const Vec3& p) {
    return std::array{std::lround(p.x() * 1e6), std::lround(p.y() * 1e6), std::lround(p.z() * 1e6)};
  };
  for (const Vec3& p : model.nodes) all.insert(key(p));
  EXPECT_EQ(all.size(), model.nodes.size());
  const Mat3 turn = Eigen::AngleAxisd(std::numbers::pi / 6, Vec3::UnitZ()).toRotationMatrix();
  int missing = 0;
  for (const Vec3& p : model.nodes) {
    bool found = false;
    for (const Vec3& image : {Vec3(turn * p), Vec3(p.x(), -p.y(), p.z())}) {
      found = false;
      for (const Vec3& q : model.nodes) found = found || (q - image).norm() < 1e-9;
      if (!found) ++missing;
    }
  }
  EXPECT_EQ(missing, 0);
}

/// Equal pushes towards the centre at the nodes of the ring, and tensions inversely as the distance of each
/// part from the centre, are in balance in plan.
TEST(YUmbrella, PowerRingBearsThePushOfTheOuterCord) {
  const YUmbrellaOptions options = options_50m();
  const YUmbrellaLayout layout(options);
  const double outer_tension = 200, part = std::numbers::pi / 24;
  const double push = 2 * outer_tension * std::sin(part / 2);
  // beta from radius and sag: 1/r = alpha cos(phi) - beta
  const double cosine = std::cos(std::numbers::pi / 12), sine = std::sin(std::numbers::pi / 12);
  const double at_middle = 1 / (17 * cosine - 0.03 * 2 * 17 * sine);
  const double beta = (at_middle - 1. / 17) / (1 - cosine) - at_middle;
  const double moment = outer_tension * std::cos(part / 2) / beta;
  for (int i = 1; i < 4; ++i) {
    const Vec2 before = in_plan(layout.on_surface(0, i - 1, layout.ring_radius(i - 1))),
               here = in_plan(layout.on_surface(0, i, layout.ring_radius(i))),
               behind = in_plan(layout.on_surface(0, i + 1, layout.ring_radius(i + 1)));
    const auto pull = [&](const Vec2& other) -> Vec2 {
      const Vec2 along = (other - here).normalized();
      return moment / std::abs(along.x() * here.y() - along.y() * here.x()) * along;
    };
    const Vec2 sum = pull(before) + pull(behind) - push * here.normalized();
    EXPECT_NEAR(sum.norm(), 0, 1e-10 * moment) << i;
  }
}

TEST(YUmbrella, BracesCrossInOneNodeOfThePlaneOfTheirBeam) {
  const model::Model model = make_y_umbrella(options_50m());
  const auto front = model.select("front_braces").cables, rear = model.select("rear_braces").cables;
  for (std::size_t i = 0; i < front.size(); ++i) {
    const auto &upper = model.cables[front[i]].nodes, &lower = model.cables[rear[i]].nodes;
    ASSERT_EQ(upper[1], lower[0]);
    const Vec3 a = model.nodes[upper[1]] - model.nodes[upper[0]],
               b = model.nodes[lower[1]] - model.nodes[lower[0]];
    EXPECT_NEAR(a.normalized().dot(b.normalized()), 1, 1e-12);  // one straight cord
    EXPECT_LT(b.z(), 0);
  }
}

TEST(YUmbrella, BeamsGoOnToTheEdgeOfALargerAperture) {
  YUmbrellaOptions options = options_50m();
  options.tip_radius = 23;
  const model::Model model = make_y_umbrella(options);
  EXPECT_EQ(model.select("extensions").beams.size(), 48u * 4);
  EXPECT_EQ(model.select("front_edge").cables.size(), 48u);
  // 144 with ties, 36 beams with 2 ends, 3 inner nodes and 4 beyond; those beyond the tips are held by spokes
  EXPECT_EQ(model.selections.at("front_net_nodes").nodes.size(), 144u + 36 * 9);
  for (const int node : model.nodes_of({"front_edge"}))
    EXPECT_NEAR(in_plan(model.nodes[node]).norm(), 25, 1e-12);
  for (const int i : model.select("front_edge").cables)
    EXPECT_NEAR(model.reference_length(model.cables[i]), 50 * std::sin(std::numbers::pi / 48), 1e-12);
  for (const int node : model.nodes_of({"extensions"})) {
    const Vec3& p = model.nodes[node];
    EXPECT_NEAR(p.z(), 0.5 + p.head<2>().squaredNorm() / (4 * 27.3), 1e-12);
  }
}

TEST(YUmbrella, ThreeSpokesAreEnough) {
  YUmbrellaOptions options = options_50m();
  options.spokes = 3;
  EXPECT_EQ(error_of(options), "no error");
}

TEST(YUmbrella, RefusesWhatIsNoUmbrella) {
  const auto refused = [](auto change, const std::string& reason) {
    YUmbrellaOptions options = options_50m();
    change(options);
    EXPECT_NE(error_of(options).find(reason), std::string::npos) << error_of(options);
  };
  refused([](auto& o) { o.spokes = 2; }, "at least 3 spokes");
  refused([](auto& o) { o.rings = 0; }, "at least one ring");
  refused([](auto& o) { o.parts = 1; }, "no place for a beam");
  refused([](auto& o) { o.beam_parts = 3; }, "is not even");
  refused([](auto& o) { o.fork_radius = 18; }, "a spoke goes outwards");
  refused([](auto& o) { o.tip_radius = 26; }, "outside aperture/2");
  refused([](auto& o) { o.ring_sag = 0.5; }, "ring_sag");
  refused([](auto& o) { o.surface_height = -0.1; }, "touch or cross");
}

}  // namespace
}  // namespace tautline::reflector
