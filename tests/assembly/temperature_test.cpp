// Changes of temperature, uniform and by place: what each element gets of them.
#include <gtest/gtest.h>

#include <cmath>
#include <tautline/core/error.hpp>

#include "assembly/mixture.hpp"

namespace tautline::assembly {
namespace {

using namespace testing_models;

/// Two elements of every kind that warms, in places of no symmetry; groups named by their kind.
model::Model pairs() {
  model::Model model;
  model.nodes = {{0, 0, 0}, {2, 1, 0.5}, {3, 4, -1}, {-1, 2, 1}, {5, 1, 2}};
  const int rope = add_cable_group(model, "rope"), rod = add_beam_group(model, "rod"),
            cloth = add_membrane_group(model, "cloth"), plate = add_shell_group(model, "plate");
  add_cable(model, rope, 0, 1, 1e-3);
  add_cable(model, rope, 1, 2, 1e-3);
  add_beam(model, rod, 2, 3);
  add_beam(model, rod, 3, 4);
  add_membrane(model, cloth, 0, 1, 3);
  add_membrane(model, cloth, 1, 2, 3);
  model.shells.push_back({{1, 4, 2}, plate, Vec3::Zero(), 0, {}, 0});
  model.shells.push_back({{0, 4, 1}, plate, Vec3::Zero(), 1, {}, 0});
  model::find_directors(model);
  return model;
}

/// Changes of all elements: cables, beams, membranes, shells.
std::vector<double> changes(const model::Model& model, const std::vector<model::Load>& loads,
                            double lambda = 1) {
  System system(model);
  system.begin_stage({{support({0, 1, 2, 3, 4}, clamped)}, loads});
  system.set_lambda(lambda);
  std::vector<double> result;
  const auto add = [&](const auto& elements) {
    for (const auto& element : elements) result.push_back(element.temperature_change);
  };
  add(system.model().cables);
  add(system.model().beams);
  add(system.model().membranes);
  add(system.model().shells);
  return result;
}

const std::vector<std::string> kinds{"rope", "rod", "cloth", "plate"};

TEST(Temperature, ReachesTheElementsThatItNamesAndNoOthers) {
  const auto model = pairs();
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    auto heat = on(kinds[kind]);
    heat.temperature_change = 30;
    const auto found = changes(model, {heat}, 0.5);
    for (std::size_t i = 0; i < found.size(); ++i)
      EXPECT_NEAR(found[i], i / 2 == kind ? 15 : 0, 1e-14) << kinds[kind] << " " << i;
  }
}

TEST(Temperature, OfSeveralLoadsAddsUp) {
  auto heat = on("cloth"), warm = on("cloth");
  heat.temperature_change = 30;
  warm.temperature_change = -4;
  warm.temperature_field = [](const Vec3& x) { return x.x(); };
  const auto model = pairs();
  const auto found = changes(model, {heat, warm});
  EXPECT_NEAR(found[4], 26 + (0.0 + 2 - 1) / 3, 1e-13);
  EXPECT_NEAR(found[5], 26 + (2.0 + 3 - 1) / 3, 1e-13);
}

/// Mean of a field over a line or a triangle, by many small pieces.
double mean(const std::vector<Vec3>& x, const std::function<double(const Vec3&)>& field) {
  constexpr int n = 400;
  double sum = 0;
  int count = 0;
  if (x.size() == 2) {
    for (int i = 0; i < n; ++i, ++count) sum += field(x[0] + (i + 0.5) / n * (x[1] - x[0]));
    return sum / count;
  }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n - i; ++j) {
      const auto at = [&](double a, double b) {
        return field(x[0] + (i + a) / n * (x[1] - x[0]) + (j + b) / n * (x[2] - x[0]));
      };
      sum += at(1.0 / 3, 1.0 / 3), ++count;
      if (j < n - i - 1) sum += at(2.0 / 3, 2.0 / 3), ++count;
    }
  return sum / count;
}

TEST(Temperature, ByPlaceIsTheMeanOverTheElement) {
  const auto model = pairs();
  const auto cubic = [](const Vec3& x) { return 2 + x.x() * x.x() * x.y() - 3 * std::pow(x.z(), 3); };
  const auto square = [](const Vec3& x) { return 2 + x.x() * x.y() - 3 * x.z() * x.z() + x.y(); };
  std::vector<std::vector<Vec3>> corners;
  const auto add = [&](const auto& elements) {
    for (const auto& element : elements) {
      corners.emplace_back();
      for (const int node : element.nodes)
        corners.back().push_back(model.nodes[static_cast<std::size_t>(node)]);
    }
  };
  add(model.cables);
  add(model.beams);
  add(model.membranes);
  add(model.shells);
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    auto heat = on(kinds[kind]);
    // Lines are exact to the third power, triangles to the second; the pieces leave 1/n^2 of the curvature.
    if (kind < 2)
      heat.temperature_field = cubic;
    else
      heat.temperature_field = square;
    const auto found = changes(model, {heat});
    for (const std::size_t i : {2 * kind, 2 * kind + 1})
      EXPECT_NEAR(found[i], mean(corners[i], heat.temperature_field), 1e-3) << kinds[kind] << " " << i;
  }
}

TEST(Temperature, WithoutAValueSomewhereIsRefused) {
  const auto model = pairs();
  auto heat = on("rope");
  heat.temperature_field = [](const Vec3& x) { return 1 / (x.x() - 2); };  // none at node 2
  EXPECT_THROW(changes(model, {heat}), ModelError);
  auto warm = on("rod");
  warm.temperature_field = [](const Vec3& x) { return x.x(); };
  warm.temperature_gradient = [](const Vec3&) { return Vec3(std::nan(""), 0, 0); };
  EXPECT_THROW(changes(model, {warm}), ModelError);
}

/// The slope of a field at a beam's middle, across the beam, in its own axes.
TEST(Temperature, BendsABeamByItsSlopeAcross) {
  const auto model = pairs();
  auto warm = on("rod");
  warm.temperature_field = [](const Vec3& x) { return x.x() * x.x() + 3 * x.y(); };
  warm.temperature_gradient = [](const Vec3& x) { return Vec3(2 * x.x(), 3, 0); };
  System system(model);
  system.begin_stage({{support({0, 1, 2, 3, 4}, clamped)}, {warm}});
  system.set_lambda(0.5);
  for (const auto& beam : system.model().beams) {
    const Vec3 middle = (model.nodes[static_cast<std::size_t>(beam.nodes[0])] +
                         model.nodes[static_cast<std::size_t>(beam.nodes[1])]) /
                        2;
    const Vec3 slope(2 * middle.x(), 3, 0);
    EXPECT_NEAR(beam.temperature_gradient[0], 0.5 * slope.dot(beam.frame.col(1)), 1e-13);
    EXPECT_NEAR(beam.temperature_gradient[1], 0.5 * slope.dot(beam.frame.col(2)), 1e-13);
  }
}

/// A warm rope between held ends loses E A alpha dT; a warm beam that may bend becomes an arc of curvature
/// alpha dT/dz.
TEST(Temperature, StretchesAndBends) {
  model::Model rope;
  rope.nodes = {{0, 0, 0}, {2, 0, 0}};
  add_cable(rope, add_cable_group(rope, "rope", 1e4), 0, 1, 5e-3);
  rope.groups[0].thermal_expansion = 1e-5;
  System system(rope);
  auto heat = on("rope");
  heat.temperature_change = 40;
  system.begin_stage({{support({0, 1})}, {heat}});
  system.set_lambda(1);
  const double tension = 1e4 * (1.005 / (1 + 4e-4) - 1);
  EXPECT_NEAR(system.reactions().force[1].x(), tension, 1e-3 * 4);

  auto beam = cantilever(4, 2, {1e7, 2e4, 1e4, 5e3, 0, 0, 1, 0, 0});
  beam.groups[0].thermal_expansion = 1e-5;
  System bent(beam);
  auto warm = on("rod");
  warm.temperature_field = [](const Vec3& x) { return 10 * x.z(); };
  warm.temperature_gradient = [](const Vec3&) { return Vec3(0, 0, 10); };
  solve(bent, {{support({0}, clamped)}, {warm}});
  // Longer at the top: it bows down by kappa L^2 / 2.
  EXPECT_NEAR(bent.state().displacement[4].z(), -1e-4 * 4 / 2, 1e-8);
}

}  // namespace
}  // namespace tautline::assembly
