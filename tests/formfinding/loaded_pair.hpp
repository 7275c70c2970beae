#pragma once

#include <formfinding/nets.hpp>
#include <tautline/formfinding/constraints.hpp>

namespace tautline::formfinding {

/// Supports at x = -2 and 2, load 6 N down: at lengths 2.5 m the node hangs at z = -1.5 m, each cable carries
/// 6 x 2.5 / (2 x 1.5) = 5 N, and pulls its support with 4 N along x.
inline ConstrainedNet loaded_pair() {
  ConstrainedNet problem;
  problem.net = star({{-2, 0, 0}, {2, 0, 0}});
  problem.net.load = {{0, 0, -6}, Vec3::Zero(), Vec3::Zero()};
  return problem;
}

}  // namespace tautline::formfinding
