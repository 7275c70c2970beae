#include <tautline/formfinding/force_density.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/model/response.hpp>
#include <tautline/model/section.hpp>

#include "steps/context.hpp"
#include "steps/summaries.hpp"

namespace tautline::steps {

namespace {

/// The net as stage 1 sees it, and the way back to the structure.
struct Extract {
  formfinding::Net net;
  std::vector<int> cables;  ///< structure cable of each branch
  std::vector<int> nodes;   ///< structure node of each net node
};

std::vector<std::string> net_groups(const Context& context, const FormFindingOptions& options) {
  if (!options.net.empty()) return options.net;
  if (context.surface) return {"front_net"};
  std::vector<std::string> names;
  for (const auto& group : context.structure.groups)
    if (group.kind == model::ElementKind::cable) names.push_back(group.name);
  return names;
}

/// Nodes of the net that stay: those supported, named by `fixed`, or attached to beams.
std::vector<bool> fixed_nodes(const model::Model& structure, const FormFindingOptions& options) {
  std::vector<bool> fixed = structure.rotational_nodes();
  for (const auto& support : structure.supports)
    if (support.fixed[0] && support.fixed[1] && support.fixed[2])
      for (const int node : support.nodes) fixed[node] = true;
  for (const int node : structure.nodes_of(options.fixed)) fixed[node] = true;
  return fixed;
}

Extract extract_net(const model::Model& structure, const std::vector<std::string>& groups,
                    const FormFindingOptions& options) {
  Extract extract;
  for (const auto& name : groups) {
    const auto cables = structure.select(name).cables;
    extract.cables.insert(extract.cables.end(), cables.begin(), cables.end());
  }
  extract.nodes = structure.nodes_of(groups);
  const auto fixed = fixed_nodes(structure, options);
  std::vector<int> local(structure.nodes.size(), -1);
  for (std::size_t i = 0; i < extract.nodes.size(); ++i) {
    local[extract.nodes[i]] = static_cast<int>(i);
    extract.net.nodes.push_back(structure.nodes[extract.nodes[i]]);
    extract.net.fixed.push_back(fixed[extract.nodes[i]]);
  }
  for (const int cable : extract.cables) {
    const auto& nodes = structure.cables[cable].nodes;
    extract.net.branches.push_back({local[nodes[0]], local[nodes[1]]});
  }
  return extract;
}

VecX targets(const model::Model& structure, const Extract& extract) {
  VecX target(extract.cables.size());
  for (std::size_t i = 0; i < extract.cables.size(); ++i) {
    const double tension = structure.groups[structure.cables[extract.cables[i]].group].target_tension;
    target[static_cast<int>(i)] = tension > 0 ? tension : std::nan("");
  }
  return target;
}

double stiffness(const model::Model& structure, const model::Cable& cable) {
  return structure.groups[cable.group].cable.axial_stiffness;
}

void take_positions_and_tensions(model::Model& structure, const Extract& extract,
                                 const formfinding::ForceDensityResult& found) {
  for (std::size_t i = 0; i < extract.nodes.size(); ++i) structure.nodes[extract.nodes[i]] = found.nodes[i];
  for (std::size_t i = 0; i < extract.cables.size(); ++i) {
    auto& cable = structure.cables[extract.cables[i]];
    cable.initial_strain = found.tension[static_cast<int>(i)] / stiffness(structure, cable);
  }
}

/// The rear net is the front net's mirror image with the same tensions; each tie carries what its front node
/// needs along z.
void complete_reflector(Context& context, const Extract& extract,
                        const formfinding::ForceDensityResult& found) {
  auto& structure = context.structure;
  const double gap = context.deck.truss()->gap;
  std::vector<double> pull(structure.nodes.size(), 0.0);
  for (std::size_t i = 0; i < extract.nodes.size(); ++i)
    pull[extract.nodes[i]] = -found.residual_z[static_cast<int>(i)];
  std::vector<int> mirror(structure.nodes.size(), -1);
  for (const int i : structure.select("ties").cables) {
    auto& tie = structure.cables[i];
    const auto [front, rear] = tie.nodes;
    mirror[front] = rear;
    const Vec3& at = structure.nodes[front];
    structure.nodes[rear] = Vec3(at.x(), at.y(), -at.z() - gap);
    tie.initial_strain = pull[front] / stiffness(structure, tie);
    if (pull[front] <= 0)
      throw ModelError(
          fmt::format("form-finding: the tie at ({:.3f}, {:.3f}) would be pressed with {:.3g} N; a tie only "
                      "pulls. The net "
                      "does not hang below its rim there: check rim_height and the net's tensions",
                      at.x(), at.y(), -pull[front]));
  }
  const auto rear_net = structure.select("rear_net").cables;
  if (rear_net.size() != extract.cables.size())
    throw ModelError("form-finding: the rear net is not the front net's mirror image");
  for (std::size_t i = 0; i < rear_net.size(); ++i)
    structure.cables[rear_net[i]].initial_strain = structure.cables[extract.cables[i]].initial_strain *
                                                   stiffness(structure, structure.cables[extract.cables[i]]) /
                                                   stiffness(structure, structure.cables[rear_net[i]]);
}

/// Other cables keep what the deck states, now on the found lengths.
void refresh_other_groups(Context& context, const std::vector<std::string>& found_groups) {
  auto& structure = context.structure;
  for (std::size_t i = 0; i < structure.groups.size(); ++i) {
    const auto& name = structure.groups[i].name;
    const bool found = std::find(found_groups.begin(), found_groups.end(), name) != found_groups.end();
    if (!found) model::set_initial_state(structure, static_cast<int>(i), context.deck.groups.at(name));
  }
}

/// What the branches pull at each node with, sum of q (x_j - x_i) [N].
Points nodal_forces(const formfinding::Net& net, const formfinding::ForceDensityResult& found) {
  Points forces(net.nodes.size(), Vec3::Zero());
  for (std::size_t i = 0; i < net.branches.size(); ++i) {
    const auto& [a, b] = net.branches[i];
    const Vec3 pull = found.force_density[static_cast<int>(i)] * (found.nodes[b] - found.nodes[a]);
    forces[a] += pull;
    forces[b] -= pull;
  }
  return forces;
}

formfinding::ForceDensityResult solve_linear(const model::Model& structure, const Extract& extract,
                                             const formfinding::Surface* surface) {
  formfinding::ForceDensityResult result;
  result.force_density.resize(extract.cables.size());
  for (std::size_t i = 0; i < extract.cables.size(); ++i) {
    const auto& cable = structure.cables[extract.cables[i]];
    result.force_density[static_cast<int>(i)] =
        cable.initial_strain * stiffness(structure, cable) / structure.reference_length(cable);
  }
  result.nodes = formfinding::solve_linear(extract.net, result.force_density, surface);
  result.tension.resize(extract.cables.size());
  for (std::size_t i = 0; i < extract.cables.size(); ++i) {
    const auto& [a, b] = extract.net.branches[i];
    result.tension[static_cast<int>(i)] =
        result.force_density[static_cast<int>(i)] * (result.nodes[b] - result.nodes[a]).norm();
  }
  result.converged = true;
  result.iterations = 1;
  result.reason = "one linear solve";
  result.residual_z = VecX::Zero(static_cast<Eigen::Index>(extract.nodes.size()));
  const auto forces = nodal_forces(extract.net, result);
  for (std::size_t i = 0; i < forces.size(); ++i) {
    result.residual_z[static_cast<int>(i)] = -forces[i].z();
    if (extract.net.fixed[i]) continue;
    const double left = surface != nullptr ? forces[i].head<2>().norm() : forces[i].norm();
    result.out_of_balance = std::max(result.out_of_balance, left);
  }
  return result;
}

Json form_json(const formfinding::ForceDensityResult& found) {
  Json entry{{"status", found.converged ? "done" : "not_converged"},
             {"reason", found.reason},
             {"iterations", found.iterations}};
  entry["constraint_residual"] = Json::array();
  for (const double r : found.constraint_residual) entry["constraint_residual"].push_back(r);
  entry["coordinate_norm"] = Json::array();
  for (const auto& n : found.coordinate_norm)
    entry["coordinate_norm"].push_back(Json::array({n.x(), n.y(), n.z()}));
  entry["step_relaxation"] = found.step_relaxation;
  entry["out_of_balance"] = found.out_of_balance;
  if (found.condition_number > 0) entry["condition_number"] = found.condition_number;
  return entry;
}

/// Tensions of the structure's cables as found, nothing displaced.
Json found_groups_json(const model::Model& structure) {
  auto groups = model::summarise_groups(
      structure, model::evaluate_response(structure, model::State::reference(structure)));
  std::erase_if(groups, [](const auto& entry) { return entry.second.kind != model::ElementKind::cable; });
  return groups_json(groups);
}

void draw_convergence(Context& context, const formfinding::ForceDensityResult& found) {
  if (found.constraint_residual.size() < 2 || !context.draws()) return;
  output::Chart chart;
  chart.title = "Form-finding: tension residual against iteration";
  chart.x_label = "iteration";
  chart.y_label = "largest tension error [N]";
  chart.log_y = true;
  output::Curve curve{"residual", {}, {}, true};
  for (std::size_t i = 0; i < found.constraint_residual.size(); ++i) {
    curve.x.push_back(static_cast<double>(i));
    curve.y.push_back(std::max(found.constraint_residual[i], 1e-15));
  }
  chart.curves = {curve};
  context.draw("convergence",
               "Largest deviation of a tension from its target, by iteration of the force density method",
               chart);
}

}  // namespace

Json run_step(Context& context, const FormFindingOptions& options) {
  const auto groups = net_groups(context, options);
  const auto extract = extract_net(context.structure, groups, options);
  const formfinding::Surface* surface = context.surface ? &*context.surface : nullptr;
  formfinding::ForceDensityResult found;
  double largest_target = 0;
  if (options.method == FormFindingOptions::Method::linear) {
    found = solve_linear(context.structure, extract, surface);
  } else {
    const VecX target = targets(context.structure, extract);
    for (const double t : target)
      if (!std::isnan(t)) largest_target = std::max(largest_target, t);
    if (largest_target == 0)
      throw ModelError(
          fmt::format("form-finding: no group of the net states a tension; give one of {} a `tension`, or "
                      "use `method: linear`",
                      fmt::join(groups, ", ")));
    found = formfinding::find_tensions(
        extract.net, target, surface, options.solver, [&](int iteration, double residual) {
          context.progress.update(fmt::format("{} | iteration {}, tension residual {:.2e} N",
                                              context.step_name, iteration, residual));
        });
  }
  Json entry = form_json(found);
  if (!found.converged) return entry;
  take_positions_and_tensions(context.structure, extract, found);
  auto settled = groups;
  if (surface != nullptr) {
    complete_reflector(context, extract, found);
    settled.insert(settled.end(), {"rear_net", "ties"});
  }
  refresh_other_groups(context, settled);
  entry["groups"] = found_groups_json(context.structure);
  draw_convergence(context, found);
  return entry;
}

}  // namespace tautline::steps
