#include <optional>

#include <fmt/format.h>

#include <tautline/assembly/mechanism.hpp>
#include <tautline/core/error.hpp>
#include <tautline/core/stopwatch.hpp>
#include <tautline/model/response.hpp>

#include "steps/balance.hpp"
#include "steps/context.hpp"
#include "steps/summaries.hpp"

namespace tautline::steps {

namespace {

std::vector<StageOptions> stages_of(const EquilibriumOptions& options) {
  if (options.stages.empty()) return {{"supports only", {}, {}}};
  return options.stages;
}

std::vector<std::string> names_of(const std::vector<model::LoadOptions>& loads) {
  std::vector<std::string> names;
  for (const auto& load : loads) names.push_back(load.name);
  return names;
}

Json newton_table(const analysis::PathSummary& path) {
  Json table = Json::array();
  for (const auto& point : path.points) {
    Json rows = Json::array();
    for (const auto& iteration : point.newton.iterations)
      rows.push_back(Json::array(
          {rounded(above_rounding(iteration.norms.force, 1e-10 * iteration.norms.reference_force)),
           rounded(above_rounding(iteration.increment, 1e-12))}));
    table.push_back({{"lambda", point.lambda}, {"force_and_increment", rows}});
  }
  return table;
}

/// One stage: returns its entry; `reached` says whether lambda came to 1.
Json run_stage(Context& context, const StageOptions& stage, const assembly::Boundary& boundary,
               const EquilibriumOptions& options, bool is_last, Json& way, bool& reached) {
  auto& system = context.system();
  double seconds = 0;
  auto watch = std::make_optional<Stopwatch>(seconds);
  const auto start = system.begin_stage(boundary);
  context.progress.say(fmt::format("{} | {}: out-of-balance at the start {:.3e} N", context.step_name,
                                   stage.name, start.force));
  const auto path = follow(context, stage.name, is_last ? options.increments : 1, [&](double lambda) {
    if (!is_last || (options.monitor.empty() && options.increments == 1)) return;
    way.push_back({{"lambda", lambda},
                   {"monitors", monitors_json(system, options.monitor)},
                   {"reactions", reactions_json(system, boundary, system.reactions())}});
  });
  watch.reset();
  reached = path.reached;
  if ((!path.reached && path.points.empty()) || path.inertia.null > 0)
    if (const auto mechanism = assembly::find_mechanism(system, context.workspace()))
      throw ModelError(fmt::format("stage \"{}\": {}", stage.name, mechanism->text));
  return {{"name", stage.name},
          {"status", path.reached ? "done" : "not_converged"},
          {"reason", path.reason},
          {"newton_iterations", path.newton_iterations},
          {"lambda_steps", path.points.size()},
          {"failed_attempts", path.failed_attempts},
          {"lambda", path.lambda()},
          {"negative_pivots", path.inertia.negative},
          {"null_pivots", path.inertia.null},
          {"step0_out_of_balance", above_rounding(start.force, 1e-12)},
          {"step0_out_of_balance_moment", above_rounding(start.moment, 1e-12)},
          {"newton", newton_table(path)},
          {"wall_seconds", seconds}};
}

}  // namespace

Json run_step(Context& context, const EquilibriumOptions& options) {
  auto& system = context.system();
  if (options.reset) system.reset();
  Json entry;
  entry["status"] = "done";
  entry["stages"] = Json::array();
  const auto stages = stages_of(options);
  Json way = Json::array();
  assembly::Boundary boundary;
  context.acting_loads = options.loads ? *options.loads : names_of(context.deck.loads);
  for (std::size_t i = 0; i < stages.size(); ++i) {
    bool reached = true;
    const bool is_last = i + 1 == stages.size();
    boundary = context.boundary(stages[i].hold, is_last);
    entry["stages"].push_back(run_stage(context, stages[i], boundary, options, is_last, way, reached));
    if (reached) continue;
    entry["status"] = "not_converged";
    entry["reason"] = fmt::format(
        "stage \"{}\" {}. Try a stage in between that holds more, a smaller solver.min_step, or check the "
        "structure for a mechanism (tautline check)",
        stages[i].name, entry["stages"].back()["reason"].get<std::string>());
    break;
  }
  const auto response = model::evaluate_response(system.model(), system.state());
  const auto reactions = system.reactions();
  entry["reactions"] = reactions_json(system, boundary, reactions);
  if (const Json sums = balance_json(system, reactions); !sums.is_null()) entry["balance"] = sums;
  if (!way.empty()) entry["path"] = way;
  entry["groups"] = groups_json(model::summarise_groups(system.model(), response));
  if (context.surface) entry["surface"] = surface_json(measure(context));
  context.write_fields(context.step_name, field_grid(context, response));
  draw_state(context, response);
  return entry;
}

}  // namespace tautline::steps
