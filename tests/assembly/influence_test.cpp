#include <tautline/assembly/influence.hpp>

#include <gtest/gtest.h>

#include "assembly/models.hpp"

namespace tautline::assembly {
namespace {

using namespace testing_models;

/// Node 1 between two taut cables along x; node 2 below holds it by a tie.
model::Model tied_node() {
  model::Model model;
  model.nodes = {Vec3(-2, 0, 0), Vec3(0, 0, 0), Vec3(3, 0, 0), Vec3(0, 0, -0.5)};
  const int group = add_cable_group(model, "cable", 1000.0);
  add_cable(model, group, 0, 1, 0.05);
  add_cable(model, group, 1, 2, 0.05);
  add_cable(model, group, 1, 3, 0.01);
  return model;
}

Boundary held_ends() {
  return {{support({0, 2, 3})}, {}};
}

// Against the whole nonlinear solve for lengths changed by +-h: central differences leave an error of h^2.
TEST(LengthInfluence, IsTheDerivativeOfTheEquilibriumByALength) {
  const double h = 1e-5;
  const auto solved_with = [&](double change) {
    System system(tied_node());
    const double length = system.model().unstressed_length(system.model().cables[2]);
    auto strains = system.strains();
    strains[2] = 0.5 / (length + change) - 1;
    system.set_target_strains(strains);
    solve(system, held_ends());
    return system.state().displacement[1];
  };
  const Vec3 expected = (solved_with(h) - solved_with(-h)) / (2 * h);
  System system(tied_node());
  solve(system, held_ends());
  analysis::Workspace workspace{system.new_matrix(), la::DirectSolver()};
  const MatX influence = length_influence(system, workspace, {2}, {1});
  ASSERT_GT(expected.norm(), 0.1);
  EXPECT_LT((influence.col(0) - expected).norm(), 1e-6 * expected.norm());
}

TEST(LengthInfluence, LeavesHeldNodesWhereTheyAre) {
  System system(tied_node());
  solve(system, held_ends());
  analysis::Workspace workspace{system.new_matrix(), la::DirectSolver()};
  EXPECT_EQ(length_influence(system, workspace, {0, 1, 2}, {0, 2, 3}).norm(), 0);
}

/// More parameters than are solved at once, of two catenaries and many cables: each column is what its
/// parameter does alone.
TEST(Influence, OfManyParametersIsThatOfEach) {
  model::Model model;
  model.nodes = {Vec3(0, 0, 0)};
  const int group = add_cable_group(model, "cable", 1000.0);
  std::vector<int> cables, ends;
  for (int i = 0; i < 70; ++i) {
    const double angle = 0.3 * i;
    model.nodes.emplace_back((2 + 0.01 * i) *
                             Vec3(std::cos(angle), std::sin(angle), 0.3 * std::sin(3 * angle)));
    add_cable(model, group, 0, i + 1, 0.01);
    cables.push_back(i);
    ends.push_back(i + 1);
  }
  System system(model);
  solve(system, {{support(ends)}, {}});
  analysis::Workspace workspace{system.new_matrix(), la::DirectSolver()};
  const MatX all = length_influence(system, workspace, cables, {0});
  for (const int cable : cables)
    EXPECT_LT((length_influence(system, workspace, {cable}, {0}) - all.col(cable)).norm(), 1e-12 * all.norm())
        << cable;
  EXPECT_GT(all.colwise().norm().minCoeff(), 1e-3 * all.norm()) << "all of them move the node";
}

/// Motion of node 1 by central differences of the nonlinear solve with quantities of all cables times 1 +- h.
Vec3 by_differences(const model::Model& model, CableQuantity quantity) {
  const double h = 1e-5;
  const auto solved_with = [&](double factor) {
    System system(model);
    if (quantity == CableQuantity::axial_stiffness)
      system.set_stiffness_factors(std::vector<double>(model.cables.size(), factor));
    auto strains = system.strains();
    if (quantity == CableQuantity::unstressed_length)
      for (auto& strain : strains) strain = (1 + strain) / factor - 1;
    system.set_target_strains(strains);
    auto boundary = held_ends();
    boundary.loads = {load(1, Vec3(1, 2, -30)), weight(Vec3(0, 0, -9.81))};
    solve(system, boundary);
    return system.state().displacement[1];
  };
  return (solved_with(1 + h) - solved_with(1 - h)) / (2 * h);
}

/// The same by the influence of one parameter that is 1 and multiplies the quantity of all cables.
Vec3 by_influence(const model::Model& model, CableQuantity quantity) {
  System system(model);
  auto boundary = held_ends();
  boundary.loads = {load(1, Vec3(1, 2, -30)), weight(Vec3(0, 0, -9.81))};
  solve(system, boundary);
  analysis::Workspace workspace{system.new_matrix(), la::DirectSolver()};
  CableParameter all{quantity, {}};
  for (int i = 0; i < static_cast<int>(model.cables.size()); ++i)
    all.parts.push_back({i, quantity == CableQuantity::unstressed_length
                                ? model.unstressed_length(model.cables[i])
                                : model.axial_stiffness(model.cables[i])});
  return influence(system, workspace, {all}, {1}).col(0);
}

TEST(Influence, OfAFactorOnCablesIsTheDerivativeOfTheEquilibrium) {
  for (const auto kind : {model::ElementKind::cable, model::ElementKind::bar, model::ElementKind::catenary}) {
    auto model = tied_node();
    model.groups[0].kind = kind;
    model.groups[0].cable.mass_per_length = 0.1;
    for (const auto quantity : {CableQuantity::unstressed_length, CableQuantity::axial_stiffness}) {
      const Vec3 expected = by_differences(model, quantity);
      ASSERT_GT(expected.norm(), 1e-3);
      EXPECT_LT((by_influence(model, quantity) - expected).norm(), 2e-6 * expected.norm());
    }
  }
}

}  // namespace
}  // namespace tautline::assembly
