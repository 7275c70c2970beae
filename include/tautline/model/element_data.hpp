#pragma once
/// @file
/// From model and state to what an element kernel wants: the gather of assembly and of results.

#include <array>

#include <tautline/element/beam.hpp>
#include <tautline/element/cable.hpp>
#include <tautline/model/model.hpp>
#include <tautline/model/state.hpp>

namespace tautline::model {

struct CableData {
  element::CableProperties properties;
  Mat<3, 2> x_ref;
};

inline CableData cable_data(const Model& model, const Cable& cable) {
  CableData data{{model.groups[cable.group].cable.axial_stiffness, cable.initial_strain}, {}};
  data.x_ref << model.nodes[cable.nodes[0]], model.nodes[cable.nodes[1]];
  return data;
}

inline element::BeamGeometry beam_geometry(const Model& model, const Beam& beam) {
  element::BeamGeometry geometry;
  geometry.x_ref << model.nodes[beam.nodes[0]], model.nodes[beam.nodes[1]];
  geometry.frame = beam.frame;
  return geometry;
}

inline element::BeamMotion beam_motion(const State& state, const Beam& beam) {
  element::BeamMotion motion;
  motion.u << state.displacement[beam.nodes[0]], state.displacement[beam.nodes[1]];
  motion.rotation = {state.rotation[beam.nodes[0]], state.rotation[beam.nodes[1]]};
  return motion;
}

inline Mat<3, 3> membrane_nodes(const Model& model, const Membrane& membrane) {
  Mat<3, 3> x_ref;
  x_ref << model.nodes[membrane.nodes[0]], model.nodes[membrane.nodes[1]], model.nodes[membrane.nodes[2]];
  return x_ref;
}

/// Displacements of an element's nodes, one after the other.
template <std::size_t N>
Vec<3 * static_cast<int>(N)> gather(const State& state, const std::array<int, N>& nodes) {
  Vec<3 * static_cast<int>(N)> u;
  for (std::size_t i = 0; i < N; ++i)
    u.template segment<3>(3 * static_cast<int>(i)) = state.displacement[nodes[i]];
  return u;
}

}  // namespace tautline::model
