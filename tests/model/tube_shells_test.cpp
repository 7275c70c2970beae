#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <tautline/core/error.hpp>
#include <tautline/model/section.hpp>
#include <tautline/model/subdivide.hpp>

#include "messages.hpp"
#include "model/models.hpp"

namespace tautline::model {
namespace {

using testing_messages::mentions;

/// A tube of 2 m from (1, 0, 0) towards y, a cone behind it, and a bar that is no tube.
Model two_tubes() {
  Model model;
  model.nodes = {{1, 0, 0}, {1, 2, 0}, {1, 3, 0}, {1, 3, 1}};
  const MaterialOptions carbon{.young_modulus = 1e11, .poisson_ratio = 0.3, .density = 1600};
  const auto add = [&](const std::string& name, double first, double last, int a, int b) {
    const int group = testing_models::add_beam_group(model, name);
    model.groups[group].tube = TaperedTube{{first, last}, {0.001, 0.001}, carbon, true};
    testing_models::add_beam(model, group, a, b);
  };
  add("tube", 0.2, 0.2, 0, 1);
  add("cone", 0.2, 0.1, 1, 2);
  const int bar = testing_models::add_beam_group(model, "bar");
  testing_models::add_beam(model, bar, 2, 3);
  model.selections["all"].beams = {0, 1, 2};
  return model;
}

std::string complaint(const Model& model, const TubeShellOptions& options) {
  try {
    tubes_as_shells(model, options);
  } catch (const ModelError& error) {
    return error.what();
  }
  return "";
}

TEST(TubesAsShells, ReplaceTheBeamsOfTheirGroupsOnly) {
  const auto model = tubes_as_shells(two_tubes(), {{"tube", "cone"}, 20, 5});
  EXPECT_EQ(model.beams.size(), 1u);
  EXPECT_EQ(model.shells.size(), 2u * 20 * 5);
  EXPECT_EQ(model.nodes.size(), 4u + 2 * 20 * 6);
  EXPECT_EQ(model.links.size(), 2u * 2 * 20) << "a ring at each end of each tube";
  EXPECT_EQ(model.groups[0].kind, ElementKind::shell);
  EXPECT_EQ(model.groups[2].kind, ElementKind::beam);
  EXPECT_EQ(model.selections.at("all").beams, std::vector<int>{0});
  EXPECT_EQ(model.selections.at("all").shells.size(), model.shells.size());
}

TEST(TubesAsShells, HaveTheSecondMomentOfAreaOfTheRoundTube) {
  for (const int n : {20, 32}) {
    const auto model = tubes_as_shells(two_tubes(), {{"tube"}, n, 1});
    double moment = 0;  // of the polygon's walls at y = 0 about the axis z through the middle: t times the
                        // integral of x^2
    for (const auto& shell : model.shells) {
      const double a = model.nodes[shell.nodes[0]].x() - 1, b = model.nodes[shell.nodes[1]].x() - 1;
      const double length = (model.nodes[shell.nodes[1]] - model.nodes[shell.nodes[0]]).norm();
      moment += 0.001 * length * (a * a + a * b + b * b) / 3;
    }
    const double round = std::numbers::pi * 0.1 * 0.1 * 0.1 * 0.001;
    EXPECT_NEAR(moment, round, 1e-12 * round) << n;
  }
}

TEST(TubesAsShells, TaperWithTheSectionAndTurnTheirNormalsOutwards) {
  auto model = tubes_as_shells(two_tubes(), {{"cone"}, 20, 4});
  double least = 1, most = 0;
  for (std::size_t i = 4; i < model.nodes.size(); ++i) {
    const double radius = std::hypot(model.nodes[i].x() - 1, model.nodes[i].z());
    const double mean = 0.1 - 0.05 * (model.nodes[i].y() - 2);
    EXPECT_NEAR(radius / mean, 1.0068, 1e-4);
    least = std::min(least, radius);
    most = std::max(most, radius);
  }
  EXPECT_NEAR(most, 2 * least, 1e-12);
  find_directors(model);
  for (const auto& shell : model.shells)
    for (int k = 0; k < 4; ++k) {
      const Vec3& at = model.nodes[shell.nodes[k]];
      EXPECT_GT(shell.director[k].dot(Vec3(at.x() - 1, 0, at.z()).normalized()), 0.99);
    }
}

TEST(TubesAsShells, StayWholeWhereTheMeshIsDivided) {
  SubdivideOptions options;
  options.subdivisions = 3;
  options.tubes = {{"tube"}, 20, 5};
  const auto mesh = subdivide(two_tubes(), options);
  EXPECT_EQ(mesh.shells.size(), 20u * 5);
  EXPECT_EQ(mesh.beams.size(), 6u);
}

TEST(TubesAsShells, SayWhatIsNoThinRoundTube) {
  auto model = two_tubes();
  EXPECT_TRUE(mentions(complaint(model, {{"bar"}, 20, 5}), "\"bar\" has no section of kind tube"));
  EXPECT_TRUE(mentions(complaint(model, {{"mast"}, 20, 5}), "no group is called \"mast\""));
  EXPECT_TRUE(mentions(complaint(model, {{"tube"}, 19, 5}), "at least 20 elements around"));
  model.groups[1].tube->thickness[1] = 0.002;
  EXPECT_TRUE(
      mentions(complaint(model, {{"cone"}, 20, 5}), "the wall of \"cone\" tapers from 0.001 to 0.002 m"));
  Load wind;
  wind.name = "wind";
  wind.on = {"all"};
  wind.line_force = {1, 0, 0};
  model.loads.push_back(wind);
  EXPECT_TRUE(mentions(complaint(model, {{"tube"}, 20, 5}), "load \"wind\" is a line load on \"tube\""));
}

}  // namespace
}  // namespace tautline::model
