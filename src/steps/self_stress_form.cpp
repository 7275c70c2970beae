#include "steps/self_stress_form.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/formfinding/self_stress.hpp>

namespace tautline::steps {

namespace {

using formfinding::SelfStressResult;

bool is_bar(const model::Model& structure, const FormNet& form, std::size_t branch) {
  const auto& cable = structure.cables[static_cast<std::size_t>(form.cables[branch])];
  return structure.groups[static_cast<std::size_t>(cable.group)].kind == model::ElementKind::bar;
}

/// Groups whose deck states an initial force carry its mean.
formfinding::SelfStressWish wish_of(const model::Model& structure, const FormNet& form) {
  formfinding::SelfStressWish wish;
  for (std::size_t b = 0; b < form.cables.size(); ++b) wish.pulls_only.push_back(!is_bar(structure, form, b));
  for (const auto& name : form.groups) {
    const auto members = form.branches_of(structure, {name});
    double mean = 0;
    for (const int b : members) {
      const auto& cable =
          structure.cables[static_cast<std::size_t>(form.cables[static_cast<std::size_t>(b)])];
      mean += cable.initial_strain * structure.axial_stiffness(cable) / static_cast<double>(members.size());
    }
    if (mean == 0) continue;
    wish.group.push_back(members);
    wish.tension.push_back(mean);
  }
  return wish;
}

/// Without a tension to go by, the state in which the most strained cable is strained by a thousandth.
void scale_to_strain(const model::Model& structure, const FormNet& form, SelfStressResult& found) {
  constexpr double strain = 1e-3;
  double largest = 0;
  for (std::size_t b = 0; b < form.cables.size(); ++b)
    largest = std::max(largest,
                       std::abs(found.tension[static_cast<Eigen::Index>(b)]) / form.stiffness(structure, b));
  const double factor = largest > 0 ? strain / largest : 1;
  found.tension *= factor;
  found.out_of_balance *= factor;
  found.least_stiffness *= factor;
}

std::string counts_text(const SelfStressResult& found) {
  return fmt::format("{} state{} of self-stress, {} mechanism{}{}", found.states,
                     found.states == 1 ? "" : "s", found.mechanisms, found.mechanisms == 1 ? "" : "s",
                     found.rigid > 0 ? fmt::format(", {} rigid motions", found.rigid) : "");
}

std::string members_text(const model::Model& structure, const FormNet& form, const std::vector<int>& members,
                         const VecX& tension) {
  constexpr std::size_t most = 6;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, members.size()); ++i)
    text += fmt::format("{}{} ({:.4g} N)", i > 0 ? "; " : "", form.describe(structure, members[i]),
                        tension[members[i]]);
  return text + (members.size() > most ? fmt::format("; and {} more", members.size() - most) : "");
}

/// Why there is no state to go on with, or nothing.
std::string failure(const model::Model& structure, const FormNet& form, double tolerance,
                    const SelfStressResult& found) {
  if (found.states == 0)
    return fmt::format(
        "{}: the members as drawn can carry no forces in balance with each other. The smallest singular "
        "value "
        "of the equilibrium matrix is {:.3g} of the largest, above the tolerance {:.0e}: move nodes until it "
        "vanishes, or add a member",
        counts_text(found), found.smallest, tolerance);
  if (found.found) return {};
  if (found.wrong.empty())
    return fmt::format("{}, but none in which the groups that state a tension carry it", counts_text(found));
  return fmt::format(
      "{}, but none in which every cable pulls: in the nearest {} of {} would have to push: {}. Make them "
      "bars, "
      "or change the shape",
      counts_text(found), found.wrong.size(), form.cables.size(),
      members_text(structure, form, found.wrong, found.tension));
}

std::string stability_text(const FormNet& form, const Context& context, const SelfStressResult& found) {
  std::size_t most = 0;
  for (std::size_t i = 1; i < found.softest.size(); ++i)
    if (found.softest[i].norm() > (1 + 1e-9) * found.softest[most].norm()) most = i;
  return fmt::format(
      "the state of self-stress does not stiffen every mechanism, so that the structure is not stable: least "
      "stiffness {:.3g} N/m{}",
      found.least_stiffness,
      found.softest.empty()
          ? ""
          : fmt::format(", most of all at {}", form.node_name(context, static_cast<int>(most))));
}

Json forces_json(const model::Model& structure, const FormNet& form, const SelfStressResult& found) {
  Json groups = Json::object();
  for (const auto& name : form.groups) {
    Json list = Json::array();
    for (const int b : form.branches_of(structure, {name})) list.push_back(found.tension[b]);
    groups[name] = list;
  }
  return groups;
}

}  // namespace

Form find_self_stressed(const Context& context, const FormFindingOptions& options, const FormNet& form) {
  const auto& structure = context.structure;
  if (!form.net.load.empty())
    throw ModelError("form-finding: self-stress is found without loads: leave them to the equilibrium");
  if (context.surface || options.frame != FrameKind::rigid || !form.film.empty())
    throw ModelError(
        "form-finding: method self_stress takes plain models of cables and bars, without cloth and with "
        "frame: rigid");
  formfinding::SelfStressOptions solver;
  solver.tolerance = options.tolerance.value_or(solver.tolerance);
  auto found = formfinding::find_self_stress(form.net, wish_of(structure, form), solver);
  if (found.equations == 0)
    throw ModelError(
        "form-finding: every node of the net is held by supports, `fixed` or beams, so that any forces "
        "balance: "
        "method self_stress takes struts and rims as bars");
  if (!found.scaled) scale_to_strain(structure, form, found);
  Form result;
  result.nodes = form.net.nodes;
  result.tension = found.tension;
  result.reason = failure(structure, form, solver.tolerance, found);
  result.converged = result.reason.empty();
  if (result.converged)
    result.reason = counts_text(found) + "; the most even state with the tensions asked for";
  result.reaction = net_reactions(form, form.net.nodes, found.tension);
  result.details = {{"states", found.states},
                    {"mechanisms", found.mechanisms},
                    {"rigid_motions", found.rigid},
                    {"equations", found.equations},
                    {"members", form.cables.size()},
                    {"smallest_singular_value", found.smallest},
                    {"largest_dropped_singular_value", found.dropped},
                    {"out_of_balance", found.out_of_balance}};
  if (found.states == 0) return result;
  result.details["stable"] = found.found && found.stable;
  if (found.mechanisms > 0 && std::isfinite(found.least_stiffness))
    result.details["least_stiffness"] = found.least_stiffness;
  result.details["forces"] = forces_json(structure, form, found);
  if (!result.converged) return result;
  if (!found.scaled)
    result.warnings.emplace_back(
        "no group states a tension: the state is scaled to a largest strain of 0.1 %; give one group "
        "`tension`");
  if (!found.stable) result.warnings.push_back(stability_text(form, context, found));
  if (!found.unstressed.empty())
    result.warnings.push_back(fmt::format("{} members carry nothing in any state of self-stress: {}",
                                          found.unstressed.size(),
                                          members_text(structure, form, found.unstressed, found.tension)));
  return result;
}

}  // namespace tautline::steps
