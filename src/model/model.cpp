#include <tautline/model/model.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/core/text.hpp>
#include <tautline/model/element_data.hpp>
#include <tautline/model/names.hpp>

namespace tautline::model {

namespace {

template <class Elements>
void append_nodes(const Elements& elements, const std::vector<int>& indices, std::vector<int>& nodes) {
  for (const int i : indices) nodes.insert(nodes.end(), elements[i].nodes.begin(), elements[i].nodes.end());
}

template <class Value>
void sort_unique(std::vector<Value>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

template <class Elements>
std::vector<int> of_group(const Elements& elements, int group) {
  std::vector<int> indices;
  for (int i = 0; i < static_cast<int>(elements.size()); ++i)
    if (elements[i].group == group) indices.push_back(i);
  return indices;
}

template <class Facet>
double area(const Model& model, const Facet& facet) {
  return facet.nodes.size() == 3 ? element::membrane_area<3>(reference_nodes<3>(model, facet.nodes))
                                 : element::membrane_area<4>(reference_nodes<4>(model, facet.nodes));
}

double length(const Model& model, const std::array<int, 2>& nodes) {
  return (model.nodes[nodes[1]] - model.nodes[nodes[0]]).norm();
}

}  // namespace

std::string prefix(const SourceLocation& where) {
  return where.line > 0 ? fmt::format("{}:{}:{}: ", where.file, where.line, where.column) : "";
}

std::string Load::title() const {
  return fmt::format("{}load \"{}\"", prefix(where), name);
}

Load scaled(const Load& load, double factor) {
  Load result = load;
  for (Vec3* vector : {&result.force, &result.moment, &result.line_force, &result.line_moment,
                       &result.surface_force, &result.acceleration})
    *vector *= factor;
  for (auto* motion : {&result.displacement, &result.rotation})
    if (*motion) **motion *= factor;
  result.pressure *= factor;
  result.temperature_change *= factor;
  if (load.temperature_gradient)
    result.temperature_gradient = [gradient = load.temperature_gradient, factor](const Vec3& x) -> Vec3 {
      return factor * gradient(x);
    };
  if (load.temperature_field)
    result.temperature_field = [field = load.temperature_field, factor](const Vec3& x) {
      return factor * field(x);
    };
  return result;
}

int Model::find_group(const std::string& name) const {
  for (int i = 0; i < static_cast<int>(groups.size()); ++i)
    if (groups[i].name == name) return i;
  return -1;
}

Selection Model::select(const std::string& name) const {
  Selection result;
  if (const auto found = selections.find(name); found != selections.end()) result = found->second;
  if (const int group = find_group(name); group >= 0) {
    const auto add = [](std::vector<int>& to, std::vector<int> from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    add(result.cables, of_group(cables, group));
    add(result.beams, of_group(beams, group));
    add(result.membranes, of_group(membranes, group));
    add(result.shells, of_group(shells, group));
    add(result.springs, of_group(springs, group));
    add(result.masses, of_group(masses, group));
    for (const auto& link : links)
      if (link.group == group) result.nodes.insert(result.nodes.end(), {link.leader, link.follower});
  } else if (!selections.contains(name)) {
    const std::string near = nearest(name, names());
    throw ModelError(fmt::format("nothing in the structure is called \"{}\"{}; known: {}", name,
                                 near.empty() ? "" : fmt::format(" (did you mean \"{}\"?)", near),
                                 join(names())));
  }
  append_nodes(cables, result.cables, result.nodes);
  append_nodes(beams, result.beams, result.nodes);
  append_nodes(membranes, result.membranes, result.nodes);
  append_nodes(shells, result.shells, result.nodes);
  append_nodes(springs, result.springs, result.nodes);
  append_nodes(masses, result.masses, result.nodes);
  sort_unique(result.nodes);
  return result;
}

Selection Model::select(const std::vector<std::string>& wanted) const {
  Selection result;
  for (const auto& name : wanted) {
    const Selection more = select(name);
    const auto append = [&](auto member) {
      (result.*member).insert((result.*member).end(), (more.*member).begin(), (more.*member).end());
    };
    for (const auto member : {&Selection::nodes, &Selection::cables, &Selection::beams, &Selection::membranes,
                              &Selection::shells, &Selection::springs, &Selection::masses})
      append(member);
    append(&Selection::edges);
  }
  for (auto* list : {&result.nodes, &result.cables, &result.beams, &result.membranes, &result.shells,
                     &result.springs, &result.masses})
    sort_unique(*list);
  for (auto& edge : result.edges) std::sort(edge.begin(), edge.end());
  sort_unique(result.edges);
  return result;
}

std::vector<int> Model::nodes_of(const std::vector<std::string>& wanted) const {
  std::map<int, int> leader;  // of the ends of beams that hang on a node
  for (const auto& link : links)
    if (link.group < 0) leader[link.follower] = link.leader;
  std::vector<int> result;
  for (const auto& name : wanted)
    for (const int node : select(name).nodes) {
      const auto found = leader.find(node);
      result.push_back(found == leader.end() ? node : found->second);
    }
  sort_unique(result);
  return result;
}

std::vector<std::string> Model::names() const {
  std::vector<std::string> result;
  for (const auto& group : groups) result.push_back(group.name);
  for (const auto& [name, selection] : selections) result.push_back(name);
  std::sort(result.begin(), result.end());
  return result;
}

std::vector<bool> Model::rotational_nodes() const {
  std::vector<bool> result(nodes.size(), false);
  const auto mark = [&](const auto& elements, const auto& has_rotation) {
    for (const auto& element : elements)
      if (has_rotation(groups[element.group]))
        for (const int node : element.nodes) result[node] = true;
  };
  const auto always = [](const Group&) { return true; };
  mark(beams, always);
  mark(shells, always);
  mark(springs, [](const Group& g) { return !g.spring.rotational_stiffness.isZero(0); });
  mark(masses, [](const Group& g) { return !g.mass.inertia.isZero(0); });
  const auto order = links_in_order(*this);
  for (auto at = order.rbegin(); at != order.rend();
       ++at) {  // an arm turns with its leader, as a tied rotation
    const auto& link = links[*at];
    const bool arm = nodes[link.leader] != nodes[link.follower];
    if (arm || (result[link.follower] && !link.rotation_free)) result[link.leader] = true;
    if (!link.hinge.empty()) result[link.follower] = result[link.leader] = true;
  }
  for (const auto& pair : cyclic_pairs)
    if (result[pair.leader] || result[pair.follower]) result[pair.leader] = result[pair.follower] = true;
  for (const int i : order)  // what is tied to a node that turns turns with it
    if (result[links[i].leader] && !links[i].rotation_free) result[links[i].follower] = true;
  return result;
}

std::vector<int> links_in_order(const Model& model) {
  std::map<int, int> link_of;  // by follower
  for (int i = 0; i < static_cast<int>(model.links.size()); ++i) link_of[model.links[i].follower] = i;
  std::vector<int> order;
  std::vector<int> depth(model.links.size(), 0);
  for (std::size_t i = 0; i < model.links.size(); ++i)
    for (auto found = link_of.find(model.links[i].leader); found != link_of.end();
         found = link_of.find(model.links[found->second].leader))
      if (++depth[i] > static_cast<int>(model.links.size()))
        throw ModelError(fmt::format("links lead in a ring through {}: one of its nodes must follow none",
                                     node_at(model, model.links[i].leader)));
  for (std::size_t i = 0; i < model.links.size(); ++i) order.push_back(static_cast<int>(i));
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return depth[a] < depth[b]; });
  return order;
}

double Model::reference_length(const Cable& cable) const {
  return length(*this, cable.nodes);
}

double Model::unstressed_length(const Cable& cable) const {
  return reference_length(cable) / (1.0 + cable.initial_strain);
}

std::map<std::string, double> mass_by_group(const Model& model) {
  std::vector<double> mass(model.groups.size(), 0.0);
  for (const auto& cable : model.cables)
    mass[cable.group] += model.groups[cable.group].cable.mass_per_length * model.unstressed_length(cable);
  for (const auto& beam : model.beams)
    mass[beam.group] += beam_section(model, beam).mass_per_length * length(model, beam.nodes);
  for (const auto& membrane : model.membranes)
    mass[membrane.group] += model.groups[membrane.group].membrane.mass_per_area * area(model, membrane);
  for (const auto& shell : model.shells) {
    const auto& section = model.groups[shell.group].shell;
    mass[shell.group] += section.density * section.thickness * area(model, shell);
  }
  for (const auto& point : model.masses) mass[point.group] += model.groups[point.group].mass.mass;
  std::map<std::string, double> result;
  for (std::size_t i = 0; i < mass.size(); ++i) result[model.groups[i].name] = mass[i];
  return result;
}

double total_mass(const Model& model) {
  double total = 0;
  for (const auto& [name, mass] : mass_by_group(model)) total += mass;
  return total;
}

}  // namespace tautline::model
