#include "steps/reflector_form.hpp"

#include <cmath>

#include <fmt/format.h>

#include <tautline/core/error.hpp>

#include "steps/form_verdict.hpp"

namespace tautline::steps {

namespace {

const std::string front_prefix = "front_", rear_prefix = "rear_";

bool is_front(const std::string& name) {
  return name.rfind(front_prefix, 0) == 0;
}

std::vector<std::string> cables_called(const model::Model& structure, const std::string& prefix) {
  std::vector<std::string> names;
  for (const auto& group : structure.groups)
    if (group.kind == model::ElementKind::cable && group.name.rfind(prefix, 0) == 0)
      names.push_back(group.name);
  return names;
}

std::string rear_of(const std::string& name) {
  return rear_prefix + name.substr(front_prefix.size());
}

double stiffness(const model::Model& structure, const model::Cable& cable) {
  return structure.axial_stiffness(cable);
}

void place_rear_nodes(Context& context, const FormNet& net, const Form& found) {
  auto& structure = context.structure;
  const auto ties = structure.select("ties").cables;
  std::vector<int> sharing(structure.nodes.size(), 0);
  for (const int i : ties) ++sharing[structure.cables[i].nodes[0]];
  for (const int i : ties) {
    auto& tie = structure.cables[i];
    const auto [front, rear] = tie.nodes;
    const Vec3& at = structure.nodes[front];
    structure.nodes[rear] = Vec3(at.x(), at.y(), -at.z() - context.deck.dish()->gap);
    const double found_pull = -found.reaction[net.local[front]].z() / sharing[front];
    const double pull =
        std::abs(found_pull) <= rounding_of(found) ? 0 : found_pull;  // on a plane there is none
    tie.initial_strain = pull / stiffness(structure, tie);
    if (pull < 0)
      throw ModelError(
          fmt::format("form-finding: the tie at ({:.3f}, {:.3f}) would be pressed with {:.3g} N; a tie only "
                      "pulls. The net "
                      "does not hang below what it is fixed to there: check the height of its fixed nodes "
                      "(rim_height of a "
                      "perimeter truss) and the net's tensions",
                      at.x(), at.y(), -pull));
  }
}

/// Tension of each branch with what the cloth carries along it [N].
VecX with_cloth(const FormNet& net, const Form& found) {
  VecX tension = found.tension;
  if (found.cloth_pull.size() == 0) return tension;
  for (Eigen::Index b = 0; b < tension.size(); ++b) {
    const auto [i, j] = net.net.branches[static_cast<std::size_t>(b)];
    tension[b] += found.cloth_pull[b] * (found.nodes[j] - found.nodes[i]).norm();
  }
  return tension;
}

}  // namespace

std::vector<std::string> front_net_groups(const model::Model& structure) {
  return cables_called(structure, front_prefix);
}

std::vector<std::string> rear_net_groups(const model::Model& structure) {
  return cables_called(structure, rear_prefix);
}

std::vector<std::string> completed_groups(const FormNet& net) {
  std::vector<std::string> names{"ties"};
  for (const auto& name : net.groups)
    if (is_front(name)) names.push_back(rear_of(name));
  return names;
}

void complete_reflector(Context& context, const FormNet& net, const Form& found) {
  place_rear_nodes(context, net, found);
  auto& structure = context.structure;
  const VecX tension = with_cloth(net, found);
  for (const auto& name : net.groups) {
    if (!is_front(name)) continue;
    const auto front = net.branches_of(structure, {name});
    const auto rear = structure.select(rear_of(name)).cables;
    if (rear.size() != front.size())
      throw ModelError(
          fmt::format("form-finding: group \"{}\" is not the mirror image of \"{}\"", rear_of(name), name));
    for (std::size_t i = 0; i < rear.size(); ++i) {
      auto& cable = structure.cables[rear[i]];
      cable.initial_strain = tension[front[i]] / stiffness(structure, cable);
    }
  }
}

}  // namespace tautline::steps
