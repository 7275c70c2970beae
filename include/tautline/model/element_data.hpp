#pragma once
/// @file
/// From model and state to what an element kernel wants: the gather of assembly and of results.

#include <array>

#include <tautline/element/beam.hpp>
#include <tautline/element/cable.hpp>
#include <tautline/element/catenary.hpp>
#include <tautline/model/model.hpp>
#include <tautline/model/section.hpp>
#include <tautline/model/state.hpp>

namespace tautline::model {

/// Reference coordinates of an element's nodes, column = node [m].
template <int N, class Nodes>
Mat<3, N> reference_nodes(const Model& model, const Nodes& nodes) {
  Mat<3, N> x_ref;
  for (int i = 0; i < N; ++i) x_ref.col(i) = model.nodes[nodes[i]];
  return x_ref;
}

/// Displacements of an element's nodes, one after the other.
template <int N, class Nodes>
Vec<3 * N> displacements(const State& state, const Nodes& nodes) {
  Vec<3 * N> u;
  for (int i = 0; i < N; ++i) u.template segment<3>(3 * i) = state.displacement[nodes[i]];
  return u;
}

struct CableData {
  element::CableProperties properties;
  Mat<3, 2> x_ref;
};

/// Warmth lengthens the unstressed cable: 1 + eps0 becomes (1 + eps0) / (1 + alpha dT).
inline CableData cable_data(const Model& model, const Cable& cable) {
  const Group& group = model.groups[cable.group];
  const double thermal = group.thermal_expansion * cable.temperature_change;
  const double strain =
      thermal == 0 ? cable.initial_strain : (cable.initial_strain - thermal) / (1 + thermal);
  return {{model.axial_stiffness(cable), strain, group.kind == ElementKind::bar},
          reference_nodes<2>(model, cable.nodes)};
}

inline element::CatenaryProperties catenary_properties(const Model& model, const Cable& cable) {
  const Group& group = model.groups[cable.group];
  const double warm = 1 + group.thermal_expansion * cable.temperature_change;
  const double length = model.unstressed_length(cable) * warm;
  return {model.axial_stiffness(cable), length, group.cable.mass_per_length / warm,
          cable.line_load * (model.reference_length(cable) / length)};
}

inline element::BeamGeometry beam_geometry(const Model& model, const Beam& beam) {
  const Group& group = model.groups[beam.group];
  return {reference_nodes<2>(model, beam.nodes), beam.frame,
          group.thermal_expansion * beam.temperature_change,
          // strain = u' - y2 theta3' + y3 theta2'
          group.thermal_expansion * Vec<2>(beam.temperature_gradient[1], -beam.temperature_gradient[0])};
}

inline element::BeamMotion beam_motion(const State& state, const Beam& beam) {
  element::BeamMotion motion;
  motion.u << state.displacement[beam.nodes[0]], state.displacement[beam.nodes[1]];
  motion.rotation = {state.rotation[beam.nodes[0]], state.rotation[beam.nodes[1]]};
  return motion;
}

/// Section of a beam element: of the group, or where the element's middle lies along a tapered one.
inline element::BeamSection beam_section(const Model& model, const Beam& beam) {
  const Group& group = model.groups[beam.group];
  return group.taper ? tapered_section(*group.taper, (beam.span[0] + beam.span[1]) / 2) : group.beam;
}

/// Membranes and shells: direction whose projection is axis 1 of material and prestress; x unless stated.
inline Vec3 axis_1(const Group& group) {
  return group.orientation.isZero() ? Vec3(Vec3::UnitX()) : group.orientation;
}

/// Whether `direction` has a projection on the plane of a facet's frame.
inline bool has_projection(const Mat3& frame, const Vec3& direction) {
  return std::hypot(frame.col(0).dot(direction), frame.col(1).dot(direction)) > 1e-6 * direction.norm();
}

/// @brief Angle from axis 1 of a facet's frame to the projection of `direction` on its plane [rad].
///
/// A direction without one is replaced by x, and that by z: what follows from the numbering of the nodes is
/// no direction of a material.
inline double angle_in(const Mat3& frame, const Vec3& direction) {
  for (const Vec3& wish : {direction, Vec3(Vec3::UnitX())})
    if (has_projection(frame, wish)) return std::atan2(frame.col(1).dot(wish), frame.col(0).dot(wish));
  return std::atan2(frame(2, 1), frame(2, 0));
}

template <int N>
element::MembraneLaw membrane_law(const Model& model, const Membrane& membrane) {
  const Group& group = model.groups[membrane.group];
  const double angle =
      group.membrane.orthotropic()
          ? angle_in(element::membrane_frame<N>(reference_nodes<N>(model, membrane.nodes)), axis_1(group))
          : 0.0;
  return element::membrane_law(group.membrane, angle, membrane.prestress, membrane.temperature_change);
}

template <int N>
element::ShellGeometry<N> shell_geometry(const Model& model, const Shell& shell) {
  const Group& group = model.groups[shell.group];
  element::ShellGeometry<N> geometry;
  geometry.x_ref = reference_nodes<N>(model, shell.nodes);
  for (int i = 0; i < N; ++i) geometry.director.col(i) = shell.director[static_cast<std::size_t>(i)];
  geometry.prestress = shell.prestress;
  const double growth = group.shell.thermal_expansion * shell.temperature_change;
  geometry.free_strain = growth + growth * growth / 2;  // as a Green-Lagrange strain
  return geometry;
}

template <int N>
element::ShellMotion<N> shell_motion(const State& state, const Shell& shell) {
  element::ShellMotion<N> motion;
  for (int i = 0; i < N; ++i) {
    motion.u.col(i) = state.displacement[shell.nodes[i]];
    motion.rotation[static_cast<std::size_t>(i)] = state.rotation[shell.nodes[i]];
  }
  return motion;
}

/// A grounded spring's first node rests.
inline element::SpringMotion spring_motion(const State& state, const Spring& spring) {
  element::SpringMotion motion;
  const std::size_t first = 2 - spring.nodes.size();
  for (std::size_t i = 0; i < spring.nodes.size(); ++i) {
    motion.u.col(static_cast<int>(first + i)) = state.displacement[spring.nodes[i]];
    motion.rotation[first + i] = state.rotation[spring.nodes[i]];
  }
  return motion;
}

}  // namespace tautline::model
