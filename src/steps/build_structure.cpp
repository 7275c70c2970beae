#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/core/expression.hpp>
#include <tautline/element/beam.hpp>
#include <tautline/element/membrane.hpp>
#include <tautline/mesh/imported_mesh.hpp>
#include <tautline/model/names.hpp>
#include <tautline/model/section.hpp>
#include <tautline/reflector/perimeter_truss.hpp>
#include <tautline/reflector/tensegrity_rim.hpp>
#include <tautline/reflector/umbrella.hpp>
#include <tautline/reflector/y_umbrella.hpp>

#include "steps/context.hpp"

namespace tautline::steps {

namespace {

/// Adds elements of one group; the kind follows from the group's section.
class ElementAdder {
 public:
  ElementAdder(model::Model& model, const std::string& group, const deck::Deck& deck)
      : model_(model), group_(model.find_group(group)) {
    if (group_ < 0)
      throw ModelError(
          fmt::format("group \"{}\" has elements but no section: give it one under \"groups\"", group));
    section_ = &deck.sections.at(deck.groups.at(group).section);
  }

  void operator()(const std::vector<int>& n) const {
    using model::ElementKind;
    const auto kind = model_.groups[group_].kind;
    const std::size_t size = n.size();
    if (model::is_cable_like(kind) && size == 2)
      model_.cables.push_back({{n[0], n[1]}, group_});
    else if (kind == ElementKind::beam && size == 2)
      model_.beams.push_back({{n[0], n[1]}, group_});
    else if (kind == ElementKind::membrane && (size == 3 || size == 4))
      model_.membranes.push_back({facet(n), group_});
    else if (kind == ElementKind::shell && (size == 3 || size == 4))
      add_shell(n);
    else if (kind == ElementKind::spring && size <= 2)
      model_.springs.push_back({n, group_});
    else if (kind == ElementKind::mass && size == 1)
      model_.masses.push_back({{n[0]}, group_});
    else if (kind == ElementKind::link && size == 2)
      add_link(n[0], n[1]);
    else
      throw ModelError(fmt::format("group \"{}\" has elements of {} node{}, which its section is not for",
                                   model_.groups[group_].name, size, size == 1 ? "" : "s"));
  }

 private:
  static model::FacetNodes facet(const std::vector<int>& n) {
    return n.size() == 3 ? model::FacetNodes(n[0], n[1], n[2]) : model::FacetNodes(n[0], n[1], n[2], n[3]);
  }

  void add_shell(const std::vector<int>& n) const {
    auto& shell = model_.shells.emplace_back();
    shell.nodes = facet(n);
    shell.group = group_;
  }

  void add_link(int leader, int follower) const {
    model::Link link{leader, follower, false, {}, group_};
    if (const auto* rigid = std::get_if<model::RigidLinkSectionOptions>(section_))
      link.rotation_free = !rigid->rotation;
    if (const auto* hinge = std::get_if<model::HingeSectionOptions>(section_)) {
      link.rotation_free = !hinge->axis;
      if (hinge->axis) link.hinge = {hinge->axis->normalized()};
    }
    model_.links.push_back(link);
  }

  model::Model& model_;
  int group_;
  const model::SectionOptions* section_;
};

void declare_groups(model::Model& model, const deck::Deck& deck) {
  for (const auto& [name, options] : deck.groups) {
    if (options.section.empty() || model.find_group(name) >= 0) continue;
    model.groups.emplace_back().name = name;
    model.groups.back().kind = model::kind_of(deck.sections.at(options.section));
  }
}

void add_edge(model::Selection& selection, const std::array<int, 2>& edge) {
  selection.edges.push_back(edge);
  selection.nodes.insert(selection.nodes.end(), edge.begin(), edge.end());
}

void add_inline(model::Model& model, const model::ModelOptions& options, const deck::Deck& deck) {
  std::map<std::string, int> index;
  for (const auto& [name, position] : options.nodes) {
    index[name] = static_cast<int>(model.nodes.size());
    model.nodes.push_back(position);
    model.node_names.push_back(name);
  }
  for (const auto& block : options.elements) {
    ElementAdder add(model, block.group, deck);
    for (const auto& names : block.connectivity) {
      std::vector<int> nodes;
      for (const auto& name : names) nodes.push_back(index.at(name));
      add(nodes);
    }
  }
  for (const auto& [name, group] : deck.groups) {
    for (const auto& node : group.nodes) model.selections[name].nodes.push_back(index.at(node));
    for (const auto& [a, b] : group.edges) add_edge(model.selections[name], {index.at(a), index.at(b)});
  }
  for (const auto& constraint : options.constraints) {
    auto& made = model.constraints.emplace_back();
    made.where = constraint.where;
    for (const auto& term : constraint.terms)
      made.terms.push_back({index.at(term.node), term.component, term.coefficient});
  }
}

void add_mesh(model::Model& model, const std::string& file, const deck::Deck& deck) {
  const auto mesh = mesh::import_gmsh(file);
  const int offset = static_cast<int>(model.nodes.size());
  model.nodes.insert(model.nodes.end(), mesh.nodes.begin(), mesh.nodes.end());
  for (const auto& [name, cells] : mesh.groups) {
    const bool has_section = model.find_group(name) >= 0;
    const auto each = [&](const auto& list, const auto& action) {
      for (const auto& cell : list) {
        std::vector<int> nodes;
        for (const int node : cell) nodes.push_back(offset + node);
        action(nodes);
      }
    };
    if (has_section) {  // points are elements only where the section wants points
      ElementAdder add(model, name, deck);
      const auto kind = model.groups[model.find_group(name)].kind;
      if (kind == model::ElementKind::mass || kind == model::ElementKind::spring)
        for (const int node : cells.points) add({offset + node});
      each(cells.lines, add);
      each(cells.triangles, add);
      each(cells.quadrilaterals, add);
      if (kind == model::ElementKind::mass || kind == model::ElementKind::spring) continue;
    } else {  // a physical group without section only names nodes and edges
      auto& selection = model.selections[name];
      each(cells.lines, [&](const auto& n) { add_edge(selection, {n[0], n[1]}); });
      const auto note = [&](const auto& n) {
        selection.nodes.insert(selection.nodes.end(), n.begin(), n.end());
      };
      each(cells.triangles, note);
      each(cells.quadrilaterals, note);
    }
    for (const int node : cells.points) model.selections[name].nodes.push_back(offset + node);
  }
}

void check_sections(const model::Model& model, const deck::Deck& deck) {
  for (const auto& group : model.groups) {
    const auto found = deck.groups.find(group.name);
    if (found == deck.groups.end() || found->second.section.empty())
      throw ModelError(
          fmt::format("group \"{}\" of the structure has no section: add it under \"groups\"", group.name));
    const auto kind = model::kind_of(deck.sections.at(found->second.section));
    if (kind != group.kind)
      throw ModelError(fmt::format("group \"{}\": section \"{}\" is for another kind of element", group.name,
                                   found->second.section));
  }
  if (deck.dish()) return;  // a part of a reflector may be switched off while the deck still describes it
  for (const auto& [name, options] : deck.groups) {
    const int group = model.find_group(name);
    const auto in = [&](const auto& elements) {
      return std::any_of(elements.begin(), elements.end(), [&](const auto& e) { return e.group == group; });
    };
    bool used = std::any_of(model.links.begin(), model.links.end(),
                            [&](const model::Link& link) { return link.group == group; });
    model::for_each_kind(model, [&](const auto& elements) { used = used || in(elements); });
    if (!options.section.empty() && !used)
      throw ModelError(
          fmt::format("{}group \"{}\" has a section but no elements: the structure has none of that name",
                      model::prefix(options.where), name));
  }
}

void give_sections(model::Model& model, const deck::Deck& deck) {
  for (std::size_t i = 0; i < model.groups.size(); ++i) {
    auto& group = model.groups[i];
    const auto& options = deck.groups.at(group.name);
    model::set_section(group, deck.sections.at(options.section), deck.materials);
    if (options.orientation) group.orientation = *options.orientation;
    if (options.tension) group.target_tension = *options.tension;
    double thickness = group.shell.thickness;
    if (const auto* cloth = std::get_if<model::MembraneSectionOptions>(&deck.sections.at(options.section)))
      thickness = cloth->thickness.value_or(0);
    model::set_initial_state(model, static_cast<int>(i), options, thickness);
  }
}

void find_frames(model::Model& model) {
  for (auto& beam : model.beams) {
    Mat<3, 2> x;
    x << model.nodes[beam.nodes[0]], model.nodes[beam.nodes[1]];
    beam.frame = element::beam_frame(x, model.groups[beam.group].orientation);
  }
}

/// Hangs the end of a beam on its node by an arm, a hinge, or both.
void detach_end(model::Model& model, model::Beam& beam, int end, const Vec3& offset,
                const model::EndRelease& release) {
  const auto& free = release.free;
  model::Link link{
      beam.nodes[end], static_cast<int>(model.nodes.size()), free[0] && free[1] && free[2], {}, -1};
  for (int axis = 0; axis < 3 && !link.rotation_free; ++axis)
    if (free[axis]) link.hinge.push_back(beam.frame.col(axis));
  model.nodes.push_back(model.nodes[link.leader] + offset);
  model.links.push_back(link);
  beam.nodes[end] = link.follower;
}

/// Offsets and releases of beam ends; frames follow the beams between their offset ends.
void detach_beams(model::Model& model, const deck::Deck& deck) {
  const std::size_t n_beams = model.beams.size();
  for (std::size_t i = 0; i < n_beams; ++i) {
    auto& beam = model.beams[i];
    const auto& options = deck.groups.at(model.groups[beam.group].name);
    const std::array offset{options.offset_start, options.offset_end};
    const std::array release{options.release_start, options.release_end};
    Mat<3, 2> x;
    x << model.nodes[beam.nodes[0]] + offset[0], model.nodes[beam.nodes[1]] + offset[1];
    beam.frame = element::beam_frame(x, model.groups[beam.group].orientation);
    for (int end = 0; end < 2; ++end)
      if (!offset[end].isZero(0) || release[end].any())
        detach_end(model, beam, end, offset[end], release[end]);
  }
}

/// Every element of the structure is its own parent.
void number_elements(model::Model& model) {
  model::for_each_kind(model, [](auto& elements) {
    int number = 0;
    for (auto& element : elements)
      if constexpr (requires { element.parent; }) element.parent = number++;
  });
}

/// A node on the axis is its own partner: it moves along the axis and turns about it only.
void hold_on_axis(model::Model& model, const Vec3& axis, const std::vector<int>& nodes) {
  if (nodes.empty()) return;
  auto& support = model.supports.emplace_back();
  support.name = "cyclic axis";
  support.nodes = nodes;
  support.fixed = {true, true, false, true, true, false};
  const Vec3 across = axis.unitOrthogonal();
  support.axes << across, axis.cross(across), axis;
}

/// Finds for every node of `to` the one of `from` that the turn brings there.
void add_cyclic(model::Model& model, const model::CyclicOptions& options) {
  const Vec3 axis = options.axis.normalized();
  const Mat3 turn = Eigen::AngleAxisd(options.angle * std::numbers::pi / 180, axis).toRotationMatrix();
  std::vector<int> on_axis;
  const auto leaders = model.nodes_of(options.from);
  double size = 0;
  for (const auto& node : model.nodes) size = std::max(size, (node - options.centre).norm());
  for (const int follower : model.nodes_of(options.to)) {
    const Vec3 wanted = options.centre + turn.transpose() * (model.nodes[follower] - options.centre);
    const auto found = std::find_if(leaders.begin(), leaders.end(), [&](int node) {
      return (model.nodes[node] - wanted).norm() <= 1e-6 * size;
    });
    if (found == leaders.end())
      throw ModelError(
          fmt::format("{}{} of \"to\" has no partner among the nodes of \"from\" turned "
                      "by {} degrees: it would be at ({:g}, {:g}, {:g})",
                      model::prefix(options.where), model::node_at(model, follower), options.angle,
                      wanted.x(), wanted.y(), wanted.z()));
    if (*found == follower)
      on_axis.push_back(follower);
    else
      model.cyclic_pairs.push_back({*found, follower, turn});
  }
  hold_on_axis(model, axis, on_axis);
}

/// Names in supports and loads are looked up where the deck mentions them.
std::vector<int> look_up(const model::Model& model, const std::vector<std::string>& names,
                         const SourceLocation& where) {
  try {
    return model.nodes_of(names);
  } catch (const ModelError& error) {
    throw ModelError(model::prefix(where) + error.what());
  }
}

/// A load on elements needs elements that it can act on.
void check_load_place(const model::Model& model, const model::LoadOptions& options) {
  const auto refuse = [&](const std::string& name, const char* key, const char* needs) {
    throw ModelError(fmt::format("{}load \"{}\": \"{}\" has no {}, on which {} acts",
                                 model::prefix(options.where), options.name, name, needs, key));
  };
  for (const auto& name : options.on) {
    const auto selected = model.select(name);
    const bool facets = !selected.membranes.empty() || !selected.shells.empty();
    const bool lines = !selected.beams.empty() || !selected.edges.empty();
    if (options.pressure && !facets) refuse(name, "pressure", "membranes or shells");
    if (options.surface_force && !facets) refuse(name, "surface_force", "membranes or shells");
    if (options.line_force && !lines && selected.cables.empty())
      refuse(name, "line_force", "beams, cables, bars or edges");
    if (options.line_moment && !lines) refuse(name, "line_moment", "beams or edges");
    const bool by_place = !options.temperature_field.empty();
    if (!options.temperature_change && !by_place) continue;
    const char* key = by_place ? "temperature_field" : "temperature_change";
    const int group = model.find_group(name);
    if (group < 0) refuse(name, key, "elements of its own");
    const auto& g = model.groups[group];
    if (g.thermal_expansion == 0 && g.membrane.thermal_expansion == 0 &&
        g.membrane.thermal_expansion_2 == 0 && g.shell.thermal_expansion == 0)
      refuse(name, key, "thermal_expansion in its section or material");
  }
}

/// The formula of a temperature, checked where it will be asked for.
std::function<double(const Vec3&)> temperature_field(const model::Model& model,
                                                     const model::LoadOptions& options) {
  if (options.temperature_field.empty()) return {};
  const SpaceFormula field(options.temperature_field);
  for (const int node : model.nodes_of(options.on)) {
    const Vec3& x = model.nodes[node];
    if (!std::isfinite(field(x)))
      throw ModelError(fmt::format(
          "{}load \"{}\": temperature_field \"{}\" has no value at ({:.4g}, {:.4g}, {:.4g})",
          model::prefix(options.where), options.name, options.temperature_field, x.x(), x.y(), x.z()));
  }
  return field;
}

model::Load make_load(const model::Model& model, const model::LoadOptions& options) {
  model::Load load;
  load.name = options.name;
  load.on = options.on;
  load.where = options.where;
  if (options.nodal()) load.nodes = look_up(model, options.on, options.where);
  look_up(model, options.on, options.where);
  check_load_place(model, options);
  load.force = options.force;
  load.moment = options.moment;
  load.displacement = options.displacement;
  load.rotation = options.rotation;
  load.line_force = options.line_force.value_or(Vec3::Zero());
  load.line_moment = options.line_moment.value_or(Vec3::Zero());
  load.surface_force = options.surface_force.value_or(Vec3::Zero());
  load.pressure = options.pressure.value_or(0);
  load.temperature_change = options.temperature_change.value_or(0);
  load.temperature_field = temperature_field(model, options);
  if (load.temperature_field)
    load.temperature_gradient = [field = SpaceFormula(options.temperature_field)](const Vec3& x) {
      return field.gradient(x);
    };
  load.acceleration = options.acceleration.value_or(Vec3::Zero());
  return load;
}

}  // namespace

model::Model build_structure(const deck::Deck& deck) {
  model::Model model;
  if (deck.truss()) {
    model = reflector::make_perimeter_truss(*deck.truss());
  } else if (deck.tensegrity_rim()) {
    model = reflector::make_tensegrity_rim(*deck.tensegrity_rim());
  } else if (deck.y_umbrella()) {
    model = reflector::make_y_umbrella(*deck.y_umbrella());
  } else if (deck.umbrella()) {
    model = reflector::make_umbrella(*deck.umbrella());
  } else {
    declare_groups(model, deck);
    add_inline(model, *deck.model, deck);
    if (!deck.model->mesh_file.empty()) add_mesh(model, deck.model->mesh_file, deck);
  }
  check_sections(model, deck);
  give_sections(model, deck);
  find_frames(model);
  number_elements(model);
  if (deck.model) {
    detach_beams(model, deck);
    for (const auto& cyclic : deck.model->cyclic) add_cyclic(model, cyclic);
  }
  for (const auto& support : deck.supports)
    model.supports.push_back({support.name, support.on, look_up(model, support.on, support.where),
                              support.fixed, support.axes, support.symmetry});
  add_loads(model, deck);
  return model;
}

void add_loads(model::Model& model, const deck::Deck& deck) {
  for (const auto& options : deck.loads) model.loads.push_back(make_load(model, options));
}

}  // namespace tautline::steps
