#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <set>
#include <type_traits>
#include <tautline/core/error.hpp>
#include <tautline/model/section.hpp>
#include <tautline/model/subdivide.hpp>

#include "messages.hpp"
#include "model/models.hpp"

namespace tautline::model {
namespace {

using namespace testing_models;
using testing_messages::mentions;
using testing_messages::message_of;

SubdivideOptions parts(int subdivisions, FacetPattern pattern = FacetPattern::structured) {
  return {subdivisions, pattern, {}, {}};
}

/// The cloth of two_facets() alone.
Model two_bare_facets() {
  auto model = two_facets();
  model.nodes.resize(4);
  model.cables.clear();
  model.beams.clear();
  model.selections.clear();
  model.supports.clear();
  return model;
}

Vec3 directed_area(const Model& model, const Membrane& m) {
  const int a = m.nodes[0], b = m.nodes[1], c = m.nodes[2];
  return 0.5 * (model.nodes[b] - model.nodes[a]).cross(model.nodes[c] - model.nodes[a]);
}

std::set<std::pair<int, int>> sides(const Model& model) {
  std::set<std::pair<int, int>> result;
  for (const auto& m : model.membranes)
    for (int k = 0; k < 3; ++k) result.insert(std::minmax(m.nodes[k], m.nodes[(k + 1) % 3]));
  return result;
}

/// The prestress as a tensor in space.
Mat3 prestress_tensor(const Model& model, const Membrane& m) {
  Mat3 x_ref;
  x_ref << model.nodes[m.nodes[0]], model.nodes[m.nodes[1]], model.nodes[m.nodes[2]];
  const Mat<3, 2> axes = element::membrane_frame(x_ref).leftCols<2>();
  Eigen::Matrix2d local;
  local << m.prestress[0], m.prestress[2], m.prestress[2], m.prestress[1];
  return axes * local * axes.transpose();
}

double smallest_distance(const Points& points) {
  double smallest = 1e300;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) smallest = std::min(smallest, (points[i] - points[j]).norm());
  return smallest;
}

/// Area of each facet kept by its parts, each part facing the same way, no two nodes in one place, Euler's
/// count right.
void expect_sound_cloth(const Model& structure, const Model& mesh) {
  std::vector<Vec3> area(structure.membranes.size(), Vec3::Zero());
  for (const auto& m : mesh.membranes) {
    const Vec3 own = directed_area(mesh, m), whole = directed_area(structure, structure.membranes[m.parent]);
    EXPECT_GT(own.dot(whole), 0);
    area[m.parent] += own;
  }
  for (std::size_t i = 0; i < area.size(); ++i)
    EXPECT_LT((area[i] - directed_area(structure, structure.membranes[i])).norm(), 1e-14);
  EXPECT_GT(smallest_distance(mesh.nodes), 1e-3);
  const int v = static_cast<int>(mesh.nodes.size()), e = static_cast<int>(sides(mesh).size()),
            f = static_cast<int>(mesh.membranes.size());
  EXPECT_EQ(v - e + f, 1) << "one connected sheet without holes";
}

class StructuredPattern : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Parts, StructuredPattern, ::testing::Values(1, 2, 3, 4));

TEST_P(StructuredPattern, MakesSSquaredTrianglesThatShareTheNodesOfTheirSides) {
  const int s = GetParam();
  const auto structure = two_bare_facets(), mesh = subdivide(structure, parts(s));
  EXPECT_EQ(static_cast<int>(mesh.membranes.size()), 2 * s * s);
  EXPECT_EQ(static_cast<int>(mesh.nodes.size()), 2 * (s + 1) * (s + 2) / 2 - (s + 1));
  expect_sound_cloth(structure, mesh);
}

TEST_P(StructuredPattern, MakesSimilarTriangles) {
  const int s = GetParam();
  const auto structure = two_bare_facets(), mesh = subdivide(structure, parts(s));
  for (const auto& m : mesh.membranes)
    EXPECT_NEAR(directed_area(mesh, m).norm() * s * s,
                directed_area(structure, structure.membranes[m.parent]).norm(), 1e-14);
}

class MappedPattern : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Parts, MappedPattern, ::testing::Values(2, 4, 6));

TEST_P(MappedPattern, FillsEachFacetWithThreePatchesThatShareTheirNodes) {
  const int s = GetParam(), h = s / 2;
  const auto structure = two_bare_facets(), mesh = subdivide(structure, parts(s, FacetPattern::mapped));
  EXPECT_EQ(static_cast<int>(mesh.membranes.size()), 2 * 6 * h * h);
  const int rim = 3 * s, spokes = 3 * (h - 1), patches = 3 * (h - 1) * (h - 1);
  EXPECT_EQ(static_cast<int>(mesh.nodes.size()), 2 * (rim + spokes + patches + 1) - (s + 1));
  expect_sound_cloth(structure, mesh);
}

TEST(MappedPattern, WithoutSubdivisionIsTheFacetItself) {
  EXPECT_THROW(subdivide(two_facets(), parts(1, FacetPattern::mapped)), ModelError) << "1 is odd";
}

class EitherPattern : public ::testing::TestWithParam<FacetPattern> {};
INSTANTIATE_TEST_SUITE_P(Patterns, EitherPattern,
                         ::testing::Values(FacetPattern::structured, FacetPattern::mapped));

TEST_P(EitherPattern, KeepsTheTensorOfAnAnisotropicPrestress) {
  const auto structure = two_facets(), mesh = subdivide(structure, parts(4, GetParam()));
  for (const auto& m : mesh.membranes)
    EXPECT_LT((prestress_tensor(mesh, m) - prestress_tensor(structure, structure.membranes[m.parent])).norm(),
              1e-12 * 400);
}

TEST_P(EitherPattern, SplitsCablesOnFacetSidesAtTheNodesOfTheCloth) {
  const auto mesh = subdivide(two_facets(), parts(4, GetParam()));
  const auto cloth = sides(mesh);
  int ridge = 0;
  for (const auto& cable : mesh.cables)
    if (cable.parent == 0) {
      ++ridge;
      EXPECT_TRUE(cloth.contains(std::minmax(cable.nodes[0], cable.nodes[1])));
    }
  EXPECT_EQ(ridge, 4);
}

TEST(Subdivision, LeavesCablesThatAreNoFacetSideWhole) {
  const auto mesh = subdivide(two_facets(), parts(4));
  const auto ties = mesh.select("tie").cables;
  ASSERT_EQ(ties.size(), 1u);
  EXPECT_EQ(mesh.cables[ties[0]].nodes, (std::array<int, 2>{0, 3}));
}

TEST(Subdivision, SplitsBeamsOnFacetSidesAndElsewhere) {
  const auto structure = two_facets(), mesh = subdivide(structure, parts(3));
  EXPECT_EQ(mesh.select("strut").beams.size(), 3u);
  EXPECT_EQ(mesh.select("mast").beams.size(), 3u);
  const auto cloth = sides(mesh);
  for (const int i : mesh.select("strut").beams)
    EXPECT_TRUE(cloth.contains(std::minmax(mesh.beams[i].nodes[0], mesh.beams[i].nodes[1])));
  for (const auto& beam : mesh.beams) EXPECT_EQ(beam.frame, structure.beams[beam.parent].frame);
}

TEST(Subdivision, RunsThePartsOfALineFromItsFirstEndToItsSecond) {
  const auto mesh = subdivide(two_facets(), parts(3));
  for (const auto& [name, first, last] : {std::tuple{"strut", 2, 3}, std::tuple{"mast", 0, 4}}) {
    int at = first;
    for (const int i : mesh.select(name).beams) {
      EXPECT_EQ(mesh.beams[i].nodes[0], at);
      at = mesh.beams[i].nodes[1];
    }
    EXPECT_EQ(at, last);
  }
}

TEST(Subdivision, FollowsOverridesOfGroups) {
  auto options = parts(2);
  options.group_subdivisions = {{"tie", 5}, {"mast", 1}};
  const auto mesh = subdivide(two_facets(), options);
  EXPECT_EQ(mesh.select("tie").cables.size(), 5u);
  EXPECT_EQ(mesh.select("mast").beams.size(), 1u);
  EXPECT_EQ(mesh.select("ridge").cables.size(), 2u);
}

TEST(Subdivision, RefusesAnOverrideThatWouldTearALineFromTheCloth) {
  auto options = parts(2);
  options.group_subdivisions = {{"ridge", 3}};
  const auto message = message_of<ModelError>([&] { subdivide(two_facets(), options); });
  EXPECT_TRUE(mentions(message, "group \"ridge\" lies on facet sides and must have their 2 parts, not 3"));
  options.group_subdivisions = {{"ridge", 2}};
  EXPECT_NO_THROW(subdivide(two_facets(), options));
}

TEST(Subdivision, RefusesWhatCannotBe) {
  EXPECT_TRUE(mentions(message_of<ModelError>([] { subdivide(two_facets(), parts(0)); }), "1 or more, is 0"));
  EXPECT_TRUE(
      mentions(message_of<ModelError>([] { subdivide(two_facets(), parts(3, FacetPattern::mapped)); }),
               "even number of subdivisions, not 3"));
  const auto with = [](const std::string& group, int n) {
    auto options = parts(2);
    options.group_subdivisions[group] = n;
    return message_of<ModelError>([&] { subdivide(two_facets(), options); });
  };
  EXPECT_TRUE(mentions(with("tiee", 2), "no group is called \"tiee\""));
  EXPECT_TRUE(mentions(with("cloth", 2), "\"cloth\" is made of neither cables nor beams"));
  EXPECT_TRUE(mentions(with("tie", 0), "\"tie\" needs 1 or more parts"));
}

TEST(Subdivision, SharesTheUnstressedLengthOfACableOutEqually) {
  auto options = parts(4);
  options.group_subdivisions["tie"] = 7;
  const auto structure = two_facets(), mesh = subdivide(structure, options);
  std::vector<double> sum(structure.cables.size(), 0.0);
  std::vector<int> count(structure.cables.size(), 0);
  for (const auto& cable : mesh.cables) {
    sum[cable.parent] += mesh.unstressed_length(cable);
    ++count[cable.parent];
  }
  for (const auto& cable : mesh.cables)
    EXPECT_NEAR(mesh.unstressed_length(cable) * count[cable.parent] / sum[cable.parent], 1, 2e-15);
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const double whole = structure.unstressed_length(structure.cables[i]);
    EXPECT_NEAR(sum[i], whole, 1e-15 * whole) << "a few roundings of the nodes' coordinates";
  }
}

TEST(Subdivision, LeavesTheMassAsItIs) {
  const auto structure = two_facets(), mesh = subdivide(structure, parts(4, FacetPattern::mapped));
  for (const auto& [name, mass] : mass_by_group(structure))
    EXPECT_NEAR(mass_by_group(mesh).at(name), mass, 1e-14 * mass);
}

TEST(Subdivision, KeepsTheNodesOfTheStructureInTheirPlaces) {
  const auto structure = two_facets(), mesh = subdivide(structure, parts(4));
  for (std::size_t i = 0; i < structure.nodes.size(); ++i) EXPECT_EQ(mesh.nodes[i], structure.nodes[i]);
}

TEST(Subdivision, LetsSelectionsFollowTheirElements) {
  const auto mesh = subdivide(two_facets(), parts(2));
  const auto everything = mesh.select("everything");
  EXPECT_EQ(everything.membranes.size(), mesh.membranes.size());
  EXPECT_EQ(everything.cables.size(), mesh.cables.size());
  EXPECT_EQ(everything.beams.size(), mesh.beams.size());
  EXPECT_EQ(mesh.select("anchors").nodes, (std::vector<int>{3, 4}));
}

TEST(Subdivision, LetsSupportsFollowTheElementsTheyAreOn) {
  auto structure = two_facets();
  structure.supports.push_back({"rail", {"ridge"}, {1, 2}, {true, true, true, false, false, false}});
  const auto mesh = subdivide(structure, parts(4));
  EXPECT_EQ(mesh.supports[0].nodes, (std::vector<int>{3, 4}));
  EXPECT_EQ(mesh.supports[1].nodes, mesh.select("ridge").nodes);
  EXPECT_EQ(mesh.supports[1].nodes.size(), 5u);
}

/// One warped quadrilateral: corners alternately 0 and `rise` high, 2 m apart, turned by `turn`.
template <class Facets>
Model warped(Facets Model::*facets, double rise, const std::array<double, 2>& prestress, const Mat3& turn) {
  Model model;
  model.nodes = {turn * Vec3(0, 0, 0), turn * Vec3(2, 0, rise), turn * Vec3(2, 2, 0),
                 turn * Vec3(0, 2, rise)};
  auto& group = model.groups.emplace_back();
  group.name = "facet";
  group.kind = std::is_same_v<Facets, std::vector<Shell>> ? ElementKind::shell : ElementKind::membrane;
  group.orientation = turn * Vec3(2, 1, 0);
  (model.*facets).emplace_back().nodes = FacetNodes(0, 1, 2, 3);
  GroupOptions options;
  options.prestress = prestress;
  set_initial_state(model, 0, options);
  return model;
}

template <class Facets>
void expect_prestress_as_asked(Facets Model::*facets) {
  const std::array<double, 2> asked{3000, 2000};
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  for (const double rise : {0.0, 1.0, 3.0})
    for (const int n : {1, 2, 5}) {
      const auto structure = warped(facets, rise, asked, turn);
      const auto mesh = subdivide(structure, parts(n));
      for (const auto& facet : mesh.*facets) {
        Mat<3, 4> x;
        for (int k = 0; k < 4; ++k) x.col(k) = mesh.nodes[facet.nodes[k]];
        const Mat3 frame = element::membrane_frame<4>(x);
        const Vec3 wish = turn * Vec3(2, 1, 0);
        const Vec3 axis = (wish - wish.dot(frame.col(2)) * frame.col(2)).normalized();
        const Vec<2> local = frame.leftCols<2>().transpose() * axis;
        Mat<2> tensor;
        tensor << facet.prestress[0], facet.prestress[2], facet.prestress[2], facet.prestress[1];
        EXPECT_LT((tensor * local - 3000 * local).norm(), 1e-9) << rise << " " << n;
        EXPECT_NEAR(tensor.trace(), 5000, 1e-9);
      }
    }
}

TEST(Subdivision, PrestressOfAWarpedMembraneStaysWhatWasAskedFor) {
  expect_prestress_as_asked(&Model::membranes);
}

TEST(Subdivision, PrestressOfAWarpedShellStaysWhatWasAskedFor) {
  expect_prestress_as_asked(&Model::shells);
}

TEST(Subdivision, WithoutAProjectionPrestressTurnsWithTheNormal) {
  // The orientation stands on the facet; a tensor of its own, as form-finding leaves it.
  auto structure = warped(&Model::membranes, 0.5, {1, 1}, Mat3::Identity());
  structure.groups[0].orientation = Vec3::UnitZ();
  structure.membranes[0].prestress = Vec3(3, 1, 0.5);
  const Eigen::Vector2d whole(2 + std::sqrt(1.25), 2 - std::sqrt(1.25));
  for (const auto& m : subdivide(structure, parts(3)).membranes) {
    const double mean = (m.prestress[0] + m.prestress[1]) / 2,
                 radius = std::hypot((m.prestress[0] - m.prestress[1]) / 2, m.prestress[2]);
    EXPECT_NEAR(mean + radius, whole[0], 1e-12);
    EXPECT_NEAR(mean - radius, whole[1], 1e-12);
  }
}

TEST(Subdivision, LeavesASupportOnExplicitNodesWhereItIs) {
  auto structure = two_facets();
  structure.supports[0].on.clear();
  const auto mesh = subdivide(structure, parts(4));
  EXPECT_EQ(mesh.supports[0].nodes, (std::vector<int>{3, 4}));
}

TEST(Subdivision, LeavesLoadsOnTheNodesOfTheStructure) {
  auto structure = two_facets();
  structure.loads.emplace_back().nodes = {1, 2};
  EXPECT_EQ(subdivide(structure, parts(4)).loads[0].nodes, (std::vector<int>{1, 2}));
}

TEST(Subdivision, IntoOnePartIsTheStructureItself) {
  const auto structure = two_facets(), mesh = subdivide(structure, parts(1));
  EXPECT_EQ(mesh.nodes.size(), structure.nodes.size());
  for (std::size_t i = 0; i < structure.membranes.size(); ++i) {
    EXPECT_EQ(mesh.membranes[i].nodes, structure.membranes[i].nodes);
    EXPECT_LT((mesh.membranes[i].prestress - structure.membranes[i].prestress).norm(), 1e-12);
  }
}

TEST(Subdivision, BendsBeamsOfAnInitialMotionAsACantilever) {
  // v = d (3 t^2 - t^3)/2 along the beam, slope d (6 t - 3 t^2)/(2 L): a cubic, so that the parts lie on it
  // up to the square of the slope.
  Model structure;
  structure.nodes = {{1, 0, 0}, {1, 2, 0}};
  const double L = 2, d = 1e-5;
  add_beam(structure, add_beam_group(structure, "cantilever"), 0, 1);
  structure.initial.displacement = {Vec3::Zero(), Vec3(0, 0, d)};
  structure.initial.rotation = {Mat3::Identity(),
                                Eigen::AngleAxisd(1.5 * d / L, Vec3::UnitX()).toRotationMatrix()};
  const auto mesh = subdivide(structure, parts(4));
  ASSERT_EQ(mesh.initial.displacement.size(), 5u);
  for (int node = 0; node < 5; ++node) {
    const double t = mesh.nodes[node].y() / L;
    EXPECT_NEAR(mesh.initial.displacement[node].z(), d * (3 * t * t - t * t * t) / 2, 1e-14);
    EXPECT_NEAR(mesh.initial.rotation[node](2, 1), d * (6 * t - 3 * t * t) / (2 * L), 1e-14);
  }
}

TEST(Subdivision, CarriesAnInitialMotionOverFacetsLinearly) {
  auto structure = two_facets();
  structure.beams.clear();
  structure.selections.clear();
  structure.supports.clear();
  const auto field = [](const Vec3& x) {
    return Vec3(0.01 * x.x(), 0.02 * x.y() - 0.01, 0.03 * x.x() + 0.01 * x.z());
  };
  for (const auto& node : structure.nodes) structure.initial.displacement.push_back(field(node));
  structure.initial.rotation.assign(structure.nodes.size(), Mat3::Identity());
  const auto mesh = subdivide(structure, parts(4, FacetPattern::mapped));
  ASSERT_EQ(mesh.initial.displacement.size(), mesh.nodes.size());
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    EXPECT_LT((mesh.initial.displacement[i] - field(mesh.nodes[i])).norm(), 1e-15) << i;
}

TEST(Subdivide, DividesSlackCablesThatLieOnNoFacet) {
  auto structure = two_facets();
  structure.cables[1].initial_strain = -0.05;
  const double whole = structure.unstressed_length(structure.cables[1]);
  const auto mesh = subdivide(structure, parts(4));
  const auto ties = mesh.select("tie").cables;
  ASSERT_EQ(ties.size(), 4u);
  for (const int i : ties)
    EXPECT_NEAR(mesh.unstressed_length(mesh.cables[static_cast<std::size_t>(i)]), whole / 4, 1e-14);
  EXPECT_EQ(mesh.cables[static_cast<std::size_t>(ties[0])].nodes[0], 0);
  EXPECT_EQ(mesh.cables[static_cast<std::size_t>(ties[3])].nodes[1], 3);
  SubdivideOptions two = parts(4);
  two.group_subdivisions["tie"] = 2;
  EXPECT_EQ(subdivide(structure, two).select("tie").cables.size(), 2u);
}

TEST(Subdivide, ASlackCableBesideABeamIsNotTiedToIt) {
  auto structure = two_facets();
  add_cable(structure, structure.find_group("tie"), 0, 4, -0.1);
  const auto mesh = subdivide(structure, parts(3));
  std::set<int> of_cable, of_beam;
  for (const auto& cable : mesh.cables)
    if (cable.parent == 2) of_cable.insert(cable.nodes.begin(), cable.nodes.end());
  for (const auto& beam : mesh.beams)
    if (beam.parent == 1) of_beam.insert(beam.nodes.begin(), beam.nodes.end());
  EXPECT_EQ(of_cable.size(), 4u);
  std::vector<int> both;
  std::set_intersection(of_cable.begin(), of_cable.end(), of_beam.begin(), of_beam.end(),
                        std::back_inserter(both));
  EXPECT_EQ(both, (std::vector<int>{0, 4}));
}

TEST(Subdivide, DividesEveryCableWhereThereAreButCables) {
  Model net;
  net.nodes = {{0, 0, 0}, {1, 0, 0}, {2, 1, 0}};
  const int group = add_cable_group(net, "net");
  add_cable(net, group, 0, 1, 1e-3);
  add_cable(net, group, 1, 2, 1e-3);
  const auto mesh = subdivide(net, parts(3));
  EXPECT_EQ(mesh.cables.size(), 6u);
  EXPECT_EQ(mesh.nodes.size(), 7u);
}

}  // namespace
}  // namespace tautline::model
