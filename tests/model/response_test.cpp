#include <cmath>
#include <tautline/model/beam_ends.hpp>
#include <tautline/model/response.hpp>

#include "model/models.hpp"

namespace tautline::model {
namespace {

using namespace testing_models;

/// Three cables of 1 m side by side along x, E A = 1000 N, tensions 30 and 10 N and one slack.
Model three_cables() {
  Model model;
  for (int i = 0; i < 3; ++i) {
    model.nodes.emplace_back(0, i, 0);
    model.nodes.emplace_back(1, i, 0);
  }
  const int cord = add_cable_group(model, "cord", 1000);
  model.groups[cord].target_tension = 20;
  add_cable(model, cord, 0, 1, 0.03);
  add_cable(model, cord, 2, 3, 0.01);
  add_cable(model, cord, 4, 5, -0.5);
  return model;
}

GroupSummary summary_at_rest(const Model& model, const std::string& group) {
  const auto state = State::reference(model);
  return summarise_groups(model, state, evaluate_response(model, state)).at(group);
}

TEST(Response, HasTheTensionAndTheLengthOfEveryCable) {
  const auto model = three_cables();
  auto state = State::reference(model);
  state.displacement[1] = {0.03, 0, 0};  // L0 = 1 / 1.03: the strain grows by 0.03 * 1.03
  const auto response = evaluate_response(model, state);
  EXPECT_DOUBLE_EQ(response.cables[0].length, 1.03);
  EXPECT_NEAR(response.cables[0].tension, 1000 * (0.03 + 0.03 * 1.03), 1e-11);
  EXPECT_NEAR(response.cables[1].tension, 10, 1e-12);
  EXPECT_TRUE(response.cables[2].slack);
  EXPECT_EQ(response.cables[2].tension, 0);
}

TEST(GroupSummary, HasTheSpreadOfTensionsAndTheirDistanceFromTheTarget) {
  const auto model = three_cables();
  const auto summary = summary_at_rest(model, "cord");
  EXPECT_EQ(summary.count, 3);
  EXPECT_EQ(summary.slack, 1);
  EXPECT_NEAR(summary.tension_min, 0, 0);
  EXPECT_NEAR(summary.tension_max, 30, 1e-12);
  EXPECT_NEAR(summary.tension_mean, 40.0 / 3, 1e-12);
  ASSERT_TRUE(summary.has_target);
  EXPECT_NEAR(summary.tension_rms_from_target, std::sqrt((100.0 + 100 + 400) / 3), 1e-12);
}

TEST(GroupSummary, OfAGroupWithoutElementsIsZero) {
  auto model = three_cables();
  add_membrane_group(model, "none");
  const auto summary = summary_at_rest(model, "none");
  EXPECT_EQ(summary.count, 0);
  EXPECT_EQ(summary.principal_min, 0);
  EXPECT_EQ(summary.principal_max, 0);
}

/// A mast of one beam, 4 m high, whose weight of 30 N/m its two ends share: nothing is moved, so that each
/// end carries half, in compression below and in tension above.
TEST(GroupSummary, HasTheAxialForceOfBothEndsOfABeamWhicheverComesFirst) {
  for (const bool upwards : {true, false}) {
    Model model;
    model.nodes = {{0, 0, 0}, {0, 0, 4}};
    const int mast = add_beam_group(model, "mast");
    add_beam(model, mast, upwards ? 0 : 1, upwards ? 1 : 0);
    model.beams[0].line_load = {7, 0, -30};
    const auto response = evaluate_response(model, State::reference(model));
    const auto summary = summarise_groups(model, State::reference(model), response).at("mast");
    EXPECT_NEAR(summary.axial_min, -60, 1e-9);
    EXPECT_NEAR(summary.axial_max, 60, 1e-9);
    const Vec3 start = first_end_force(model, response, 0);
    EXPECT_NEAR(start[0], upwards ? -60 : 60, 1e-9);
    EXPECT_NEAR(start.tail<2>().norm(), 14, 1e-9);
    EXPECT_NEAR(start[0], -response.beams[0].axial, 1e-9);
  }
}

TEST(Response, OfAPrestressedMembraneAtRestIsItsPrestress) {
  const auto model = two_facets();
  const auto response = evaluate_response(model, State::reference(model));
  // Principal values of N0 = [300 40; 40 100]: 200 +- sqrt(100^2 + 40^2).
  EXPECT_NEAR(response.membranes[0].principal_cauchy[0], 200 + std::hypot(100, 40), 1e-9);
  EXPECT_NEAR(response.membranes[0].principal_cauchy[1], 200 - std::hypot(100, 40), 1e-9);
  const auto summary = summary_at_rest(model, "cloth");
  EXPECT_NEAR(summary.principal_max, 225 + std::hypot(175, 70), 1e-9);
  EXPECT_NEAR(summary.principal_min, 225 - std::hypot(175, 70), 1e-9);
}

}  // namespace
}  // namespace tautline::model
