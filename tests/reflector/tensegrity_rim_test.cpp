#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <reflector/tables.hpp>
#include <set>
#include <tautline/core/error.hpp>
#include <tautline/reflector/tensegrity_rim.hpp>

namespace tautline::reflector {
namespace {

TensegrityRimOptions options_48m() {
  TensegrityRimOptions options;
  options.aperture = 48;
  options.focal_length = 32;
  options.clearance = 4.5;
  options.rings = 9;
  options.rim_height = 3.92;
  options.gap = 0.08;
  options.rim_offset = 0.75;
  options.cord_reach = 0.5;
  return options;
}

std::string error_of(const TensegrityRimOptions& options) {
  try {
    make_tensegrity_rim(options);
  } catch (const ModelError& error) {
    return error.what();
  }
  return "no error";
}

TEST(TensegrityRim, HasThePartsCounted) {
  const model::Model model = make_tensegrity_rim(options_48m());
  // One net: 1 + 3 n (n + 1) nodes, 9 n^2 - 3 n cables, 6 n^2 facets; 6 n struts, each with 8 cords.
  EXPECT_EQ(model.nodes.size(), 2u * 271 + 3 * 54);
  EXPECT_EQ(model.select("front_net").cables.size(), 702u);
  EXPECT_EQ(model.select("rear_net").cables.size(), 702u);
  EXPECT_EQ(model.select("ties").cables.size(), 217u);
  EXPECT_EQ(model.select("end_cords").cables.size(), 216u);
  EXPECT_EQ(model.select("knee_cords").cables.size(), 216u);
  EXPECT_EQ(model.select("rim").beams.size(), 54u);
  EXPECT_EQ(model.select("end_links").beams.size(), 108u);
  EXPECT_EQ(model.select("middle_links").beams.size(), 54u);
  EXPECT_EQ(model.membranes.size(), 486u);
  EXPECT_EQ(model.selections.at("knees").nodes.size(), 108u);
  EXPECT_EQ(model.selections.at("rim_nodes").nodes.size(), 54u);
  EXPECT_EQ(model.selections.count("strut_53"), 1u);
  EXPECT_EQ(model.selections.count("strut_54"), 0u);
}

TEST(TensegrityRim, LinksOfAStrutLieInOneLineAndHaveTheirLengths) {
  auto options = options_48m();
  options.middle_link = 0.4;
  const model::Model model = make_tensegrity_rim(options);
  const auto length = [&](int beam) {
    const auto& [a, b] = model.beams[beam].nodes;
    return (model.nodes[a] - model.nodes[b]).norm();
  };
  for (int k = 0; k < 54; ++k) {
    const auto& beams = model.selections.at("strut_" + std::to_string(k)).beams;
    ASSERT_EQ(beams.size(), 3u);
    EXPECT_NEAR(length(beams[0]), 0.3 * 7.92, 1e-13);
    EXPECT_NEAR(length(beams[1]), 0.4 * 7.92, 1e-13);
    EXPECT_NEAR(length(beams[2]), 0.3 * 7.92, 1e-13);
    for (const int beam : beams)
      for (const int node : model.beams[beam].nodes) {
        EXPECT_NEAR(model.nodes[node].x(), 24 * std::cos(k * std::numbers::pi / 27), 1e-13);
        EXPECT_NEAR(model.nodes[node].y(), 24 * std::sin(k * std::numbers::pi / 27), 1e-13);
      }
  }
}

/// By the law of cosines in plan, for rim nodes at `reach` times 360/54 degrees from the strut.
double cord_length(double reach, double height) {
  const double angle = reach * std::numbers::pi / 27;
  return std::sqrt(24 * 24 + 24.75 * 24.75 - 2 * 24 * 24.75 * std::cos(angle) + height * height);
}

TEST(TensegrityRim, CordsReachTheRimNodesOnBothSidesOfTheirStrut) {
  for (const double reach : {0.5, 1.0, 1.5, 2.0}) {
    auto options = options_48m();
    options.cord_reach = reach;
    const model::Model model = make_tensegrity_rim(options);
    for (const auto& [group, height] : {std::pair{"end_cords", 3.96}, {"knee_cords", 1.32}}) {
      std::set<std::array<int, 2>> all;
      for (const int i : model.select(group).cables) {
        const auto& cable = model.cables[i];
        EXPECT_NEAR(model.reference_length(cable), cord_length(reach, height), 1e-12) << group << reach;
        all.insert(cable.nodes);
      }
      EXPECT_EQ(all.size(), 216u);
    }
    // The two cords of an end pull it straight outwards.
    for (std::size_t i = 0; i < 216; i += 2) {
      const auto& first = model.cables[model.select("end_cords").cables[i]].nodes;
      const auto& second = model.cables[model.select("end_cords").cables[i + 1]].nodes;
      ASSERT_EQ(first[0], second[0]);
      const Vec3& end = model.nodes[first[0]];
      const Vec3 pull = model.nodes[first[1]] + model.nodes[second[1]] - 2 * end;
      EXPECT_NEAR(end.x() * pull.y() - end.y() * pull.x(), 0, 1e-11);
      EXPECT_GT(end.x() * pull.x() + end.y() * pull.y(), 0);
    }
  }
}

TEST(TensegrityRim, RimLiesInTheMiddlePlane) {
  const model::Model model = make_tensegrity_rim(options_48m());
  for (const int node : model.selections.at("rim_nodes").nodes) {
    EXPECT_EQ(model.nodes[node].z(), -0.04);
    EXPECT_NEAR(model.nodes[node].head<2>().norm(), 24.75, 1e-13);
  }
}

TEST(TensegrityRim, HeldStrutIsTheOneNearestTheAzimuth) {
  auto options = options_48m();
  options.held_strut = 92;
  const model::Model model = make_tensegrity_rim(options);
  EXPECT_EQ(model.selections.at("held_strut").beams, model.selections.at("strut_14").beams);  // 93.3 degrees
}

TEST(TensegrityRim, KneeCordsCanBeLeftOut) {
  auto options = options_48m();
  options.knee_cords = false;
  EXPECT_EQ(make_tensegrity_rim(options).find_group("knee_cords"), -1);
}

TEST(TensegrityRim, RefusesWhatIsNoRim) {
  auto options = options_48m();
  options.rim_offset = 0;
  EXPECT_NE(error_of(options).find("rim_offset = 0 m"), std::string::npos) << error_of(options);
  options = options_48m();
  options.middle_link = 1;
  EXPECT_NE(error_of(options).find("middle_link"), std::string::npos) << error_of(options);
  options = options_48m();
  options.cord_reach = 0.7;
  EXPECT_NE(error_of(options).find("cord_reach = 0.7"), std::string::npos) << error_of(options);
  options.cord_reach = 13.5;
  EXPECT_NE(error_of(options).find("a quarter of the 54 struts"), std::string::npos) << error_of(options);
  options = options_48m();
  options.rings = 0;
  EXPECT_NE(error_of(options).find("at least one ring"), std::string::npos) << error_of(options);
}

}  // namespace
}  // namespace tautline::reflector
