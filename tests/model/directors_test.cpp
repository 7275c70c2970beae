#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tautline/model/model.hpp>

namespace tautline::model {
namespace {

using std::numbers::pi;

/// A strip of cylinder about the y axis, radius 1, `parts` flat pieces over `angle`; node 2 k + j at piece k,
/// y = j.
Model cylinder(int parts, double angle) {
  Model model;
  model.groups.emplace_back().kind = ElementKind::shell;
  for (int k = 0; k <= parts; ++k)
    for (int j = 0; j < 2; ++j) {
      const double a = angle * k / parts;
      model.nodes.emplace_back(std::sin(a), j, std::cos(a));
    }
  for (int k = 0; k < parts; ++k) {
    auto& shell = model.shells.emplace_back();
    shell.nodes = {2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1};
  }
  return model;
}

Vec3 radial(double a) {
  return {std::sin(a), 0, std::cos(a)};
}

TEST(Directors, AreRadialWhereEqualPiecesOfACylinderMeet) {
  auto model = cylinder(6, pi / 2);
  find_directors(model);
  for (int k = 1; k < 6; ++k) {
    EXPECT_LT((model.shells[k].director[0] - radial(pi / 12 * k)).norm(), 1e-14);
    EXPECT_LT((model.shells[k - 1].director[1] - radial(pi / 12 * k)).norm(), 1e-14);
  }
  EXPECT_LT((model.shells[0].director[0] - radial(pi / 24)).norm(), 1e-14)
      << "a free edge has its own normal";
}

Support plane(const std::vector<int>& nodes, int normal) {
  Support support;
  support.nodes = nodes;
  support.axes.col(0) = Vec3::Unit(normal);
  support.axes.col(1) = Vec3::Unit((normal + 1) % 3);
  support.axes.col(2) = Vec3::Unit((normal + 2) % 3);
  support.fixed = {true, false, false, false, true, true};
  support.symmetry = true;
  return support;
}

TEST(Directors, LieInThePlaneOfSymmetry) {
  auto model = cylinder(6, pi / 2);
  model.supports = {plane({0, 1}, 0), plane({12, 13}, 2)};
  find_directors(model);
  EXPECT_LT((model.shells[0].director[0] - Vec3(0, 0, 1)).norm(), 1e-14);
  EXPECT_LT((model.shells[5].director[1] - Vec3(1, 0, 0)).norm(), 1e-14);
}

TEST(Directors, TakeNoSupportForASymmetryThatIsNotCalledSo) {
  auto model = cylinder(6, pi / 2);
  model.supports = {plane({0, 1}, 0)};
  model.supports[0].symmetry = false;
  find_directors(model);
  EXPECT_LT((model.shells[0].director[0] - radial(pi / 24)).norm(), 1e-14);
}

/// Directors of `part`, whose first nodes are those of `whole`, are those of the same corners of `whole`.
void expect_part_of(const Model& part, const Model& whole) {
  for (std::size_t i = 0; i < part.shells.size(); ++i)
    for (int k = 0; k < part.shells[i].nodes.size(); ++k) {
      const auto at = static_cast<std::size_t>(k);
      EXPECT_LT((part.shells[i].director[at] - whole.shells[i].director[at]).norm(), 1e-13)
          << "shell " << i << ", corner " << k;
    }
}

/// A dome of `around` x `up` quadrilaterals, `up` from the pole, with triangles at the pole, all of `around`
/// or the first `sectors` of them; node 0 is the pole, node 1 + j (around or sectors + 1) + i follows.
Model dome(int around, int up, int sectors, double slope) {
  Model model;
  model.groups.emplace_back().kind = ElementKind::shell;
  model.nodes.emplace_back(0, 0, 0);
  const bool closed = sectors == around;
  const int columns = closed ? around : sectors + 1;
  for (int j = 1; j <= up; ++j)
    for (int i = 0; i < columns; ++i) {
      const double a = 2 * pi * i / around, r = 0.1 * j;
      model.nodes.emplace_back(r * std::cos(a), r * std::sin(a), -slope * r - r * r);
    }
  const auto node = [&](int j, int i) { return 1 + (j - 1) * columns + (closed ? i % around : i); };
  for (int i = 0; i < sectors; ++i) {
    auto& shell = model.shells.emplace_back();
    shell.nodes = {0, node(1, i), node(1, i + 1)};
    for (int j = 1; j < up; ++j) {
      auto& next = model.shells.emplace_back();
      next.nodes = {node(j, i), node(j + 1, i), node(j + 1, i + 1), node(j, i + 1)};
    }
  }
  return model;
}

/// The nodes of a dome's radial line `i`, without the pole.
std::vector<int> radius_of(int columns, int up, int i) {
  std::vector<int> nodes;
  for (int j = 0; j < up; ++j) nodes.push_back(1 + j * columns + i);
  return nodes;
}

TEST(Directors, OfASectorAreThoseOfTheWhole) {
  for (const int sectors : {1, 3, 4}) {
    auto whole = dome(12, 4, 12, 0.1), part = dome(12, 4, sectors, 0.1);
    const Mat3 quarter = Eigen::AngleAxisd(2 * pi * sectors / 12, Vec3::UnitZ()).toRotationMatrix();
    for (const int node : radius_of(sectors + 1, 4, 0))
      part.cyclic_pairs.push_back({node, node + sectors, quarter});
    find_directors(whole);
    find_directors(part);
    expect_part_of(part, whole);
    EXPECT_LT((part.shells[0].director[0] - Vec3::UnitZ()).norm(), 1e-13) << "on the axis";
  }
}

TEST(Directors, OfAQuarterAreThoseOfTheWhole) {
  auto whole = dome(12, 4, 12, 0.1), part = dome(12, 4, 3, 0.1);
  auto xz = radius_of(4, 4, 0), yz = radius_of(4, 4, 3);
  xz.push_back(0);
  yz.push_back(0);
  part.supports = {plane(xz, 1), plane(yz, 0)};
  find_directors(whole);
  find_directors(part);
  expect_part_of(part, whole);
}

/// A roof of two slopes, its ridge along y in the plane x = 0.
Model roof(double angle, bool whole) {
  Model model;
  model.groups.emplace_back().kind = ElementKind::shell;
  const double drop = std::tan(angle);
  model.nodes = {{0, 0, 0}, {0, 1, 0}, {1, 0, -drop}, {1, 1, -drop}, {-1, 0, -drop}, {-1, 1, -drop}};
  model.shells.emplace_back().nodes = {0, 2, 3, 1};
  if (whole) model.shells.emplace_back().nodes = {4, 0, 1, 5};
  if (!whole) model.supports = {plane({0, 1}, 0)};
  return model;
}

/// Slopes of 9 and of 11 degrees: 18 between the facets, and 22.
TEST(Directors, FoldAtTheSameAngleInTheHalf) {
  for (const double degrees : {5.0, 9.0, 11.0, 19.0, 60.0, 85.0}) {
    auto half = roof(degrees * pi / 180, false), whole = roof(degrees * pi / 180, true);
    find_directors(half);
    find_directors(whole);
    expect_part_of(half, whole);
    const double bend = std::acos(std::min(1.0, whole.shells[0].director[0].z()));
    EXPECT_NEAR(bend, degrees < 10 ? 0 : degrees * pi / 180, 1e-7) << degrees;
  }
}

/// Neither the order of shells, nor where and in which sense their nodes begin, nor how they are grouped.
TEST(Directors, DoNotDependOnTheOrder) {
  auto model = dome(12, 4, 12, 0.1), other = model;
  other.groups.push_back(other.groups.front());
  std::reverse(other.shells.begin(), other.shells.end());
  for (std::size_t i = 0; i < other.shells.size(); ++i) {
    auto& shell = other.shells[i];
    const auto& n = shell.nodes;
    if (i % 3 == 0) shell.group = 1;
    if (i % 2 == 0) continue;
    shell.nodes = n.size() == 3 ? FacetNodes(n[1], n[0], n[2]) : FacetNodes(n[1], n[0], n[3], n[2]);
  }
  find_directors(model);
  find_directors(other);
  for (std::size_t i = 0; i < other.shells.size(); ++i) {
    const auto& a = other.shells[i];
    const auto& b = model.shells[model.shells.size() - 1 - i];
    for (int k = 0; k < a.nodes.size(); ++k)
      for (int j = 0; j < b.nodes.size(); ++j)
        if (a.nodes[k] == b.nodes[j]) {
          const Vec3 &d = a.director[static_cast<std::size_t>(k)],
                     &e = b.director[static_cast<std::size_t>(j)];
          EXPECT_LT((d - (i % 2 == 0 ? 1 : -1) * e).norm(), 1e-14) << "shell " << i;
        }
  }
}

/// Three facets on one side, two of them in a plane, the third across or nearly back on one of them.
TEST(Directors, GoOnPastAWeb) {
  for (const double angle : {pi / 2, 0.05, 0.3}) {
    Model model;
    model.groups.emplace_back().kind = ElementKind::shell;
    model.nodes = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, 1, 0}};
    model.nodes.emplace_back(std::cos(angle), 0, std::sin(angle));
    model.nodes.emplace_back(std::cos(angle), 1, std::sin(angle));
    model.shells.emplace_back().nodes = {0, 2, 3, 1};
    model.shells.emplace_back().nodes = {4, 0, 1, 5};
    if (angle > 1) {
      model.shells.emplace_back().nodes = {0, 6, 7, 1};
      find_directors(model);
      EXPECT_LT((model.shells[0].director[0] - Vec3::UnitZ()).norm(), 1e-14);
      EXPECT_LT((model.shells[1].director[1] - Vec3::UnitZ()).norm(), 1e-14);
      EXPECT_LT((model.shells[2].director[0] + Vec3::UnitX()).norm(), 1e-14);
    } else {  // a sharp edge: facets 0 and 1 lie on each other but for the angle
      model.shells[1].nodes = {0, 6, 7, 1};
      find_directors(model);
      EXPECT_LT((model.shells[0].director[0] - Vec3::UnitZ()).norm(), 1e-14) << angle;
    }
  }
}

TEST(Directors, StayWithEachPieceAtAKink) {
  auto model = cylinder(3, pi / 2);  // pieces at 30 degrees
  find_directors(model);
  for (int k = 0; k < 3; ++k)
    for (const int corner : {0, 1})
      EXPECT_LT((model.shells[k].director[corner] - radial(pi / 12 + pi / 6 * k)).norm(), 1e-14);
}

}  // namespace
}  // namespace tautline::model
