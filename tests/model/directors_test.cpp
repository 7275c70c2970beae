#include <gtest/gtest.h>

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

TEST(Directors, LieInThePlaneOfSymmetry) {
  auto model = cylinder(6, pi / 2);
  auto& crown = model.supports.emplace_back();
  crown.nodes = {0, 1};
  crown.fixed = {true, false, false, false, true, true};
  auto& foot = model.supports.emplace_back();
  foot.nodes = {12, 13};
  foot.fixed = {false, false, true, true, true, false};
  find_directors(model);
  EXPECT_LT((model.shells[0].director[0] - Vec3(0, 0, 1)).norm(), 1e-14);
  EXPECT_LT((model.shells[5].director[1] - Vec3(1, 0, 0)).norm(), 1e-14);
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
