#include "assembly/contribution.hpp"

#include <tautline/element/pressure.hpp>
#include <tautline/model/element_data.hpp>

namespace tautline::assembly {

using element::Want;
using namespace model;

namespace {

template <class Response>
Contribution taken(const Response& response, Want want) {
  Contribution c;
  c.force = response.force;
  if (want == Want::tangent) c.tangent = response.tangent;
  return c;
}

template <int N>
Contribution membrane(const Model& model, const State& state, const Membrane& m, Want want) {
  return taken(
      element::evaluate_membrane<N>(model::membrane_law<N>(model, m), reference_nodes<N>(model, m.nodes),
                                    displacements<N>(state, m.nodes), want),
      want);
}

template <int N>
Contribution shell(const Model& model, const State& state, const Shell& s, Want want) {
  return taken(element::evaluate_shell<N>(model.groups[s.group].shell, shell_geometry<N>(model, s),
                                          shell_motion<N>(state, s), want),
               want);
}

template <int N>
Contribution extrapolated_membrane(const Model& model, const State& before, const ElementVector& motion,
                                   const State& state, const Membrane& m) {
  return taken(element::extrapolate_membrane<N>(
                   model::membrane_law<N>(model, m), reference_nodes<N>(model, m.nodes),
                   displacements<N>(before, m.nodes), motion, displacements<N>(state, m.nodes)),
               Want::tangent);
}

template <int N>
Contribution extrapolated_shell(const Model& model, const State& before, const ElementVector& motion,
                                const State& state, const Shell& s) {
  return taken(element::extrapolate_shell<N>(model.groups[s.group].shell, shell_geometry<N>(model, s),
                                             shell_motion<N>(before, s), motion, shell_motion<N>(state, s)),
               Want::tangent);
}

template <int N>
Contribution pressure_on(const Model& model, const State& state, const FacetNodes& nodes, double pressure,
                         Want want) {
  Mat<3, N> x = reference_nodes<N>(model, nodes);
  for (int i = 0; i < N; ++i) x.col(i) += state.displacement[nodes[i]];
  return taken(element::evaluate_pressure<N>(pressure, x, want), want);
}

/// Masses gathered at the nodes: what a unit acceleration of all nodes makes of the translations, and of the
/// rotations the section's own inertia only.
ElementMatrix lumped(const ElementMatrix& consistent, int n_nodes, const Mat3& inertia) {
  const int stride = static_cast<int>(consistent.rows()) / n_nodes;
  ElementMatrix result = ElementMatrix::Zero(consistent.rows(), consistent.cols());
  for (int i = 0; i < n_nodes; ++i) {
    for (int j = 0; j < n_nodes; ++j)
      result.block<3, 3>(stride * i, stride * i) += consistent.block<3, 3>(stride * i, stride * j);
    if (stride == 6) result.block<3, 3>(stride * i + 3, stride * i + 3) = inertia;
  }
  return result;
}

ElementMatrix as_asked(const ElementMatrix& consistent, int n_nodes, MassKind kind,
                       const Mat3& inertia = Mat3::Zero()) {
  return kind == MassKind::consistent ? consistent : lumped(consistent, n_nodes, inertia);
}

}  // namespace

Contribution contribution(const Model& model, const State& state, const Cable& cable, Want want) {
  const auto u = displacements<2>(state, cable.nodes);
  if (model.groups[cable.group].kind == ElementKind::catenary)
    return taken(element::evaluate_catenary(catenary_properties(model, cable), model.acceleration,
                                            reference_nodes<2>(model, cable.nodes), u, want),
                 want);
  const auto data = cable_data(model, cable);
  return taken(element::evaluate_cable(data.properties, data.x_ref, u, want), want);
}

Contribution contribution(const Model& model, const State& state, const Cable& cable, Branch branch,
                          Want want) {
  if (branch == Branch::own) return contribution(model, state, cable, want);
  if (branch == Branch::slack) return {ElementVector::Zero(6), ElementMatrix::Zero(6, 6)};
  auto data = cable_data(model, cable);
  data.properties.carries_compression = true;
  return taken(
      element::evaluate_cable(data.properties, data.x_ref, displacements<2>(state, cable.nodes), want), want);
}

Contribution contribution(const Model& model, const State& state, const Beam& beam, Want want) {
  return taken(element::evaluate_beam(beam_section(model, beam), beam_geometry(model, beam),
                                      beam_motion(state, beam), want),
               want);
}

Contribution contribution(const Model& model, const State& state, const Membrane& m, Want want) {
  return m.nodes.size() == 3 ? membrane<3>(model, state, m, want) : membrane<4>(model, state, m, want);
}

Contribution contribution(const Model& model, const State& state, const Shell& s, Want want) {
  return s.nodes.size() == 3 ? shell<3>(model, state, s, want) : shell<4>(model, state, s, want);
}

Contribution contribution(const Model& model, const State& state, const Spring& spring, Want want) {
  const bool rotations = uses_rotations(model, spring);
  auto motion = spring_motion(state, spring);
  if (!rotations) motion.rotation = {Mat3::Identity(), Mat3::Identity()};  // its axes stay
  const auto whole = taken(element::evaluate_spring(model.groups[spring.group].spring, motion, want), want);
  const int n = static_cast<int>(spring.nodes.size()), first = 2 - n, stride = rotations ? 6 : 3;
  Contribution c;
  c.force.resize(n * stride);
  if (want == Want::tangent) c.tangent.resize(n * stride, n * stride);
  for (int i = 0; i < n; ++i) {
    c.force.segment(stride * i, stride) = whole.force.segment(6 * (first + i), stride);
    for (int j = 0; j < n && want == Want::tangent; ++j)
      c.tangent.block(stride * i, stride * j, stride, stride) =
          whole.tangent.block(6 * (first + i), 6 * (first + j), stride, stride);
  }
  return c;
}

Contribution contribution(const Model& model, const State&, const MassElement& mass, Want) {
  const int n = uses_rotations(model, mass) ? 6 : 3;
  return {ElementVector::Zero(n), ElementMatrix::Zero(n, n)};
}

Contribution extrapolated(const Model& model, const State& before, const ElementVector& motion,
                          const State& state, const Cable& cable) {
  if (model.groups[cable.group].kind == ElementKind::catenary)
    return contribution(model, state, cable, Want::tangent);
  const auto data = cable_data(model, cable);
  return taken(element::extrapolate_cable(data.properties, data.x_ref, displacements<2>(before, cable.nodes),
                                          motion, displacements<2>(state, cable.nodes)),
               Want::tangent);
}

Contribution extrapolated(const Model& model, const State& before, const ElementVector& motion,
                          const State& state, const Beam& beam) {
  return taken(element::extrapolate_beam(beam_section(model, beam), beam_geometry(model, beam),
                                         beam_motion(before, beam), motion, beam_motion(state, beam)),
               Want::tangent);
}

Contribution extrapolated(const Model& model, const State& before, const ElementVector& motion,
                          const State& state, const Membrane& m) {
  return m.nodes.size() == 3 ? extrapolated_membrane<3>(model, before, motion, state, m)
                             : extrapolated_membrane<4>(model, before, motion, state, m);
}

Contribution extrapolated(const Model& model, const State& before, const ElementVector& motion,
                          const State& state, const Shell& s) {
  return s.nodes.size() == 3 ? extrapolated_shell<3>(model, before, motion, state, s)
                             : extrapolated_shell<4>(model, before, motion, state, s);
}

Contribution pressure_contribution(const Model& model, const State& state, const FacetNodes& nodes,
                                   double pressure, Want want) {
  return nodes.size() == 3 ? pressure_on<3>(model, state, nodes, pressure, want)
                           : pressure_on<4>(model, state, nodes, pressure, want);
}

ElementMatrix mass_of(const Model& model, const State&, const Cable& cable, MassKind kind) {
  return as_asked(
      element::cable_mass(model.groups[cable.group].cable.mass_per_length, model.unstressed_length(cable)), 2,
      kind);
}

ElementMatrix mass_of(const Model& model, const State& state, const Beam& beam, MassKind kind) {
  const auto geometry = beam_geometry(model, beam);
  const auto section = beam_section(model, beam);
  const auto frame = element::evaluate_beam(section, geometry, beam_motion(state, beam), Want::force).frame;
  const double length = (geometry.x_ref.col(1) - geometry.x_ref.col(0)).norm();
  const double i2 = section.rotary_inertia_2, i3 = section.rotary_inertia_3;
  const Mat3 inertia = frame * Vec3(i2 + i3, i2, i3).asDiagonal() * frame.transpose() * (length / 2);
  return as_asked(element::beam_mass(section, length, frame), 2, kind, inertia);
}

ElementMatrix mass_of(const Model& model, const State&, const Membrane& m, MassKind kind) {
  const double mass = model.groups[m.group].membrane.mass_per_area;
  if (m.nodes.size() == 3)
    return as_asked(element::membrane_mass<3>(mass, reference_nodes<3>(model, m.nodes)), 3, kind);
  return as_asked(element::membrane_mass<4>(mass, reference_nodes<4>(model, m.nodes)), 4, kind);
}

ElementMatrix mass_of(const Model& model, const State&, const Shell& s, MassKind kind) {
  const auto& section = model.groups[s.group].shell;
  const auto inertia = [&](double area, int n) -> Mat3 {
    return section.density * std::pow(section.thickness, 3) / 12 * area / n * Mat3::Identity();
  };
  if (s.nodes.size() == 3) {
    const auto x = reference_nodes<3>(model, s.nodes);
    return as_asked(element::shell_mass<3>(section, x), 3, kind, inertia(element::shell_area<3>(x), 3));
  }
  const auto x = reference_nodes<4>(model, s.nodes);
  return as_asked(element::shell_mass<4>(section, x), 4, kind, inertia(element::shell_area<4>(x), 4));
}

ElementMatrix mass_of(const Model& model, const State&, const Spring& spring, MassKind) {
  const int n = static_cast<int>(spring.nodes.size()) * (uses_rotations(model, spring) ? 6 : 3);
  return ElementMatrix::Zero(n, n);
}

ElementMatrix mass_of(const Model& model, const State& state, const MassElement& point, MassKind) {
  const auto& mass = model.groups[point.group].mass;
  const int n = uses_rotations(model, point) ? 6 : 3;
  ElementMatrix result = ElementMatrix::Zero(n, n);
  result.topLeftCorner<3, 3>() = mass.mass * Mat3::Identity();
  if (n == 6) {
    const Mat3& turn = state.rotation[point.nodes[0]];
    result.bottomRightCorner<3, 3>() = turn * mass.inertia.asDiagonal() * turn.transpose();
  }
  return result;
}

double second_variation(const Model& model, const State& state, const Cable& cable, const ElementVector& v) {
  const auto c = contribution(model, state, cable, Want::tangent);
  const Vec3 relative = v.segment<3>(3) - v.segment<3>(0);
  return relative.dot(c.tangent.topLeftCorner<3, 3>() * relative);
}

double second_variation(const Model& model, const State& state, const Beam& beam, const ElementVector& v) {
  return element::beam_second_variation(beam_section(model, beam), beam_geometry(model, beam),
                                        beam_motion(state, beam), Vec<12>(v));
}

}  // namespace tautline::assembly
