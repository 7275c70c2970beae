// Newton's method ends quadratically on every element: each residual is of the order of the square of the
// last.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>

#include "assembly/models.hpp"

namespace tautline::assembly {
namespace {

using namespace testing_models;

struct Problem {
  std::string name;
  model::Model model;
  Boundary boundary;
};

void PrintTo(const Problem& problem, std::ostream* out) {
  *out << problem.name;
}

model::Group group_of(model::ElementKind kind) {
  model::Group group;
  group.name = "part";
  group.kind = kind;
  return group;
}

/// Two lines from supports to a node that a load pulls down by a good part of their length.
Problem two_lines(const std::string& name, model::ElementKind kind, double strain, double force) {
  Problem p{name, {}, {}};
  p.model.nodes = {{-1, 0, 0.3}, {0, 0, 0}, {1.2, 0.1, 0.2}, {0.1, 1, 0.1}};
  p.model.groups.push_back(group_of(kind));
  p.model.groups[0].cable = {1000, 2};
  for (const int end : {0, 2, 3}) p.model.cables.push_back({{end, 1}, 0, strain});
  p.boundary = {{support({0, 2, 3})}, {load(1, {20, 10, force})}};
  if (kind == model::ElementKind::catenary) p.boundary.loads.push_back(weight({0, 0, -9.81}));
  return p;
}

Problem bent_beam() {
  element::BeamSection section;
  section.axial_stiffness = 1e4;
  section.bending_stiffness_2 = section.bending_stiffness_3 = 1;
  section.torsion_stiffness = 1;
  return {"Beam", cantilever(8, 1, section), clamped_root(load(8, {0, 0.4, 0.5}))};
}

/// 4 x 4 quadrilaterals, or each cut in two, on a unit square that is a little curved.
template <class Add>
Problem square(const std::string& name, model::ElementKind kind, bool triangles, const Add& add) {
  Problem p{name, {}, {}};
  p.model.groups.push_back(group_of(kind));
  constexpr int n = 4;
  std::vector<int> rim, side;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const double x = double(i) / n, y = double(j) / n;
      if (i == 0 || j == 0 || i == n || j == n) rim.push_back(static_cast<int>(p.model.nodes.size()));
      if (i == 0) side.push_back(static_cast<int>(p.model.nodes.size()));
      p.model.nodes.emplace_back(x, y, 0.1 * x * y);
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = i + j * (n + 1), b = a + 1, c = b + n + 1, d = c - 1;
      if (triangles) {
        add(p.model, model::FacetNodes(a, b, c));
        add(p.model, model::FacetNodes(a, c, d));
      } else {
        add(p.model, model::FacetNodes(a, b, c, d));
      }
    }
  p.boundary.supports = {kind == model::ElementKind::shell ? support(side, clamped) : support(rim)};
  p.boundary.loads.emplace_back().on = {"part"};
  return p;
}

Problem blown_film(const std::string& name, bool triangles, bool wrinkling) {
  auto p = square(name, model::ElementKind::membrane, triangles, [](model::Model& m, const auto& nodes) {
    m.membranes.push_back({nodes, 0, Vec3(5, 5, 0)});
  });
  p.model.groups[0].membrane = {1000, 0.3, 1};
  p.model.groups[0].membrane.wrinkling = wrinkling;
  p.boundary.loads[0].pressure = 40;
  return p;
}

Problem bent_plate(const std::string& name, bool triangles) {
  auto p = square(name, model::ElementKind::shell, triangles, [](model::Model& m, const auto& nodes) {
    auto& shell = m.shells.emplace_back();
    shell.nodes = nodes;
  });
  p.model.groups[0].shell = {1e6, 0.3, 0.05, 1};
  model::find_directors(p.model);
  p.boundary.loads[0].surface_force = Vec3(0, 0, 20);
  return p;
}

Problem turned_spring() {
  Problem p{"Spring", {}, {}};
  p.model.nodes = {{0, 0, 0}};
  p.model.groups.push_back(group_of(model::ElementKind::spring));
  p.model.groups[0].spring = {Vec3(10, 20, 30), Vec3(1, 2, 3)};
  p.model.springs.push_back({{0}, 0});
  p.model.nodes.emplace_back(0, 0, 1);  // an arm that a force turns
  p.model.links.push_back({0, 1, false, {}, -1});
  p.boundary = {{}, {load(1, {0.5, 0.7, 0})}};
  return p;
}

std::vector<Problem> problems() {
  using model::ElementKind;
  return {two_lines("Cable", ElementKind::cable, 0.02, -60),
          two_lines("Bar", ElementKind::bar, 0, -60),
          two_lines("Catenary", ElementKind::catenary, -0.02, -60),
          bent_beam(),
          blown_film("MembraneOfTriangles", true, false),
          blown_film("MembraneOfQuadrilaterals", false, false),
          blown_film("WrinklingMembrane", false, true),
          bent_plate("ShellOfTriangles", true),
          bent_plate("ShellOfQuadrilaterals", false),
          turned_spring()};
}

class Convergence : public testing::TestWithParam<Problem> {};

TEST_P(Convergence, IsQuadraticAtTheEnd) {
  System system(GetParam().model);
  const auto summary = solve(system, GetParam().boundary);
  ASSERT_EQ(summary.points.size(), 1u) << "the whole load in one step";
  std::vector<double> residuals;
  for (const auto& iteration : summary.points[0].newton.iterations)
    residuals.push_back(std::max(iteration.norms.force / iteration.norms.reference_force,
                                 iteration.norms.moment / iteration.norms.reference_moment));
  ASSERT_GT(residuals.size(), 3u) << "a nonlinear problem";
  int quadratic = 0;
  for (std::size_t k = 0; k + 1 < residuals.size(); ++k) {
    if (residuals[k] > 0.02) continue;
    // The factor is the ratio of stiffnesses that one step turns into each other: 40 in the thin plates.
    // Linear convergence, even by a tenth in each step, would break the bound below a residual of 1e-3.
    EXPECT_LE(residuals[k + 1], 100 * residuals[k] * residuals[k] + 1e-12)
        << testing::PrintToString(residuals);
    quadratic += residuals[k] < 1e-3 ? 1 : 0;
  }
  EXPECT_GE(quadratic, 1);
}

INSTANTIATE_TEST_SUITE_P(All, Convergence, testing::ValuesIn(problems()),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace tautline::assembly
