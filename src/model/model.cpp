#include <tautline/model/model.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/core/text.hpp>

namespace tautline::model {

namespace {

template <class Elements>
void append_nodes(const Elements& elements, const std::vector<int>& indices, std::vector<int>& nodes) {
  for (const int i : indices) nodes.insert(nodes.end(), elements[i].nodes.begin(), elements[i].nodes.end());
}

void sort_unique(std::vector<int>& values) {
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

double area(const Model& model, const Membrane& membrane) {
  const auto& [a, b, c] = membrane.nodes;
  return 0.5 * (model.nodes[b] - model.nodes[a]).cross(model.nodes[c] - model.nodes[a]).norm();
}

double length(const Model& model, const std::array<int, 2>& nodes) {
  return (model.nodes[nodes[1]] - model.nodes[nodes[0]]).norm();
}

}  // namespace

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
  } else if (!selections.contains(name)) {
    const std::string near = nearest(name, names());
    throw ModelError(fmt::format("nothing in the structure is called \"{}\"{}; known: {}", name,
                                 near.empty() ? "" : fmt::format(" (did you mean \"{}\"?)", near),
                                 join(names())));
  }
  append_nodes(cables, result.cables, result.nodes);
  append_nodes(beams, result.beams, result.nodes);
  append_nodes(membranes, result.membranes, result.nodes);
  sort_unique(result.nodes);
  return result;
}

std::vector<int> Model::nodes_of(const std::vector<std::string>& wanted) const {
  std::vector<int> result;
  for (const auto& name : wanted) {
    const auto selected = select(name).nodes;
    result.insert(result.end(), selected.begin(), selected.end());
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
  for (const auto& beam : beams)
    for (const int node : beam.nodes) result[node] = true;
  return result;
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
    mass[cable.group] += model.groups[cable.group].cable.mass_per_length * model.reference_length(cable);
  for (const auto& beam : model.beams)
    mass[beam.group] += model.groups[beam.group].beam.mass_per_length * length(model, beam.nodes);
  for (const auto& membrane : model.membranes)
    mass[membrane.group] += model.groups[membrane.group].membrane.mass_per_area * area(model, membrane);
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
