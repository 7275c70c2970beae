#include <algorithm>
#include <map>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/element/beam.hpp>
#include <tautline/element/membrane.hpp>
#include <tautline/mesh/imported_mesh.hpp>
#include <tautline/model/section.hpp>
#include <tautline/reflector/perimeter_truss.hpp>

#include "steps/context.hpp"

namespace tautline::steps {

namespace {

/// Adds elements of one group; the kind follows from the group's section.
class ElementAdder {
 public:
  ElementAdder(model::Model& model, const std::string& group)
      : model_(model), group_(model.find_group(group)) {
    if (group_ < 0)
      throw ModelError(
          fmt::format("group \"{}\" has elements but no section: give it one under \"groups\"", group));
  }

  void line(const std::array<int, 2>& nodes) {
    switch (model_.groups[group_].kind) {
      case model::ElementKind::cable:
        model_.cables.push_back({nodes, group_});
        return;
      case model::ElementKind::beam:
        model_.beams.push_back({nodes, group_});
        return;
      case model::ElementKind::membrane:
        throw wrong("lines", "a membrane");
    }
  }

  void triangle(const std::array<int, 3>& nodes) {
    if (model_.groups[group_].kind != model::ElementKind::membrane)
      throw wrong("triangles", "a cable or beam");
    model_.membranes.push_back({nodes, group_});
  }

 private:
  ModelError wrong(const char* cells, const char* section) const {
    return ModelError(fmt::format("group \"{}\" has {} but its section is for {}", model_.groups[group_].name,
                                  cells, section));
  }

  model::Model& model_;
  int group_;
};

void declare_groups(model::Model& model, const deck::Deck& deck) {
  for (const auto& [name, options] : deck.groups) {
    if (options.section.empty() || model.find_group(name) >= 0) continue;
    model.groups.emplace_back().name = name;
    model.groups.back().kind = model::kind_of(deck.sections.at(options.section));
  }
}

void add_inline(model::Model& model, const model::ModelOptions& options, const deck::Deck& deck) {
  std::map<std::string, int> index;
  for (const auto& [name, position] : options.nodes) {
    index[name] = static_cast<int>(model.nodes.size());
    model.nodes.push_back(position);
  }
  for (const auto& block : options.elements) {
    ElementAdder add(model, block.group);
    for (const auto& names : block.connectivity) {
      if (names.size() == 2)
        add.line({index.at(names[0]), index.at(names[1])});
      else
        add.triangle({index.at(names[0]), index.at(names[1]), index.at(names[2])});
    }
  }
  for (const auto& [name, group] : deck.groups)
    for (const auto& node : group.nodes) model.selections[name].nodes.push_back(index.at(node));
}

void add_mesh(model::Model& model, const std::string& file) {
  const auto mesh = mesh::import_gmsh(file);
  const int offset = static_cast<int>(model.nodes.size());
  model.nodes.insert(model.nodes.end(), mesh.nodes.begin(), mesh.nodes.end());
  for (const auto& [name, cells] : mesh.groups) {
    if (!cells.points.empty())
      for (const int node : cells.points) model.selections[name].nodes.push_back(offset + node);
    if (cells.lines.empty() && cells.triangles.empty()) continue;
    if (model.find_group(name) < 0) {  // a physical group without section only names nodes
      auto& nodes = model.selections[name].nodes;
      for (const auto& line : cells.lines) nodes.insert(nodes.end(), {offset + line[0], offset + line[1]});
      for (const auto& t : cells.triangles)
        nodes.insert(nodes.end(), {offset + t[0], offset + t[1], offset + t[2]});
      continue;
    }
    ElementAdder add(model, name);
    for (const auto& line : cells.lines) add.line({offset + line[0], offset + line[1]});
    for (const auto& t : cells.triangles) add.triangle({offset + t[0], offset + t[1], offset + t[2]});
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
  if (deck.reflector) return;  // a part of a reflector may be switched off while the deck still describes it
  for (const auto& [name, options] : deck.groups) {
    const int group = model.find_group(name);
    const auto in = [&](const auto& elements) {
      return std::any_of(elements.begin(), elements.end(), [&](const auto& e) { return e.group == group; });
    };
    if (!options.section.empty() && !in(model.cables) && !in(model.beams) && !in(model.membranes))
      throw ModelError(fmt::format(
          "{}:{}:{}: group \"{}\" has a section but no elements: the structure has none of that name",
          options.where.file, options.where.line, options.where.column, name));
  }
}

void give_sections(model::Model& model, const deck::Deck& deck) {
  for (std::size_t i = 0; i < model.groups.size(); ++i) {
    auto& group = model.groups[i];
    const auto& options = deck.groups.at(group.name);
    model::set_section(group, deck.sections.at(options.section), deck.materials);
    if (options.orientation) group.orientation = *options.orientation;
    if (options.tension) group.target_tension = *options.tension;
    model::set_initial_state(model, static_cast<int>(i), options);
  }
}

/// Names in supports and loads are looked up where the deck mentions them.
std::vector<int> look_up(const model::Model& model, const std::vector<std::string>& names,
                         const SourceLocation& where) {
  try {
    return model.nodes_of(names);
  } catch (const ModelError& error) {
    throw ModelError(fmt::format("{}:{}:{}: {}", where.file, where.line, where.column, error.what()));
  }
}

}  // namespace

model::Model build_structure(const deck::Deck& deck) {
  model::Model model;
  if (deck.reflector) {
    model = reflector::make_perimeter_truss(*deck.reflector);
  } else {
    declare_groups(model, deck);
    add_inline(model, *deck.model, deck);
    if (!deck.model->mesh_file.empty()) add_mesh(model, deck.model->mesh_file);
  }
  check_sections(model, deck);
  give_sections(model, deck);
  for (auto& beam : model.beams) {
    Mat<3, 2> x;
    x << model.nodes[beam.nodes[0]], model.nodes[beam.nodes[1]];
    beam.frame = element::beam_frame(x, model.groups[beam.group].orientation);
  }
  for (const auto& support : deck.supports)
    model.supports.push_back(
        {support.name, support.on, look_up(model, support.on, support.where), support.fixed});
  for (const auto& load : deck.loads)
    if (!load.on.empty())
      model.loads.push_back({load.name, look_up(model, load.on, load.where), load.force, load.moment});
  return model;
}

}  // namespace tautline::steps
