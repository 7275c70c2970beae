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

}  // namespace
}  // namespace tautline::assembly
