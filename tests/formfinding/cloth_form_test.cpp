#include <gtest/gtest.h>

#include <cmath>
#include <tautline/core/error.hpp>
#include <tautline/formfinding/constraints.hpp>
#include <tautline/formfinding/minimal_film.hpp>

#include "formfinding/elastic_nets.hpp"
#include "messages.hpp"

namespace tautline::formfinding {
namespace {

using testing_messages::mentions;
using testing_messages::message_of;

/// A saddle of n x n cells with a cable of tension 3 N along every grid line and cloth of 1 N/m in every
/// cell.
ConstrainedNet clothed_net(int n) {
  ConstrainedNet problem;
  add_grid(n, problem.net, problem.triangles);
  problem.net.branches.clear();
  for (std::size_t i = 0; i < problem.net.nodes.size(); ++i)
    problem.net.fixed[i] = problem.net.nodes[i].head<2>().cwiseAbs().maxCoeff() > 1 - 1e-9;
  const auto at = [n](int i, int j) { return i * (n + 1) + j; };
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j < n; ++j) {
      problem.net.branches.push_back({at(i, j), at(i, j + 1)});
      problem.net.branches.push_back({at(j, i), at(j + 1, i)});
    }
  problem.surface_stress = VecX::Ones(static_cast<Eigen::Index>(problem.triangles.size()));
  Constraint tension{ConstraintKind::tension, "grid", {}, {3.0}};
  for (std::size_t b = 0; b < problem.net.branches.size(); ++b)
    tension.members.push_back(static_cast<int>(b));
  problem.constraints = {tension};
  return problem;
}

TEST(ClothForm, IsTheShapeOfFilmAndCablesFoundTogether) {
  // The film method finds the same equilibrium by another iteration: all nodes have cables, so that none may
  // stay where it likes along the film.
  const auto problem = clothed_net(5);
  const auto found = find_form(problem);
  ASSERT_TRUE(found.converged) << found.reason;
  MinimalFilmOptions options;
  options.tolerance = 1e-11;
  const auto film =
      find_minimal_film({problem.net,
                         isotropic_film(problem.triangles, problem.surface_stress),
                         VecX::Constant(static_cast<Eigen::Index>(problem.net.branches.size()), 3.0),
                         {}},
                        options);
  ASSERT_TRUE(film.converged) << film.reason;
  for (std::size_t i = 0; i < found.nodes.size(); ++i)
    EXPECT_LT((found.nodes[i] - film.nodes[i]).norm(), 1e-8) << i;
  EXPECT_LT((found.tension.array() - 3).abs().maxCoeff(), 1e-9);
  EXPECT_LT(found.out_of_balance, 1e-9);
  EXPECT_LT(found.cloth_iterations, 100) << "renewed until it has settled, no longer";
}

TEST(ClothForm, PullAlongTheCablesOfAFlatSquare) {
  // Four triangles around the middle of a square of side 2: the corners at its sides have 45 degrees, those
  // in the middle 90 degrees. A diagonal cable lies opposite to two corners of 45 degrees: q = 2 s/2 cot 45 =
  // s.
  ConstrainedNet problem;
  problem.net.nodes = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0.1, 0.2, 0}};
  problem.net.fixed = {true, true, true, true, false};
  problem.net.branches = {{0, 4}, {1, 4}, {2, 4}, {3, 4}};
  problem.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  problem.surface_stress = VecX::Constant(4, 2.5);
  problem.constraints = {{ConstraintKind::tension, "diagonals", {0, 1, 2, 3}, {7.0}}};
  const auto found = find_form(problem);
  ASSERT_TRUE(found.converged) << found.reason;
  EXPECT_LT(found.nodes[4].norm(), 1e-9);
  for (int b = 0; b < 4; ++b) EXPECT_NEAR(found.cloth_force_density[b], 2.5, 1e-9);
  EXPECT_TRUE(found.warnings.empty());
}

TEST(ClothForm, RefusesClothWithoutArea) {
  auto problem = clothed_net(2);
  problem.triangles[0] = {0, 1, 1};
  const auto message = message_of<ModelError>([&] { find_form(problem); });
  EXPECT_TRUE(mentions(message, "the facet of the film between node 1, node 2, node 2 has no area"))
      << message;
}

}  // namespace
}  // namespace tautline::formfinding
