#include <map>
#include <optional>
#include <type_traits>

#include <fmt/format.h>

#include <tautline/analysis/descent.hpp>
#include <tautline/assembly/mechanism.hpp>
#include <tautline/core/error.hpp>
#include <tautline/steps/run.hpp>

#include "steps/context.hpp"
#include "steps/prepare.hpp"
#include "steps/stage.hpp"

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

std::string warnings_text(const Json& results) {
  std::string text;
  if (!results.contains("warnings")) return text;
  for (const auto& warning : results["warnings"])
    text += fmt::format("warning: {}: {}\n", warning["where"].get<std::string>(),
                        warning["message"].get<std::string>());
  return text;
}

/// @brief Goes through the steps as a run does and leaves out what is solved for.
///
/// What is refused is what no solve could mend. A motion without resistance in the structure as drawn is that
/// only if nothing acts that might tighten it, or if no tension could.
class Rehearsal {
 public:
  explicit Rehearsal(Context& context) : context_(context) {}

  void run() {
    context_.warn_of_inputs();
    for (const auto& step : context_.deck.steps) {
      context_.step_name = step.name;
      if (!finds_shape(step.options)) context_.warn_of_geometry();
      try {
        std::visit([&](const auto& options) { take(options); }, step.options);
      } catch (const ModelError& error) {
        throw ModelError(fmt::format("step \"{}\": {}", step.name, error.what()));
      }
    }
    context_.warn_of_geometry();
  }

  const std::string& notes() const { return notes_; }

 private:
  template <class Options>
  void take(const Options& options) {
    if constexpr (std::is_same_v<Options, FormFindingOptions> || std::is_same_v<Options, MeshOptions> ||
                  std::is_same_v<Options, RodShapingOptions>) {
      const Json entry = run_step(context_, options);
      if (entry["status"] != "done") throw ModelError(entry["reason"].get<std::string>());
      mechanisms_.clear();
    } else if constexpr (std::is_same_v<Options, EquilibriumOptions>) {
      for (const auto& part : parts_of(context_, options)) {
        context_.acting_loads = part.loads;
        look_at(part.stage, options.support == Ground::free);
      }
      untouched_ = untouched_ && options.scatter.position == 0 && options.scatter.tension == 0;
    } else {
      prepare(context_, options);
      untouched_ = untouched_ && std::is_same_v<Options, ModalOptions>;
    }
  }

  void look_at(const StageOptions& stage, bool free) {
    const auto loaded = free ? context_.free_boundary(true) : context_.boundary(stage.hold, true);
    context_.system().begin_stage(loaded);
    untouched_ = untouched_ && loaded.loads.empty();
    const auto& mechanism = mechanism_under(stage.hold, free);
    if (!mechanism) return;
    const bool slack =
        analysis::gives_way(context_.system(), context_.workspace());  // a run finds where it hangs
    if (untouched_ && !slack) throw ModelError(mechanism->text);
    if (const auto loose = assembly::find_loose_part(context_.system().model(), loaded))
      throw ModelError(loose->text);
    notes_ +=
        fmt::format("note: step \"{}\": as drawn, {}. Whether its loads tighten it only the solve can tell\n",
                    context_.step_name, mechanism->text);
  }

  /// Each set of supports is factored once.
  const std::optional<assembly::Mechanism>& mechanism_under(const std::vector<std::string>& hold, bool free) {
    const auto [found, is_new] = mechanisms_.try_emplace({hold, free});
    if (is_new) {
      context_.system().begin_stage(free ? context_.free_boundary(false) : context_.boundary(hold, false));
      found->second = assembly::find_mechanism(context_.system(), context_.workspace());
    }
    return found->second;
  }

  Context& context_;
  std::map<std::pair<std::vector<std::string>, bool>, std::optional<assembly::Mechanism>>
      mechanisms_;         ///< by what is held
  bool untouched_ = true;  ///< nothing acted so far, so that the structure stands as drawn or as found
  std::string notes_;
};

}  // namespace

std::string check(const deck::Deck& deck) {
  Progress silent;
  Context context(deck, "", false, silent);
  Rehearsal rehearsal(context);
  rehearsal.run();
  const std::string structure =
      context.umbrella ? umbrella_text(*context.umbrella) : model_text(context.structure);
  return fmt::format("{}\n{}{}{}nothing found that would keep it from being solved\n", deck.title, structure,
                     steps_text(deck), rehearsal.notes() + warnings_text(context.results));
}

}  // namespace tautline::steps
