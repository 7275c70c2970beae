#include "assembly/load_audit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/model/element_data.hpp>
#include <tautline/model/names.hpp>

#include "assembly/contribution.hpp"
#include "assembly/expansion.hpp"

namespace tautline::assembly {

using namespace model;

namespace {

/// A piece of an element: where it is, its length or area, and of facets the area as a vector along the
/// normal.
struct Piece {
  Vec3 at;
  double size = 0;
  Vec3 area = Vec3::Zero();
};

Piece middle_of(const Model& model, const std::array<int, 2>& nodes) {
  const Vec3 &a = model.nodes[nodes[0]], &b = model.nodes[nodes[1]];
  return {(a + b) / 2, (b - a).norm()};
}

/// Of a triangle one piece, of a quadrilateral, bilinear between its corners, the four of Gauss's rule.
std::vector<Piece> pieces_of(const Model& model, const FacetNodes& nodes) {
  const auto x = [&](int i) -> const Vec3& { return model.nodes[nodes[i]]; };
  if (nodes.size() == 3) {
    const Vec3 area = (x(1) - x(0)).cross(x(2) - x(0)) / 2;
    return {{(x(0) + x(1) + x(2)) / 3, area.norm(), area}};
  }
  const Vec3 centre = (x(0) + x(1) + x(2) + x(3)) / 4, along = (x(1) + x(2) - x(0) - x(3)) / 4,
             across = (x(2) + x(3) - x(0) - x(1)) / 4, twist = (x(0) + x(2) - x(1) - x(3)) / 4;
  std::vector<Piece> pieces;
  for (const double r : {-std::sqrt(1.0 / 3), std::sqrt(1.0 / 3)})
    for (const double s : {-std::sqrt(1.0 / 3), std::sqrt(1.0 / 3)}) {
      const Vec3 area = (along + s * twist).cross(across + r * twist);
      pieces.push_back({centre + r * along + s * across + r * s * twist, area.norm(), area});
    }
  return pieces;
}

void add_lines(const Model& model, const Selection& selected, const Load& load, LoadSum& sum) {
  const auto add = [&](const std::array<int, 2>& nodes) {
    const Piece line = middle_of(model, nodes);
    sum.add(line.at, line.size * load.line_force, line.size * load.line_moment);
  };
  for (const int i : selected.cables) add(model.cables[i].nodes);
  for (const int i : selected.beams) add(model.beams[i].nodes);
  for (const auto& edge : selected.edges) add(edge);
}

void add_facets(const Model& model, const Selection& selected, const Load& load, LoadSum& sum) {
  const auto add = [&](const FacetNodes& nodes) {
    for (const Piece& piece : pieces_of(model, nodes))
      sum.add(piece.at, piece.size * load.surface_force + load.pressure * piece.area);
  };
  for (const int i : selected.membranes) add(model.membranes[i].nodes);
  for (const int i : selected.shells) add(model.shells[i].nodes);
}

void add_weight(const Model& model, const std::vector<double>& strains, const Vec3& acceleration,
                LoadSum& sum) {
  const auto add = [&](const Piece& piece, double density) {
    sum.add(piece.at, density * piece.size * acceleration);
  };
  for (std::size_t i = 0; i < model.cables.size(); ++i)
    add(middle_of(model, model.cables[i].nodes),
        model.groups[model.cables[i].group].cable.mass_per_length / (1 + strains[i]));
  for (const auto& beam : model.beams)
    add(middle_of(model, beam.nodes), beam_section(model, beam).mass_per_length);
  for (const auto& m : model.membranes)
    for (const Piece& piece : pieces_of(model, m.nodes))
      add(piece, model.groups[m.group].membrane.mass_per_area);
  for (const auto& s : model.shells)
    for (const Piece& piece : pieces_of(model, s.nodes))
      add(piece, model.groups[s.group].shell.density * model.groups[s.group].shell.thickness);
  for (const auto& point : model.masses)
    add({model.nodes[point.nodes[0]], 1}, model.groups[point.group].mass.mass);
}

void add_heat(const Model& model, const Selection& selected, const Load& load, LoadSum& sum) {
  const auto at = [&](const Vec3& x) {
    return load.temperature_change + (load.temperature_field ? load.temperature_field(x) : 0);
  };
  const auto add = [&](double size, const Vec3& x) {
    const double heat = size * at(x);
    sum.heat += heat;
    sum.heat_size += std::abs(heat);
  };
  const auto add_line = [&](const std::array<int, 2>& nodes) {
    const Piece line = middle_of(model, nodes);
    add(line.size / 6, model.nodes[nodes[0]]);
    add(line.size / 1.5, line.at);
    add(line.size / 6, model.nodes[nodes[1]]);
  };
  const auto add_facet = [&](const FacetNodes& nodes) {
    if (nodes.size() == 4) {
      for (const Piece& piece : pieces_of(model, nodes)) add(piece.size, piece.at);
      return;
    }
    const double third = pieces_of(model, nodes).front().size / 3;
    for (int i = 0; i < 3; ++i) add(third, middle_of(model, {nodes[i], nodes[(i + 1) % 3]}).at);
  };
  for (const int i : selected.cables) add_line(model.cables[i].nodes);
  for (const int i : selected.beams) add_line(model.beams[i].nodes);
  for (const int i : selected.membranes) add_facet(model.membranes[i].nodes);
  for (const int i : selected.shells) add_facet(model.shells[i].nodes);
}

/// Temperatures of what acts, times the sizes of the elements.
double heat_of(const Model& model, const Acting& acting) {
  double sum = 0;
  std::size_t next = 0;
  for (const auto& cable : model.cables)
    sum += acting.temperature[next++] * middle_of(model, cable.nodes).size;
  for (const auto& beam : model.beams) sum += acting.temperature[next++] * middle_of(model, beam.nodes).size;
  const auto add = [&](const auto& facets) {
    for (const auto& facet : facets) {
      const double temperature = acting.temperature[next++];
      for (const Piece& piece : pieces_of(model, facet.nodes)) sum += temperature * piece.size;
    }
  };
  add(model.membranes);
  add(model.shells);
  return sum;
}

/// Rigid motions: a displacement of the origin and a spin.
struct RigidMotion {
  Vec3 displacement, spin;
  Vec3 at(const Vec3& x) const { return displacement + spin.cross(x); }
};

/// The six rigid motions that linear constraints and cyclic pairs allow.
std::vector<RigidMotion> rigid_motions(const Model& model, double size) {
  std::vector<RigidMotion> motions;
  const double small = 1e-9 * size;
  for (int k = 0; k < 6; ++k) {
    const RigidMotion motion{k < 3 ? Vec3(size * Vec3::Unit(k)) : Vec3(Vec3::Zero()),
                             k < 3 ? Vec3(Vec3::Zero()) : Vec3(Vec3::Unit(k - 3))};
    bool allowed = true;
    for (const auto& constraint : model.constraints) {
      double sum = 0, most = 0;
      for (const auto& term : constraint.terms) {
        sum += term.coefficient * motion.at(model.nodes[term.node])[term.component];
        most = std::max(most, std::abs(term.coefficient));
      }
      allowed = allowed && std::abs(sum) <= small * most;
    }
    for (const auto& pair : model.cyclic_pairs)
      allowed =
          allowed &&
          (motion.at(model.nodes[pair.follower]) - pair.turn * motion.at(model.nodes[pair.leader])).norm() <=
              small;
    if (allowed) motions.push_back(motion);
  }
  return motions;
}

/// Forces on the unknowns of the structure as drawn; loads along catenaries go by halves to their ends.
std::vector<double> assembled(const Model& model, const DofMap& map, const Kinematics& drawn,
                              const Acting& acting) {
  std::vector<double> force(static_cast<std::size_t>(3 * map.layout.total), 0.0);
  Points dead = acting.force;
  const State state = State::reference(model);
  for (std::size_t i = 0; i < model.cables.size(); ++i) {
    const auto& cable = model.cables[i];
    if (model.groups[cable.group].kind != ElementKind::catenary) continue;
    Cable loaded = cable;
    loaded.initial_strain = acting.strain[i];
    loaded.line_load = acting.line[i];
    const auto properties = catenary_properties(model, loaded);
    const Vec3 half = (properties.mass_per_length * acting.acceleration + properties.line_load) *
                      (properties.unstressed_length / 2);
    for (const int node : cable.nodes) dead[node] += half;
  }
  for (int node = 0; node < static_cast<int>(model.nodes.size()); ++node) {
    Vec<6> load;
    load << dead[node], acting.moment[node];
    if (load.isZero(0)) continue;
    const bool turns = map.rotational[node];
    Expansion(drawn, map, std::array<int, 1>{node}, turns).add(load.head(turns ? 6 : 3).eval(), force);
  }
  std::size_t next = 0;
  const auto press = [&](const auto& facets) {
    for (const auto& facet : facets) {
      const double pressure = acting.pressure[next++];
      if (pressure == 0) continue;
      const auto c = pressure_contribution(model, state, facet.nodes, pressure, element::Want::force);
      Expansion(drawn, map, facet.nodes, false).add(c.force, force);
    }
  };
  press(model.membranes);
  press(model.shells);
  return force;
}

/// Virtual work of forces on the unknowns in a rigid motion of the structure as drawn.
double work_of(const std::vector<double>& force, const Model& model, const DofMap& map,
               const Kinematics& drawn, const RigidMotion& motion) {
  double sum = 0;
  const auto add = [&](int block, const Vec3& increment) {
    if (block < 0) return;
    sum += Eigen::Map<const Vec3>(&force[static_cast<std::size_t>(3 * block)])
               .dot(drawn.unknown_of(block, increment));
  };
  for (std::size_t node = 0; node < model.nodes.size(); ++node) {
    add(map.displacement_block[node], motion.at(model.nodes[node]));
    const int link = drawn.link_of(static_cast<int>(node));
    const bool is_hinge = link >= 0 && !model.links[static_cast<std::size_t>(link)].rotation_free;
    if (!is_hinge) add(map.rotation_block[node], motion.spin);
  }
  for (const auto& first : drawn.constrained()) {  // moves by the others alone
    const int unknown = 3 * map.displacement_block[first.node] + first.component;
    sum -= force[static_cast<std::size_t>(unknown)] * motion.at(model.nodes[first.node])[first.component];
  }
  return sum;
}

}  // namespace

void LoadSum::add(const Vec3& at, const Vec3& f, const Vec3& m) {
  force += f;
  moment += at.cross(f) + m;
  force_size += f.norm();
  moment_size += at.norm() * f.norm() + m.norm();
}

void add_definition(const Model& model, const std::vector<double>& strains, const Load& load, LoadSum& sum) {
  for (const int node : load.nodes) sum.add(model.nodes[node], load.force, load.moment);
  const Selection selected = model.select(load.on);
  if (!load.line_force.isZero(0) || !load.line_moment.isZero(0)) add_lines(model, selected, load, sum);
  if (!load.surface_force.isZero(0) || load.pressure != 0) add_facets(model, selected, load, sum);
  if (!load.acceleration.isZero(0)) add_weight(model, strains, load.acceleration, sum);
  if (load.heats()) add_heat(model, selected, load, sum);
}

namespace {

/// Where each name begins in a list of loads, and the end.
std::vector<std::size_t> names_of(const std::vector<Load>& loads) {
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < loads.size(); ++i)
    if (i == 0 || loads[i].name != loads[i - 1].name) starts.push_back(i);
  starts.push_back(loads.size());
  return starts;
}

/// The loads of each name times what makes all names about as large, and no two alike: in a sum none is lost
/// beside larger ones, nor what two of them lack against each other.
std::vector<Load> evened(const Model& model, const std::vector<double>& strains, double size,
                         std::vector<Load> loads) {
  const auto names = names_of(loads);
  for (std::size_t k = 0; k + 1 < names.size(); ++k) {
    LoadSum sum;
    for (std::size_t i = names[k]; i < names[k + 1]; ++i) add_definition(model, strains, loads[i], sum);
    const double force = sum.force_size + sum.moment_size / size, whole = force > 0 ? force : sum.heat_size;
    if (whole == 0) continue;
    const double factor = (1.5 + std::sin(1.3 * static_cast<double>(k))) / whole;
    for (std::size_t i = names[k]; i < names[k + 1]; ++i) loads[i] = scaled(loads[i], factor);
  }
  return loads;
}

/// The first of the names [first, last) whose loads do not arrive, if `wrong(first, last)` of the sum of
/// some.
std::size_t first_wrong(std::size_t first, std::size_t last,
                        const std::function<bool(std::size_t, std::size_t)>& wrong) {
  if (!wrong(first, last)) return last;
  while (last - first > 1) {
    const std::size_t middle = (first + last) / 2;
    (wrong(first, middle) ? last : first) = middle;
  }
  return first;
}

}  // namespace

std::string System::load_fault(const std::vector<Load>& loads, const std::vector<double>& strains) const {
  constexpr double rounding = 1e-10;
  std::string fault;
  const auto compare = [&](const char* what, double defined, double found, double size) {
    if (fault.empty() && !(std::abs(found - defined) <= rounding * size))
      fault = fmt::format("{} is {:.10g} by its definition, but {:.10g} acts on the structure", what, defined,
                          found);
  };
  LoadSum sum;
  for (const auto& load : loads) add_definition(model_, strains, load, sum);
  const Acting alone = acting({{}, loads}, strains);
  compare("the sum of temperature times size", sum.heat, heat_of(model_, alone), sum.heat_size);
  if (sum.force_size == 0 && sum.moment_size == 0) return fault;
  const Kinematics drawn(model_, map_);  // without supports, at rest
  const auto force = assembled(model_, map_, drawn, alone);
  for (const auto& motion : rigid_motions(model_, size_)) {
    const double way = motion.displacement.norm(), spin = motion.spin.norm();
    compare(spin == 0 ? "its force times the size of the structure" : "its moment about an axis",
            sum.force.dot(motion.displacement) + sum.moment.dot(motion.spin),
            work_of(force, model_, map_, drawn, motion),
            sum.force_size * (way + size_ * spin) + sum.moment_size * spin);
  }
  return fault;
}

void System::audit_loads(const Boundary& boundary, const std::vector<double>& strains) const {
  constexpr std::size_t most = 16;  // sums looked at, however many names there are
  const auto& loads = boundary.loads;
  const auto names = names_of(loads);
  const std::size_t n = names.size() - 1, in_one = (n + most - 1) / most;
  if (n == 0) return;
  const auto fault_of = [&](const std::vector<Load>& from, std::size_t first, std::size_t last) {
    const auto at = [&](std::size_t name) { return from.begin() + static_cast<std::ptrdiff_t>(names[name]); };
    return load_fault({at(first), at(last)}, strains);
  };
  const auto even = in_one > 1 ? evened(model_, strains, size_, loads) : loads;
  for (std::size_t first = 0; first < n; first += in_one) {
    const std::size_t end = std::min(first + in_one, n),
                      name = first_wrong(first, end, [&](std::size_t a, std::size_t b) {
                        return !fault_of(even, a, b).empty();
                      });
    if (name == end) continue;
    const auto fault = fault_of(loads, name, name + 1);
    if (!fault.empty()) throw std::logic_error(fmt::format("{}: {}", loads[names[name]].title(), fault));
  }
}

void check_motions(const Model& model, const Boundary& boundary, const DofMap& map,
                   const Kinematics& kinematics) {
  const auto refuse = [&](const Load& load, int node, const char* why) {
    throw ModelError(fmt::format("{} moves {}, {}", load.title(), model::node_in_group(model, node), why));
  };
  const auto check = [&](const Load& load, int node, int block, const Vec3& motion) {
    const auto& held = kinematics.held();
    const auto first = static_cast<std::size_t>(3 * block);
    if (motion.isZero(0) && (block < 0 || !(held[first] || held[first + 1] || held[first + 2])))
      refuse(load, node, "which no support holds: it would stay free");
  };
  for (const auto& load : boundary.loads)
    for (const int node : load.nodes) {
      if (load.displacement) check(load, node, map.displacement_block[node], *load.displacement);
      if (load.rotation) check(load, node, map.rotation_block[node], *load.rotation);
      if (load.displacement)
        for (const auto& first : kinematics.constrained())
          if (first.node == node && (*load.displacement)[first.component] != 0)
            refuse(load, node, "which follows from a linear constraint in that direction: move the others");
      const int link = kinematics.link_of(node);
      if (load.rotation && link >= 0 && map.rotation_block[node] >= 0 && !kinematics.rotation_is_free(link))
        refuse(load, node, "which turns about a hinge of another node: turn that one");
    }
}

}  // namespace tautline::assembly
