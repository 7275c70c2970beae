#include <fmt/format.h>

#include <tautline/analysis/descent.hpp>
#include <tautline/assembly/mechanism.hpp>
#include <tautline/core/error.hpp>
#include <tautline/steps/run.hpp>

#include "steps/context.hpp"

namespace tautline::steps {

namespace {

std::string model_text(const model::Model& model) {
  std::string text =
      fmt::format("structure  {} nodes, {} cables, {} beams, {} membranes, {} shells, {:.4g} kg\n",
                  model.nodes.size(), model.cables.size(), model.beams.size(), model.membranes.size(),
                  model.shells.size(), model::total_mass(model));
  for (const auto& [name, mass] : model::mass_by_group(model)) {
    const auto selection = model.select(name);
    text += fmt::format("  {:<20} {:>6} elements {:>12.4g} kg\n", name,
                        selection.cables.size() + selection.beams.size() + selection.membranes.size() +
                            selection.shells.size() + selection.springs.size() + selection.masses.size(),
                        mass);
  }
  return text;
}

std::string umbrella_text(const rod::Umbrella& umbrella) {
  const int last = umbrella.rod.links() - 1;
  return fmt::format(
      "structure  {} rods of {} links, {:.4g} m long from radius {:.4g} m; their ends belong at {:.4g} m, "
      "height "
      "{:.4g} m\n",
      umbrella.cables.rods, umbrella.rod.links(), umbrella.rod.lengths.sum(), umbrella.rod.root.x,
      umbrella.target_x[last], umbrella.target_y[last]);
}

std::string steps_text(const deck::Deck& deck) {
  std::string text = "steps     ";
  for (const auto& step : deck.steps) text += fmt::format(" {}", step.name);
  return text + "\n";
}

/// Supports of each stage of each equilibrium are looked at on the structure as form-found and divided,
/// undeformed.
void foretell_mechanisms(Context& context) {
  for (const auto& step : context.deck.steps) {
    if (const auto* form_finding = std::get_if<FormFindingOptions>(&step.options)) {
      const Json entry = run_step(context, *form_finding);
      if (entry["status"] != "done")
        throw ModelError(fmt::format("step \"{}\": {}", step.name, entry["reason"].get<std::string>()));
    }
    if (const auto* rods = std::get_if<RodShapingOptions>(&step.options)) run_step(context, *rods);
    if (const auto* mesh = std::get_if<MeshOptions>(&step.options)) run_step(context, *mesh);
    const auto* equilibrium = std::get_if<EquilibriumOptions>(&step.options);
    if (equilibrium == nullptr) continue;
    auto stages = equilibrium->stages;
    if (stages.empty()) stages.emplace_back();
    for (const auto& stage : stages) {
      context.system();
      context.system().begin_stage(equilibrium->support == Ground::free
                                       ? context.free_boundary(false)
                                       : context.boundary(stage.hold, false));
      if (analysis::gives_way(context.system(), context.workspace())) continue;  // a run finds where it hangs
      if (const auto mechanism = assembly::find_mechanism(context.system(), context.workspace()))
        throw ModelError(fmt::format("step \"{}\": {}", step.name, mechanism->text));
    }
  }
}

}  // namespace

std::string check(const deck::Deck& deck) {
  Progress silent;
  Context context(deck, "", false, silent);
  foretell_mechanisms(context);
  const std::string structure =
      context.umbrella ? umbrella_text(*context.umbrella) : model_text(context.structure);
  return fmt::format("{}\n{}{}nothing found that would keep it from being solved\n", deck.title, structure,
                     steps_text(deck));
}

}  // namespace tautline::steps
