#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/model/response.hpp>
#include <tautline/model/section.hpp>

#include "steps/balanced_form.hpp"
#include "steps/context.hpp"
#include "steps/form_frame.hpp"
#include "steps/form_methods.hpp"
#include "steps/form_verdict.hpp"
#include "steps/length_errors.hpp"
#include "steps/rear_form.hpp"
#include "steps/reflector_form.hpp"
#include "steps/summaries.hpp"
#include "steps/state_pictures.hpp"

namespace tautline::steps {

namespace {

void take_cables(model::Model& structure, const FormNet& net, const Form& found) {
  for (std::size_t i = 0; i < net.nodes.size(); ++i) structure.nodes[net.nodes[i]] = found.nodes[i];
  for (std::size_t b = 0; b < net.cables.size(); ++b) {
    auto& cable = structure.cables[net.cables[b]];
    const auto i = static_cast<Eigen::Index>(b);
    cable.initial_strain = found.unstressed_length.size() > 0
                               ? structure.reference_length(cable) / found.unstressed_length[i] - 1
                               : found.tension[i] / net.stiffness(structure, b);
  }
}

void take_film(model::Model& structure, const FormNet& net, const Form& found) {
  for (std::size_t f = 0; f < found.film_stress.size(); ++f)
    structure.membranes[net.membranes[f]].prestress = found.film_stress[f];
}

/// Cables of `ties` pull along z at the nodes of the net that lie on a surface.
void take_ties(model::Model& structure, const FormNet& net, const Form& found,
               const std::vector<std::string>& groups) {
  for (const auto& name : groups)
    for (const int i : structure.select(name).cables) {
      auto& tie = structure.cables[i];
      const int end = net.local[tie.nodes[0]] >= 0 ? 0 : 1;
      const int node = net.local[tie.nodes[end]];
      if (node < 0)
        throw ModelError(fmt::format("form-finding: a tie of \"{}\" does not meet the net", name));
      const Vec3 along = structure.nodes[tie.nodes[1 - end]] - structure.nodes[tie.nodes[end]];
      if (along.head<2>().norm() > 1e-3 * along.norm())
        structure.nodes[tie.nodes[1 - end]].head<2>() = structure.nodes[tie.nodes[end]].head<2>();
      const double pull = found.reaction[node].z() * (along.z() > 0 ? 1 : -1);
      const double tension = std::abs(pull) <= rounding_of(found) ? 0 : pull;  // on a plane there is none
      if (tension < 0)
        throw ModelError(
            fmt::format("form-finding: the tie of \"{}\" at ({:.3f}, {:.3f}) would be pressed with "
                        "{:.3g} N; a tie only pulls: its other end must lie on the other side",
                        name, found.nodes[node].x(), found.nodes[node].y(), -tension));
      tie.initial_strain = tension / structure.axial_stiffness(tie);
    }
}

/// Other groups keep what the deck states, now on the found lengths.
void refresh_other_groups(Context& context, const std::vector<std::string>& settled) {
  auto& structure = context.structure;
  for (std::size_t i = 0; i < structure.groups.size(); ++i) {
    const auto& name = structure.groups[i].name;
    if (std::find(settled.begin(), settled.end(), name) != settled.end()) continue;
    const auto& options = context.deck.groups.at(name);
    if (options.initial_stress) continue;  // the same in every shape
    model::set_initial_state(structure, static_cast<int>(i), options);
  }
}

/// Tensions of the structure's cables and bars as found, nothing displaced.
Json found_groups_json(const model::Model& structure) {
  const auto state = model::State::initial(structure);
  auto groups = model::summarise_groups(structure, state, model::evaluate_response(structure, state));
  std::erase_if(groups, [](const auto& entry) {
    return entry.second.kind != model::ElementKind::cable && entry.second.kind != model::ElementKind::bar;
  });
  return groups_json(groups);
}

/// Force of each support on the net.
Json support_forces(const model::Model& structure, const FormNet& net, const Form& found) {
  Json supports = Json::object();
  for (const auto& support : structure.supports) {
    Vec3 sum = Vec3::Zero();
    bool any = false;
    for (const int node : support.nodes)
      if (const int i = net.local[node]; i >= 0) {
        sum += found.reaction[i];
        any = true;
      }
    if (any) supports[support.name] = {{"force", {sum.x(), sum.y(), sum.z()}}};
  }
  return supports;
}

/// "principal stresses of 1.9 to 2.1 N/m"
std::string range_met(const Form& found) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const Vec3& stress : found.film_stress) {
    const Vec<2> principal = model::principal_values(stress);
    least = std::min(least, principal[1]);
    most = std::max(most, principal[0]);
  }
  return fmt::format("principal stresses of {:.4g} to {:.4g} N/m", least, most);
}

/// What evens a film out at a facet.
std::string film_remedy(const formfinding::FilmFacet& facet) {
  if (facet.stress[0] == facet.stress[1])
    return "a finer or more even mesh there, or a cable or a ring at points that hold the film, evens it out";
  return fmt::format(
      "{:.4g} N/m along and {:.4g} N/m across one direction are in equilibrium on no doubly curved surface, "
      "whatever the mesh: both families of lines would have to be geodesics. More equal prestress, or a "
      "flatter "
      "film, evens it out",
      facet.stress[0], facet.stress[1]);
}

constexpr double noted_unevenness = 0.03, largest_unevenness = 0.3;

/// Largest deviation of a film's stress from the stress asked for, over it; notes and judges it.
void judge_film(Context& context, const FormNet& net, const Form& found, Json& entry) {
  const auto uneven = formfinding::film_unevenness(net.film, found.film_stress, found.nodes);
  const auto worst = std::max_element(uneven.begin(), uneven.end());
  entry["film_unevenness"] = *worst;
  if (*worst <= noted_unevenness) return;
  const auto facet = static_cast<std::size_t>(worst - uneven.begin());
  const auto& membrane = context.structure.membranes[net.membranes[facet]];
  Vec3 middle = Vec3::Zero();
  for (const int node : net.film[facet].nodes) middle += found.nodes[node] / net.film[facet].nodes.size();
  const auto many =
      std::count_if(uneven.begin(), uneven.end(), [](double u) { return u > noted_unevenness; });
  const std::string text = fmt::format(
      "the stress of the film deviates by up to {:.2g} % from the one asked for, by more than {:.0f} % in {} "
      "of {} facets, with {}; largest in \"{}\" at ({:.4g}, {:.4g}, {:.4g}): {}",
      100 * *worst, 100 * noted_unevenness, many, uneven.size(), range_met(found),
      context.structure.groups[static_cast<std::size_t>(membrane.group)].name, middle.x(), middle.y(),
      middle.z(), film_remedy(net.film[facet]));
  context.warn("film_unevenness", text);
  if (*worst <= largest_unevenness) return;
  entry["status"] = "not_converged";
  entry["reason"] =
      fmt::format("unevenness of the film {:.3g} > {:.3g}: {}", *worst, largest_unevenness, text);
}

void draw_convergence(Context& context, const Form& found) {
  if (found.residual.size() < 2 || !context.draws()) return;
  output::Chart chart;
  chart.title = "Form-finding: convergence";
  chart.x_label = "iteration";
  chart.y_label = found.residual_name;
  chart.log_y = true;
  output::Curve curve{"residual", {}, {}, true};
  for (std::size_t i = 0; i < found.residual.size(); ++i) {
    curve.x.push_back(static_cast<double>(i));
    curve.y.push_back(std::max(found.residual[i], 1e-15));
  }
  chart.curves = {curve};
  context.draw("convergence", found.residual_name + " by iteration of form-finding", chart);
}

/// Groups whose state follows from what is found.
std::vector<std::string> settled_groups(const Context& context, const FormFindingOptions& options,
                                        const FormNet& net) {
  auto settled = net.groups;
  settled.insert(settled.end(), net.cloth.begin(), net.cloth.end());
  settled.insert(settled.end(), options.ties.begin(), options.ties.end());
  if (!context.surface) return settled;
  const auto completed = completed_groups(net);
  settled.insert(settled.end(), completed.begin(), completed.end());
  if (rear_form(context, options) != RearForm::mirrored)
    for (const auto& group : rear_net_groups(context.structure)) settled.push_back(group);
  return settled;
}

/// Moves the structure to the shape found and gives all its parts their state.
void hand_over(Context& context, const FormFindingOptions& options, const FormNet& net, const Form& found,
               const CoupledForm* coupled = nullptr) {
  take_cables(context.structure, net, found);
  take_film(context.structure, net, found);
  take_ties(context.structure, net, found, options.ties);
  if (coupled != nullptr)
    take_rear(context, *coupled);
  else if (context.surface)
    complete_reflector(context, net, found);
  refresh_other_groups(context, settled_groups(context, options, net));
}

/// The finite-element system in the state found, for tables, pictures and the step that follows.
void show(Context& context) {
  context.subdivide = {};
  context.set_system(context.structure);
  auto& system = context.system();
  system.begin_stage({system.model().supports, {}});  // a structure that floats has none
  if (!context.draws() || system.model().cables.empty()) return;
  draw_tensions(context, model::evaluate_response(system.model(), system.state()));
}

/// What the shape that the structure now has is like, in results, tables and pictures.
void describe(Context& context, const FormFindingOptions& options, const FormNet& net, const Form& found,
              Json& entry) {
  entry["groups"] = found_groups_json(context.structure);
  if (!context.surface)
    if (const Json supports = support_forces(context.structure, net, found); !supports.empty())
      entry["reactions"] = supports;
  if (!found.film_stress.empty()) judge_film(context, net, found, entry);
  show(context);
  if (found.converged && options.length_errors)
    entry["length_errors"] = length_errors_json(context, *options.length_errors, net);
}

}  // namespace

Json run_step(Context& context, const FormFindingOptions& options) {
  auto net = extract_net(context, options);
  if (options.method == FormMethod::balanced) net.force_density = balancing(context, net);
  Json frame;
  std::optional<CoupledForm> coupled;
  if (context.surface && rear_form(context, options) != RearForm::mirrored)
    coupled = find_coupled(context, options, net);
  const HandOver hand_over_net = [&](const Form& found) { hand_over(context, options, net, found); };
  auto found = coupled ? coupled->front
               : options.frame != FrameKind::rigid
                   ? find_with_frame(context, options, settled_groups(context, options, net), net,
                                     hand_over_net, frame)
                   : find_form(context, options, net);
  refuse_pushed_cables(context.structure, net, found);
  Json entry{{"status", found.converged ? "done" : "not_converged"}, {"reason", found.reason}};
  entry.update(found.details);
  if (!frame.is_null()) entry.update(frame);
  if (coupled) entry["rear"] = coupled->details;
  if (!found.warnings.empty()) entry["warnings"] = found.warnings;
  for (const auto& warning : found.warnings) context.warn("form_finding", warning);
  draw_convergence(context, found);
  if (!found.converged && !found.compromise) return entry;
  try {
    if (options.frame == FrameKind::rigid)
      hand_over(context, options, net, found, coupled ? &*coupled : nullptr);
    describe(context, options, net, found, entry);
  } catch (const ModelError& error) {
    if (found.converged) throw;
    entry["reason"] = fmt::format("{}; its results are not complete: {}", found.reason, error.what());
  }
  return entry;
}

}  // namespace tautline::steps
