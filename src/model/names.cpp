#include <tautline/model/names.hpp>

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include <tautline/core/text.hpp>

namespace tautline::model {

namespace {

const char* kind_name(ElementKind kind) {
  if (kind == ElementKind::bar) return "bar";
  return kind == ElementKind::catenary ? "catenary" : "cable";
}

std::string from_to(const Model& model, const std::array<int, 2>& nodes) {
  return fmt::format(", from {} to {}", node_name(model, nodes[0]), node_name(model, nodes[1]));
}

}  // namespace

std::string node_name(const Model& model, int node) {
  const auto index = static_cast<std::size_t>(node);
  if (index < model.node_names.size()) return fmt::format("node \"{}\"", model.node_names[index]);
  return fmt::format("node {}", node + 1);
}

std::string node_at(const Model& model, int node) {
  const Vec3& x = model.nodes[static_cast<std::size_t>(node)];
  return fmt::format("{} at ({:.4g}, {:.4g}, {:.4g})", node_name(model, node), x.x(), x.y(), x.z());
}

std::string node_in_group(const Model& model, int node) {
  std::set<std::string> groups;
  for_each_kind(model, [&](const auto& elements) {
    for (const auto& element : elements)
      if (std::find(element.nodes.begin(), element.nodes.end(), node) != element.nodes.end())
        groups.insert(fmt::format("\"{}\"", model.groups[static_cast<std::size_t>(element.group)].name));
  });
  if (groups.empty()) return node_at(model, node);
  const Vec3& x = model.nodes[static_cast<std::size_t>(node)];
  return fmt::format("{} of {} at ({:.4g}, {:.4g}, {:.4g})", node_name(model, node),
                     join({groups.begin(), groups.end()}, ", ", 3), x.x(), x.y(), x.z());
}

std::string element_name(const Model& model, const char* kind, std::size_t index, int group) {
  return fmt::format("{} {} of group \"{}\"", kind, index + 1,
                     model.groups[static_cast<std::size_t>(group)].name);
}

std::string cable_name(const Model& model, std::size_t cable) {
  const auto& element = model.cables[cable];
  const auto kind = model.groups[static_cast<std::size_t>(element.group)].kind;
  return element_name(model, kind_name(kind), cable, element.group) + from_to(model, element.nodes);
}

std::string beam_name(const Model& model, std::size_t beam) {
  const auto& element = model.beams[beam];
  return element_name(model, "beam", beam, element.group) + from_to(model, element.nodes);
}

}  // namespace tautline::model
