#include <algorithm>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/model/response.hpp>

#include "steps/balance.hpp"
#include "steps/context.hpp"
#include "steps/path_results.hpp"
#include "steps/release.hpp"
#include "steps/rod_structure.hpp"
#include "steps/scatter.hpp"
#include "steps/stage.hpp"
#include "steps/summaries.hpp"
#include "steps/state_pictures.hpp"
#include "steps/fields.hpp"

namespace tautline::steps {

namespace {

std::vector<std::string> names_of(const std::vector<model::Load>& loads) {
  std::vector<std::string> names;
  for (const auto& load : loads) names.push_back(load.name);
  return names;
}

/// What happened to the structure comes first, what the solver did last.
void fail(const StageRunner& runner, bool unstable, const std::string& solver, Json& entry) {
  const auto diagnosis = runner.diagnosis(unstable);
  entry["status"] = "not_converged";
  entry["reason"] = unstable ? solver + ". " + diagnosis.text()
                             : fmt::format("{}. The solver: {}", diagnosis.text(), solver);
  entry["diagnosis"] = diagnosis.json();
  entry["diagnosis"]["solver"] = solver;
}

/// An equilibrium that the structure would leave at the slightest touch is no result, unless it is meant.
void refuse_unstable(const EquilibriumOptions& options, const StageRunner& runner, Json& entry) {
  if (entry["status"] != "done" || options.allow_unstable || options.control == Control::arc_length) return;
  const int negative = runner.entries().back()["negative_pivots"];
  if (negative == 0) return;
  fail(runner, true,
       fmt::format("the equilibrium is unstable: {} direction{} in which the structure would leave it "
                   "(negative pivots)",
                   negative, negative == 1 ? "" : "s"),
       entry);
}

void follow_parts(Context& context, const EquilibriumOptions& options, StageRunner& runner, Json& entry) {
  auto parts = parts_of(context, options);
  const auto wanted = parts.back().loads;
  if (options.release == Release::automatic) {
    const auto release = find_release(context, wanted);
    entry["release_attempts"] = release.attempts;
    entry["release_schedule"] = release.schedule;
    context.progress.say(fmt::format("{} | release: {}", context.step_name, release.summary));
    parts.clear();
    for (const auto& stage : release.stages) parts.push_back({stage, {}});
    parts.back().loads = wanted;
  }
  if (static_cast<std::size_t>(runner.first()) >= parts.size())
    throw LibraryError(fmt::format(
        "the checkpoint holds a point in stage {} of step \"{}\", which has {}: run without --from",
        runner.first() + 1, context.step_name, parts.size()));
  for (std::size_t i = static_cast<std::size_t>(runner.first()); i < parts.size(); ++i) {
    if (runner.run(parts[i].stage, parts[i].loads, i + 1 == parts.size())) continue;
    fail(runner, false,
         fmt::format("stage \"{}\" {}", parts[i].stage.name,
                     runner.entries().back()["reason"].get<std::string>()),
         entry);
    break;
  }
  context.acting_loads = wanted;
  refuse_unstable(options, runner, entry);
}

/// How each body of a free structure is accelerated.
Json accelerations_json(const assembly::System& system) {
  Json list = Json::array();
  const auto triple = [](const Vec3& v) { return Json{v.x(), v.y(), v.z()}; };
  for (const auto& body : system.accelerations())
    list.push_back({{"nodes", body.nodes},
                    {"first_node", body.first_node + 1},
                    {"mass", body.mass},
                    {"centre", triple(body.centre)},
                    {"acceleration", triple(body.linear)},
                    {"angular_acceleration", triple(body.angular)}});
  return list;
}

}  // namespace

std::vector<Part> parts_of(Context& context, const EquilibriumOptions& options) {
  const auto& model = context.system().model();
  std::vector<Part> parts;
  for (const auto& stage : options.stages) parts.push_back({stage, {}});
  if (parts.empty()) parts.push_back({{"supports only", {}, {}}, {}});
  parts.back().loads = options.loads ? *options.loads : names_of(model.loads);
  if (options.control == Control::arc_length) {
    Part rest = parts.back();
    rest.stage.name += ", at rest";
    rest.loads = options.reset ? std::vector<std::string>{} : context.acting_loads;
    parts.insert(parts.end() - 1, rest);
  }
  return parts;
}

Json run_step(Context& context, const EquilibriumOptions& options) {
  auto& system = context.system();
  if (options.reset && !context.resume) {
    system.reset();
    context.equilibrium_known = false;
  }
  if (!context.resume) scatter(context, options.scatter);
  Json entry;
  entry["status"] = "done";
  StageRunner runner(context, options);
  follow_parts(context, options, runner, entry);
  entry["stages"] = runner.entries();
  const auto response = model::evaluate_response(system.model(), system.state());
  context.warn_of_state(response);
  entry["reactions"] = reactions_json(system, runner.boundary(), system.reactions());
  if (options.support == Ground::free) entry["bodies"] = accelerations_json(system);
  if (!runner.way().empty()) entry["path"] = runner.way();
  entry["critical_points"] = runner.critical();
  entry["groups"] = groups_json(model::summarise_groups(system.model(), system.state(), response));
  if (context.surface) entry["surface"] = surface_json(context, measure(context));
  if (context.umbrella) entry["rods"] = rods_json(context, response);
  context.write_fields(context.step_name, field_grid(context, response));
  draw_state(context, response);
  draw_path(context, runner.way(), runner.critical());
  return entry;
}

}  // namespace tautline::steps
