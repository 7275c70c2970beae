// What acts: from the loads of a boundary to forces on nodes, pressures of facets and changes of temperature.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include <fmt/format.h>

#include <tautline/assembly/system.hpp>
#include <tautline/core/error.hpp>
#include <tautline/model/element_data.hpp>
#include <tautline/model/names.hpp>

#include "assembly/contribution.hpp"

namespace tautline::assembly {

using namespace model;

namespace {

/// Half of a dead line load to each end; a beam's end moments make the cubic deflection work with it.
void add_line(const Model& model, int a, int b, bool bends, const Load& load, Acting& to) {
  const Vec3 way = model.nodes[b] - model.nodes[a];
  const double half = way.norm() / 2;
  to.force[a] += half * load.line_force;
  to.force[b] += half * load.line_force;
  to.moment[a] += half * load.line_moment;
  to.moment[b] += half * load.line_moment;
  if (!bends) return;
  const Vec3 end_moment = way.norm() / 12 * way.cross(load.line_force);
  to.moment[a] += end_moment;
  to.moment[b] -= end_moment;
}

/// A dead surface load shared out by the shape functions: a uniform mass under that acceleration.
template <class Facet>
void add_surface(const Model& model, const Facet& facet, const Vec3& load, Acting& to) {
  const auto share = [&](const auto& mass, int n) {
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) to.force[facet.nodes[i]] += mass(3 * i, 3 * j) * load;
  };
  if (facet.nodes.size() == 3)
    share(element::membrane_mass<3>(1, reference_nodes<3>(model, facet.nodes)), 3);
  else
    share(element::membrane_mass<4>(1, reference_nodes<4>(model, facet.nodes)), 4);
}

/// Weight of an element as drawn: its mass under the acceleration.
template <class Element>
void add_weight(const Model& model, const State& drawn, const Element& element, const Vec3& acceleration,
                Acting& to) {
  const auto mass = mass_of(model, drawn, element, MassKind::consistent);
  const int n = static_cast<int>(element.nodes.size()), stride = static_cast<int>(mass.rows()) / n;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      to.force[element.nodes[i]] += mass.template block<3, 3>(stride * i, stride * j) * acceleration;
      if (stride == 6)
        to.moment[element.nodes[i]] += mass.template block<3, 3>(stride * i + 3, stride * j) * acceleration;
    }
}

/// Weight of everything but catenaries, which feel it along their length. Cables weigh what is cut for the
/// initial strains in `to`.
void add_weights(const Model& model, Acting& to) {
  if (to.acceleration.isZero(0)) return;
  const State drawn = State::reference(model);
  const auto add = [&](const auto& element) { add_weight(model, drawn, element, to.acceleration, to); };
  for (std::size_t i = 0; i < model.cables.size(); ++i) {
    Cable cable = model.cables[i];
    cable.initial_strain = to.strain[i];
    if (model.groups[cable.group].kind != ElementKind::catenary) add(cable);
  }
  for (const auto& beam : model.beams) add(beam);
  for (const auto& membrane : model.membranes) add(membrane);
  for (const auto& shell : model.shells) add(shell);
  for (const auto& mass : model.masses) add(mass);
  for (std::size_t i = 0; i < model.beams.size(); ++i)
    to.line[model.cables.size() + i] += beam_section(model, model.beams[i]).mass_per_length * to.acceleration;
}

/// Mean of a field over a line, by Simpson's rule: exact up to the third power.
double mean_over(const std::function<double(const Vec3&)>& field, const Model& model,
                 const std::array<int, 2>& nodes) {
  const Vec3 &a = model.nodes[nodes[0]], &b = model.nodes[nodes[1]];
  return (field(a) + 4 * field((a + b) / 2) + field(b)) / 6;
}

/// Mean of a field over a facet, exact up to the second power of the place on a plane one: of the middles of
/// a triangle's sides; of the points of Gauss's rule of a quadrilateral, each with the area that it stands
/// for.
double mean_over(const std::function<double(const Vec3&)>& field, const Model& model,
                 const FacetNodes& nodes) {
  const auto x = [&](std::size_t i) -> const Vec3& { return model.nodes[nodes[static_cast<int>(i)]]; };
  double sum = 0;
  if (nodes.size() == 3) {
    for (std::size_t i = 0; i < 3; ++i) sum += field((x(i) + x((i + 1) % 3)) / 2) / 3;
    return sum;
  }
  double area = 0;
  const double g = 1 / std::sqrt(3.0);
  for (const double r : {-g, g})
    for (const double s : {-g, g}) {
      const Vec3 by_r = (1 - s) * (x(1) - x(0)) + (1 + s) * (x(2) - x(3)),
                 by_s = (1 - r) * (x(3) - x(0)) + (1 + r) * (x(2) - x(1));
      const double share = by_r.cross(by_s).norm();
      area += share;
      sum += share * field(((1 - r) * (1 - s) * x(0) + (1 + r) * (1 - s) * x(1) + (1 + r) * (1 + s) * x(2) +
                            (1 - r) * (1 + s) * x(3)) /
                           4);
    }
  return sum / area;
}

/// Changes of temperature of the elements that a load names, behind those of `first` elements.
template <class Element>
void add_temperature(const Model& model, const std::vector<Element>& elements,
                     const std::vector<int>& selected, const Load& load, std::size_t first, Acting& to) {
  for (const int i : selected) {
    double& change = to.temperature[first + static_cast<std::size_t>(i)];
    change += load.temperature_change;
    if (!load.temperature_field) continue;
    const auto& nodes = elements[static_cast<std::size_t>(i)].nodes;
    const double mean = mean_over(load.temperature_field, model, nodes);
    if (!std::isfinite(mean))
      throw ModelError(fmt::format("{}: temperature_field has no value within the element at {}",
                                   load.title(), model::node_in_group(model, *std::begin(nodes))));
    change += mean;
  }
}

void add_temperatures(const Model& model, const Selection& selected, const Load& load, Acting& to) {
  std::size_t first = 0;
  const auto add = [&](const auto& elements, const std::vector<int>& indices) {
    add_temperature(model, elements, indices, load, first, to);
    first += elements.size();
  };
  add(model.cables, selected.cables);
  add(model.beams, selected.beams);
  add(model.membranes, selected.membranes);
  add(model.shells, selected.shells);
  if (!load.temperature_gradient) return;
  for (const int i : selected.beams) {
    const auto& [a, b] = model.beams[i].nodes;
    const Vec3 middle = (model.nodes[a] + model.nodes[b]) / 2, gradient = load.temperature_gradient(middle);
    if (!gradient.allFinite())
      throw ModelError(
          fmt::format("{}: temperature_field has no slope at ({:.4g}, {:.4g}, {:.4g}), the middle of a "
                      "beam, which bends with it",
                      load.title(), middle.x(), middle.y(), middle.z()));
    to.temperature_gradient[static_cast<std::size_t>(i)] += gradient;
  }
}

}  // namespace

void System::add_element_loads(const Load& load, Acting& to) const {
  const auto selected = model_.select(load.on);
  for (const int i : selected.cables) {
    const auto& cable = model_.cables[i];
    if (model_.groups[cable.group].kind == ElementKind::catenary)
      to.line[static_cast<std::size_t>(i)] += load.line_force;
    else
      add_line(model_, cable.nodes[0], cable.nodes[1], false, load, to);
  }
  for (const int i : selected.beams) {
    const auto& [a, b] = model_.beams[i].nodes;
    add_line(model_, a, b, true, load, to);
    to.line[model_.cables.size() + static_cast<std::size_t>(i)] += load.line_force;
  }
  for (const auto& [a, b] : selected.edges) add_line(model_, a, b, false, load, to);
  for (const int i : selected.membranes) {
    add_surface(model_, model_.membranes[i], load.surface_force, to);
    to.pressure[static_cast<std::size_t>(i)] += load.pressure;
  }
  for (const int i : selected.shells) {
    add_surface(model_, model_.shells[i], load.surface_force, to);
    to.pressure[model_.membranes.size() + static_cast<std::size_t>(i)] += load.pressure;
  }
  if (load.heats()) add_temperatures(model_, selected, load, to);
}

Acting System::acting(const Boundary& boundary, const std::vector<double>& strains) const {
  const std::size_t n_facets = model_.membranes.size() + model_.shells.size(),
                    n_lines = model_.cables.size() + model_.beams.size();
  Acting result{Points(model_.nodes.size(), Vec3::Zero()),
                Points(model_.nodes.size(), Vec3::Zero()),
                Points(n_lines, Vec3::Zero()),
                std::vector<double>(n_facets, 0.0),
                std::vector<double>(n_lines + n_facets, 0.0),
                Points(model_.beams.size(), Vec3::Zero()),
                strains,
                Vec3::Zero()};
  for (const auto& load : boundary.loads) {
    for (const int node : load.nodes) {
      result.force[node] += load.force;
      result.moment[node] += load.moment;
    }
    add_element_loads(load, result);
    result.acceleration += load.acceleration;
  }
  add_weights(model_, result);
  return result;
}

System::NodalForces System::ground_springs() const {
  NodalForces result{Points(model_.nodes.size(), Vec3::Zero()), Points(model_.nodes.size(), Vec3::Zero())};
  for (const auto& spring : model_.springs) {
    if (!spring.grounded()) continue;
    const auto force = contribution(model_, state_, spring, element::Want::force).force;
    result.force[spring.nodes[0]] -= force.segment<3>(0);
    if (force.size() == 6) result.moment[spring.nodes[0]] -= force.segment<3>(3);
  }
  return result;
}

System::NodalForces System::external() const {
  NodalForces result{Points(model_.nodes.size()), Points(model_.nodes.size())};
  for (int node = 0; node < static_cast<int>(model_.nodes.size()); ++node) {
    const Vec<6> load = dead_load(node);
    result.force[node] = load.head<3>();
    result.moment[node] = load.tail<3>();
  }
  const auto add_pressure = [&](const auto& facets, std::size_t first) {
    for (std::size_t i = 0; i < facets.size(); ++i) {
      const double pressure = now_.pressure[first + i];
      if (pressure == 0) continue;
      const auto c = pressure_contribution(model_, state_, facets[i].nodes, pressure, element::Want::force);
      for (int k = 0; k < facets[i].nodes.size(); ++k)
        result.force[facets[i].nodes[k]] += c.force.template segment<3>(3 * k);
    }
  };
  add_pressure(model_.membranes, 0);
  add_pressure(model_.shells, model_.membranes.size());
  return result;
}

System::NodalForces System::applied() const {
  NodalForces result = external();
  for (const auto& cable : model_.cables) {
    if (model_.groups[cable.group].kind != ElementKind::catenary) continue;
    // The catenary's end forces, weight included; at the ends they add up to the weight turned round.
    const auto force = contribution(model_, state_, cable, element::Want::force).force;
    const Vec3 weight = -(force.segment<3>(0) + force.segment<3>(3));
    Vec3 moment = Vec3::Zero();
    for (int k = 0; k < 2; ++k) {
      const int node = cable.nodes[static_cast<std::size_t>(k)];
      result.force[node] += weight / 2;
      moment -= (model_.nodes[node] + state_.displacement[node]).cross(force.segment<3>(3 * k) + weight / 2);
    }
    result.moment[cable.nodes[0]] += moment;
  }
  return result;
}

}  // namespace tautline::assembly
