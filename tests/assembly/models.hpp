#pragma once
// Small structures with closed-form answers, and a short way to solve them.

#include <tautline/analysis/path.hpp>
#include <tautline/assembly/system.hpp>

#include "model/models.hpp"

namespace tautline::assembly::testing_models {

using namespace model::testing_models;

constexpr std::array<bool, 6> pinned{true, true, true, false, false, false};
constexpr std::array<bool, 6> clamped{true, true, true, true, true, true};

inline model::Support support(const std::vector<int>& nodes, const std::array<bool, 6>& fixed = pinned) {
  model::Support result;
  result.nodes = nodes;
  result.fixed = fixed;
  return result;
}

inline model::Load load(int node, const Vec3& force, const Vec3& moment = Vec3::Zero()) {
  model::Load result;
  result.nodes = {node};
  result.force = force;
  result.moment = moment;
  return result;
}

inline model::Load weight(const Vec3& acceleration) {
  model::Load result;
  result.acceleration = acceleration;
  return result;
}

/// Follows the stage to `boundary` from the present state to its end.
inline analysis::PathSummary solve(System& system, const Boundary& boundary,
                                   const analysis::NewtonOptions& options = {}) {
  analysis::Workspace workspace{system.new_matrix(), la::DirectSolver()};
  system.begin_stage(boundary);
  auto summary = analysis::follow_path(system, workspace, options);
  EXPECT_TRUE(summary.reached) << summary.reason;
  return summary;
}

/// The same in equal small steps.
inline void solve_in_steps(System& system, const Boundary& boundary, int steps) {
  analysis::Workspace workspace{system.new_matrix(), la::DirectSolver()};
  system.begin_stage(boundary);
  for (int i = 1; i <= steps; ++i) {
    system.set_lambda(static_cast<double>(i) / steps);
    const auto newton = analysis::solve_newton(system, workspace, {});
    ASSERT_TRUE(newton.converged()) << newton.reason;
    system.commit();
  }
}

/// Forces and moments of loads, weight and reactions about the origin, in the present state.
struct Resultant {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
};

inline Resultant resultant(System& system, const Boundary& boundary) {
  Resultant sum;
  const auto x = model::positions(system.model(), system.state());
  const auto add = [&](std::size_t node, const Vec3& force, const Vec3& moment) {
    sum.force += force;
    sum.moment += x[node].cross(force) + moment;
  };
  const auto reactions = system.reactions();
  for (std::size_t i = 0; i < x.size(); ++i) add(i, reactions.force[i], reactions.moment[i]);
  for (const auto& load : boundary.loads)
    for (const int node : load.nodes) add(static_cast<std::size_t>(node), load.force, load.moment);
  return sum;
}

/// A straight beam along x of length `length`, clamped at node 0 when solved with clamped_root().
inline model::Model cantilever(int elements, double length, const element::BeamSection& section) {
  model::Model model;
  for (int i = 0; i <= elements; ++i) model.nodes.emplace_back(length * i / elements, 0, 0);
  const int rod = add_beam_group(model, "rod");
  model.groups[rod].beam = section;
  model.groups[rod].orientation = {0, 0, 1};
  for (int i = 0; i < elements; ++i) add_beam(model, rod, i, i + 1);
  return model;
}

inline Boundary clamped_root(const model::Load& load) {
  return {{support({0}, clamped)}, {load}};
}

}  // namespace tautline::assembly::testing_models
