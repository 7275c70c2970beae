#include "steps/frozen_net.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <tautline/core/error.hpp>
#include <tautline/model/element_data.hpp>
#include <tautline/model/response.hpp>

namespace tautline::steps {

namespace {

/// What a triangle with Cauchy resultants N in its frame pulls its corners with.
std::array<Vec3, 3> corner_forces(const Points& x, const std::array<int, 3>& nodes, const Vec3& resultants) {
  const Vec3 a = x[nodes[0]], b = x[nodes[1]], c = x[nodes[2]];
  Mat3 corners;
  corners << a, b, c;
  const Mat<3, 2> axes = element::membrane_frame<3>(corners).leftCols<2>();
  const Vec3 normal = (b - a).cross(c - a).normalized();
  Mat<2> stress;
  stress << resultants[0], resultants[2], resultants[2], resultants[1];
  const Mat3 in_space = axes * stress * axes.transpose();
  // Half of what crosses the opposite side, whose outward normal in the plane is side x normal.
  std::array<Vec3, 3> force;
  for (int k = 0; k < 3; ++k) {
    const Vec3 side = corners.col((k + 2) % 3) - corners.col((k + 1) % 3);
    force[static_cast<std::size_t>(k)] = 0.5 * in_space * side.cross(normal);
  }
  return force;
}

/// A cable of that tension at the nodes.
model::Cable taut_cable(std::array<int, 2> ends, int group, double tension, double axial_stiffness) {
  model::Cable cable;
  cable.nodes = ends;
  cable.group = group;
  cable.stiffness_factor = axial_stiffness;
  cable.initial_strain = tension / axial_stiffness;
  return cable;
}

/// Sides of a triangle of one stress pull with s/2 cot(angle opposite), where that is a pull.
void add_sides(const Points& nodes, const model::Membrane& membrane, int group,
               std::vector<model::Cable>& cables) {
  const double stress = std::min(membrane.prestress[0], membrane.prestress[1]);
  for (int k = 0; k < 3; ++k) {
    const std::array<int, 2> side{membrane.nodes[(k + 1) % 3], membrane.nodes[(k + 2) % 3]};
    const Vec3 apex = nodes[membrane.nodes[k]], a = nodes[side[0]] - apex, b = nodes[side[1]] - apex;
    const double tension = stress / 2 * a.dot(b) / a.cross(b).norm() * (b - a).norm();
    if (tension > 0) cables.push_back(taut_cable(side, group, tension, force_density_kept * tension));
  }
}

}  // namespace

Points net_pull(const model::Model& structure, const std::vector<bool>& found) {
  Points force(structure.nodes.size(), Vec3::Zero());
  for (const auto& cable : structure.cables) {
    if (!found[static_cast<std::size_t>(cable.group)]) continue;
    const auto [a, b] = cable.nodes;
    const double tension = structure.axial_stiffness(cable) * cable.initial_strain;
    const Vec3 along = tension * (structure.nodes[b] - structure.nodes[a]).normalized();
    force[a] += along;
    force[b] -= along;
  }
  for (const auto& membrane : structure.membranes) {
    if (!found[static_cast<std::size_t>(membrane.group)]) continue;
    if (membrane.nodes.size() != 3)
      throw ModelError("form-finding: cloth on an elastic frame must be of triangles");
    const std::array<int, 3> nodes{membrane.nodes[0], membrane.nodes[1], membrane.nodes[2]};
    const auto forces = corner_forces(structure.nodes, nodes, membrane.prestress);
    for (std::size_t k = 0; k < 3; ++k) force[nodes[k]] += forces[k];
  }
  return force;
}

FrozenNet freeze(const model::Model& structure, const std::vector<bool>& found,
                 const std::vector<double>& yielding) {
  FrozenNet net;
  net.group.name = "net";
  net.group.cable.axial_stiffness = 1;
  const int group = static_cast<int>(structure.groups.size());
  for (std::size_t i = 0; i < structure.cables.size(); ++i) {
    const auto& cable = structure.cables[i];
    if (!found[static_cast<std::size_t>(cable.group)]) continue;
    const double own = structure.axial_stiffness(cable), tension = own * cable.initial_strain;
    if (std::isinf(yielding[i]))
      net.cables.push_back(cable);
    else if (tension > 0)
      net.cables.push_back(
          taut_cable(cable.nodes, group, tension,
                     std::min(own, (getenv("CORD") && found[0] == false ? 1 : 1) * yielding[i] * tension)));
  }
  for (const auto& membrane : structure.membranes)
    if (found[static_cast<std::size_t>(membrane.group)])
      add_sides(structure.nodes, membrane, group, net.cables);
  net.pull.assign(structure.nodes.size(), Vec3::Zero());
  for (const auto& cable : net.cables) {
    const double stiffness = cable.group == group ? cable.stiffness_factor : structure.axial_stiffness(cable);
    const bool pulls = cable.group == group || model::only_pulls(structure, cable);
    const double tension = stiffness * (pulls ? std::max(0.0, cable.initial_strain) : cable.initial_strain);
    const auto [a, b] = cable.nodes;
    const Vec3 along = tension * (structure.nodes[b] - structure.nodes[a]).normalized();
    net.pull[a] += along;
    net.pull[b] -= along;
  }
  return net;
}

}  // namespace tautline::steps
