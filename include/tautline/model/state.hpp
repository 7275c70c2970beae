#pragma once
/// @file
/// Where the structure is: displacements and rotations from the reference configuration. Copy to commit,
/// assign to roll back.

#include <vector>

#include <tautline/model/model.hpp>

namespace tautline::model {

struct State {
  Points displacement;         ///< one for each node [m]
  std::vector<Mat3> rotation;  ///< one for each node; identity where the node has no rotations
  Points hinge_angle;          ///< one for each link: angles about its hinge axes [rad]
  /// One for each node: rotation vector that its supports prescribe or hold, any number of turns [rad]
  Points turn;

  /// The reference configuration of `model`.
  static State reference(const Model& model);
  /// Where an analysis of `model` begins: the reference configuration moved by its initial motion.
  static State initial(const Model& model);
};

/// Current positions, reference + displacement [m].
Points positions(const Model& model, const State& state);

}  // namespace tautline::model
