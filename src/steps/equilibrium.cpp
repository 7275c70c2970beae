#include <algorithm>

#include <fmt/format.h>

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

/// A stage and the loads that act at its end.
struct Part {
  StageOptions stage;
  std::vector<std::string> loads;
};

std::vector<std::string> names_of(const std::vector<model::Load>& loads) {
  std::vector<std::string> names;
  for (const auto& load : loads) names.push_back(load.name);
  return names;
}

/// The stages in order. Loads come in the last one; before a path that is followed by its length what is
/// released comes to rest under the loads that act already.
std::vector<Part> parts_of(const EquilibriumOptions& options, const std::vector<std::string>& acting,
                           const std::vector<std::string>& wanted) {
  std::vector<Part> parts;
  for (const auto& stage : options.stages) parts.push_back({stage, {}});
  if (parts.empty()) parts.push_back({{"supports only", {}, {}}, {}});
  parts.back().loads = wanted;
  if (options.control == Control::arc_length) {
    Part rest = parts.back();
    rest.stage.name += ", at rest";
    rest.loads = acting;
    parts.insert(parts.end() - 1, rest);
  }
  return parts;
}

/// An equilibrium that the structure would leave at the slightest touch is no result, unless it is meant.
void refuse_unstable(const EquilibriumOptions& options, const StageRunner& runner, Json& entry) {
  if (entry["status"] != "done" || options.allow_unstable || options.control == Control::arc_length) return;
  const int negative = runner.entries().back()["negative_pivots"];
  if (negative == 0) return;
  entry["status"] = "not_converged";
  entry["reason"] = fmt::format(
      "the equilibrium is unstable: {} direction{} in which the structure would leave it (negative pivots). "
      "Where "
      "critical_points tells of a bifurcation on the way, take its branch (control: arc_length, branch: 1) "
      "or disturb "
      "the structure with a small load; else try increments. allow_unstable: true takes it as it is",
      negative, negative == 1 ? "" : "s");
}

void follow_parts(Context& context, const EquilibriumOptions& options, StageRunner& runner, Json& entry) {
  const auto acting = options.reset ? std::vector<std::string>{} : context.acting_loads;
  const auto wanted = options.loads ? *options.loads : names_of(context.system().model().loads);
  auto parts = parts_of(options, acting, wanted);
  if (options.release == Release::automatic) {
    const auto release = find_release(context, wanted);
    entry["release_attempts"] = release.attempts;
    entry["release_schedule"] = release.schedule;
    context.progress.say(fmt::format("{} | release: {}", context.step_name, release.summary));
    parts.clear();
    for (const auto& stage : release.stages) parts.push_back({stage, {}});
    parts.back().loads = wanted;
  }
  for (std::size_t i = static_cast<std::size_t>(runner.first()); i < parts.size(); ++i) {
    if (runner.run(parts[i].stage, parts[i].loads, i + 1 == parts.size())) continue;
    entry["status"] = "not_converged";
    entry["reason"] = fmt::format(
        "stage \"{}\" {}. Try a stage in between that holds more (or release: automatic), a smaller "
        "solver.min_step, control: arc_length if loads have passed a limit, fallback: descent if any "
        "equilibrium beyond it will do, or check the structure for a mechanism (tautline check). See "
        "docs/when_it_does_not_converge.md",
        parts[i].stage.name, runner.entries().back()["reason"].get<std::string>());
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
