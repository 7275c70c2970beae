#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <reflector/rim_net.hpp>
#include <set>
#include <tautline/core/error.hpp>

namespace tautline::reflector {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::string error_of(const PerimeterTrussOptions& options) {
  try {
    make_perimeter_truss(options);
  } catch (const ModelError& error) {
    return error.what();
  }
  return "no error";
}

TEST(PerimeterTruss, NetAndClothHaveTheTopologyOfTheRimReflector) {
  const model::Model model = make_perimeter_truss(rim_options());
  std::vector<std::array<int, 3>> facets;
  for (const auto& membrane : model.membranes) facets.push_back(membrane.nodes.triangles().front());
  EXPECT_EQ(as_sets(cables_of(model, "front_net")), table("rim_net_edges.csv"));
  EXPECT_EQ(as_sets(facets), table("rim_net_facets.csv"));
}

TEST(PerimeterTruss, RimNodesArePrintedOnes) {
  const model::Model model = make_perimeter_truss(rim_options());
  const auto printed = read_table("belov_appendix_b.csv");
  for (int i = 271; i < 331; ++i)  // 5 mm is half a unit of the last printed decimal
    EXPECT_LE((model.nodes[i] - Vec3(printed[i][1], printed[i][2], printed[i][3])).cwiseAbs().maxCoeff(),
              0.0051);
}

TEST(PerimeterTruss, HasThePartsCounted) {
  const model::Model model = make_perimeter_truss(rim_options());
  EXPECT_EQ(model.nodes.size(), 662u);
  EXPECT_EQ(cables_of(model, "rear_net").size(), 870u);
  EXPECT_EQ(cables_of(model, "ties").size(), 271u);
  EXPECT_EQ(cables_of(model, "diagonals").size(), 60u);
  EXPECT_EQ(beams_of(model, "front_rim").size(), 60u);
  EXPECT_EQ(beams_of(model, "rear_rim").size(), 60u);
  EXPECT_EQ(beams_of(model, "struts").size(), 30u);
  EXPECT_EQ(model.membranes.size(), 600u);
  EXPECT_EQ(model.selections.at("front_net_nodes").nodes.size(), 271u);
  EXPECT_EQ(model.selections.at("rear_net_nodes").nodes.size(), 271u);
  EXPECT_EQ(model.selections.at("front_rim_nodes").nodes.size(), 60u);
  EXPECT_EQ(model.selections.at("rear_rim_nodes").nodes.size(), 60u);
  EXPECT_EQ(model.selections.count("strut_29"), 1u);
  EXPECT_EQ(model.selections.count("strut_30"), 0u);
}

TEST(PerimeterTruss, RearNetIsTheMirrorOfTheFront) {
  const model::Model model = make_perimeter_truss(rim_options());
  for (int i = 0; i < 331; ++i) {
    const Vec3 &front = model.nodes[i], &rear = model.nodes[i + 331];
    EXPECT_EQ(rear, Vec3(front.x(), front.y(), -front.z() - 0.02));
  }
  const auto front = cables_of(model, "front_net"), rear = cables_of(model, "rear_net"),
             ties = cables_of(model, "ties");
  for (std::size_t c = 0; c < front.size(); ++c)
    EXPECT_EQ(rear[c], (std::array<int, 2>{front[c][0] + 331, front[c][1] + 331}));
  for (int t = 0; t < 271; ++t) EXPECT_EQ(ties[t], (std::array<int, 2>{t, t + 331}));
}

TEST(PerimeterTruss, FreeNodesStartOnTheSurfaceAndRimsLieFlat) {
  const model::Model model = make_perimeter_truss(rim_options());
  const Paraboloid surface = make_paraboloid(rim_options());
  for (const int i : model.selections.at("front_net_nodes").nodes)
    EXPECT_NEAR(model.nodes[i].z(), surface.height(model.nodes[i].x(), model.nodes[i].y()), 1e-14);
  for (const int i : model.selections.at("front_rim_nodes").nodes) {
    EXPECT_EQ(model.nodes[i].z(), 0.98);
    EXPECT_NEAR(model.nodes[i].head<2>().norm(), 6, 1e-14);
  }
}

TEST(PerimeterTruss, EveryFacetLooksUp) {
  const model::Model model = make_perimeter_truss(rim_options());
  for (const auto& membrane : model.membranes) {
    const Vec3 &a = model.nodes[membrane.nodes[0]], &b = model.nodes[membrane.nodes[1]],
               &c = model.nodes[membrane.nodes[2]];
    EXPECT_GT((b - a).cross(c - a).normalized().z(), 0.5);
  }
}

TEST(PerimeterTruss, FrameIsClosedAndBraced) {
  const model::Model model = make_perimeter_truss(rim_options());
  std::map<int, int> touched;
  for (const std::string group : {"front_rim", "rear_rim"})
    for (const auto& nodes : beams_of(model, group))
      for (const int node : nodes) ++touched[node];
  EXPECT_EQ(touched.size(), 120u);
  for (const auto& [node, count] : touched) EXPECT_EQ(count, 2) << node;
  for (const auto& [front, rear] : beams_of(model, "struts")) {
    EXPECT_EQ(rear, front + 331);
    EXPECT_EQ((front - 271) % 2, 0);
  }
  for (const auto& [front, rear] : cables_of(model, "diagonals")) {
    const int bay = std::abs(front - (rear - 331));
    EXPECT_TRUE(bay == 2 || bay == 58) << front << " " << rear;  // one strut further, also across +x
  }
  EXPECT_EQ(as_sets(cables_of(model, "diagonals")).size(), 60u);
}

TEST(PerimeterTruss, HeldStrutIsTheOneNearestTheAzimuth) {
  for (const auto& [azimuth, x, y] :
       {std::array{180.0, -6.0, 0.0}, {0.0, 6.0, 0.0}, {-270.0, 0.0, 6.0}, {92.0, 0.0, 6.0}}) {
    PerimeterTrussOptions options = rim_options();
    options.struts = 20;
    options.held_strut = azimuth;
    const model::Model model = make_perimeter_truss(options);
    const auto& held = model.selections.at("held_strut").beams;
    ASSERT_EQ(held.size(), 1u);
    const Vec3& node = model.nodes[model.beams[held[0]].nodes[0]];
    EXPECT_NEAR(node.x(), x, 1e-12) << azimuth;
    EXPECT_NEAR(node.y(), y, 1e-12) << azimuth;
  }
}

TEST(PerimeterTruss, GroupsKnowTheirKind) {
  const model::Model model = make_perimeter_truss(rim_options());
  for (const auto& group : model.groups) {
    const bool rim = group.name == "front_rim" || group.name == "rear_rim";
    if (rim) {
      EXPECT_EQ(group.orientation, Vec3::UnitZ());
    }
    const auto kind = group.name == "cloth"           ? model::ElementKind::membrane
                      : rim || group.name == "struts" ? model::ElementKind::beam
                                                      : model::ElementKind::cable;
    EXPECT_EQ(group.kind, kind) << group.name;
  }
}

TEST(PerimeterTruss, AnyDishAndAnyRingsCanBeBuilt) {
  // Counts of the hexagonal lattice: 1 + 3n(n+1) nodes, 6 n^2 facets, 9 n^2 + 3n sides less 6n along the rim.
  for (const int n : {1, 2, 3, 7, 16}) {
    for (const double clearance : {nan, 0.0, 3.0}) {
      PerimeterTrussOptions options;
      options.aperture = 5;
      options.focal_length = 1.5;
      options.clearance = clearance;
      options.rings = n;
      options.gap = 0.1;
      const model::Model model = make_perimeter_truss(options);
      EXPECT_EQ(model.nodes.size(), 2u * (1 + 3 * n * (n + 1)));
      EXPECT_EQ(model.membranes.size(), 6u * n * n);
      EXPECT_EQ(cables_of(model, "front_net").size(), static_cast<std::size_t>(9 * n * n - 3 * n));
      EXPECT_EQ(beams_of(model, "struts").size(), 3u * n);
    }
  }
}

TEST(PerimeterTruss, RimOfAnAxisymmetricDishLiesOnIt) {
  PerimeterTrussOptions options;
  options.aperture = 12;
  options.focal_length = 6;
  options.rings = 4;
  options.gap = 0.1;
  const model::Model model = make_perimeter_truss(options);
  for (const int i : model.selections.at("front_rim_nodes").nodes)
    EXPECT_NEAR(model.nodes[i].z(), 36.0 / 24, 1e-14);
}

TEST(PerimeterTruss, DiagonalsCanBeLeftOut) {
  PerimeterTrussOptions options = rim_options();
  options.diagonals = false;
  const model::Model model = make_perimeter_truss(options);
  for (const auto& group : model.groups) EXPECT_NE(group.name, "diagonals");
}

TEST(PerimeterTruss, ParametersThatMakeNoDishAreExplained) {
  const auto changed = [](auto member, auto value) {
    PerimeterTrussOptions options = rim_options();
    options.*member = value;
    return error_of(options);
  };
  using Options = PerimeterTrussOptions;
  EXPECT_EQ(changed(&Options::aperture, 0.0), "the aperture must be positive, not 0 m");
  EXPECT_EQ(changed(&Options::focal_length, -8.0), "the focal length must be positive, not -8 m");
  EXPECT_NE(changed(&Options::clearance, -7.0).find("the clearance must be at least"), std::string::npos);
  EXPECT_EQ(changed(&Options::rings, 0), "the net needs at least one ring, not 0");
  EXPECT_NE(changed(&Options::gap, -0.1).find("must not be negative, not -0.1 m"), std::string::npos);
  EXPECT_EQ(
      changed(&Options::struts, 7),
      "7 struts cannot be spread evenly over the 60 nodes of the rim (6 for each of 10 rings); possible: "
      "3, 4, 5, 6, 10, 12, 15, 20, 30, 60");
  EXPECT_NE(changed(&Options::rim_height, -0.5).find("distance between the rims"), std::string::npos);
}

TEST(PerimeterTruss, TieWithoutLengthIsNamed) {
  PerimeterTrussOptions options;  // the vertex of an axisymmetric dish lies in the plane of symmetry
  options.aperture = 12;
  options.focal_length = 6;
  options.rings = 4;
  EXPECT_EQ(
      error_of(options),
      "front and rear net touch or cross: the tie at x = 0 m, y = 0 m would be 0 m long; give a larger gap "
      "(rim height 1.5 m, gap 0 m)");
}

}  // namespace
}  // namespace tautline::reflector
