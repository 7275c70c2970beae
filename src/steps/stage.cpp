#include "steps/stage.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include <tautline/analysis/descent.hpp>
#include <tautline/assembly/mechanism.hpp>
#include <tautline/assembly/slack.hpp>
#include <tautline/core/error.hpp>
#include <tautline/core/stopwatch.hpp>

#include "steps/balance.hpp"
#include "steps/path_results.hpp"
#include "steps/summaries.hpp"

namespace tautline::steps {

namespace {

/// Of each point the residuals and increments of its iterations.
Json newton_table(const analysis::PathSummary& path) {
  Json table = Json::array();
  for (const auto& point : path.points) {
    Json rows = Json::array();
    for (const auto& iteration : point.newton.iterations)
      rows.push_back(Json::array({iteration.norms.force, iteration.increment}));
    table.push_back({{"lambda", point.lambda}, {"force_and_increment", rows}});
  }
  return table;
}

analysis::LastResort last_resort_of(Fallback fallback) {
  if (fallback == Fallback::descent) return analysis::LastResort::descent;
  if (fallback == Fallback::dynamic_relaxation) return analysis::LastResort::dynamic_relaxation;
  return analysis::LastResort::none;
}

const char* key_of(analysis::LastResort method) {
  return method == analysis::LastResort::descent ? "descent" : "dynamic_relaxation";
}

Json last_resort_json(const analysis::LastResortSummary& tried) {
  Json entry{{"gave_up", tried.gave_up},
             {"steps", tried.steps},
             {"residual", tried.residual},
             {"newton_iterations", tried.newton_iterations}};
  if (tried.method == analysis::LastResort::dynamic_relaxation) entry["peaks"] = tried.peaks;
  return entry;
}

/// Of each of the many points of a path followed by its length the number of iterations.
Json iterations_table(const analysis::PathSummary& path) {
  Json table = Json::array();
  for (const auto& point : path.points)
    table.push_back({{"lambda", point.lambda}, {"iterations", point.newton.newton_iterations()}});
  return table;
}

}  // namespace

StageRunner::StageRunner(Context& context, const EquilibriumOptions& options)
    : context_(context), options_(options), beginning_(Beginning::of(context.system())) {
  if (!context.resume) return;
  first_ = context.resume->stage;
  entries_ = context.resume->entry;
  way_ = context.resume->way;
  critical_ = context.resume->critical;
}

Json StageRunner::entry_of(const StageOptions& stage, const assembly::OutOfBalance& start,
                           const analysis::PathSummary& path, double seconds) const {
  const bool walks = options_.control == Control::arc_length;
  const auto rounding = context_.system().rounding();
  return {{"name", stage.name},
          {"status", path.reached ? "done" : "not_converged"},
          {"reason", path.reason},
          {"newton_iterations", path.newton_iterations},
          {"lambda_steps", path.points.size()},
          {"failed_attempts", path.failed_attempts},
          {"descent_steps", path.descent_steps},
          {"lambda", path.lambda()},
          {"negative_pivots", path.inertia.negative},
          {"null_pivots", path.inertia.null},
          {"step0_out_of_balance", start.force},
          {"step0_out_of_balance_moment", start.moment},
          {"rounding", rounding.force},
          {"rounding_moment", rounding.moment},
          {"newton", walks ? iterations_table(path) : newton_table(path)},
          {"wall_seconds", seconds}};
}

analysis::PathSummary StageRunner::walk(const std::string& what, const analysis::PathCallback& callback,
                                        const analysis::PathStart& start) {
  auto& system = context_.system();
  auto arc = options_.arc_length;
  arc.load_factor = options_.until.load_factor;
  if (options_.until.least_load_factor) arc.least_load_factor = *options_.until.least_load_factor;
  std::optional<analysis::Watch> watch;
  if (options_.until.displacement) {
    const auto nodes = system.model().nodes_of(options_.until.on);
    const Vec3 direction = Vec3::Unit(static_cast<int>(options_.until.direction));
    const auto mean = [&system, nodes, direction] {
      double sum = 0;
      for (const int node : nodes) sum += system.state().displacement[node].dot(direction);
      return sum / static_cast<double>(nodes.size());
    };
    watch.emplace(analysis::Watch{system.mean_motion(nodes, direction), mean});
    arc.displacement = options_.until.displacement;
  }
  return follow_arc(context_, what, arc, watch, callback, start);
}

void StageRunner::note(const analysis::PathPoint& point) {
  const auto& system = context_.system();
  const bool walks = options_.control == Control::arc_length;
  if (options_.monitor.empty() && options_.increments == 1 && !walks) return;
  way_.push_back({{"lambda", point.lambda},
                  {"negative_directions", point.negative_directions},
                  {"monitors", monitors_json(system, options_.monitor)},
                  {"reactions", reactions_json(system, boundary_, system.reactions())}});
}

void StageRunner::save_point(Checkpoint& bookmark, bool always) {
  bookmark.point->place = static_cast<const assembly::Place&>(*context_.system().keep());
  bookmark.point->entry = entries_;
  bookmark.point->way = way_;
  bookmark.point->critical = critical_;
  context_.checkpoints.save_point(bookmark, always);
}

analysis::PathSummary StageRunner::follow_stage(const StageOptions& stage, bool is_last,
                                                const assembly::OutOfBalance& imbalance,
                                                Checkpoint& bookmark) {
  const bool walks = is_last && options_.control == Control::arc_length;
  analysis::PathStart start;
  start.last_resort = last_resort_of(options_.fallback);
  start.unknown = options_.fallback == Fallback::automatic && context_.is_lost(imbalance);
  if (context_.resume) {
    context_.system().return_to(context_.resume->place);
    start.unknown = false;
    start.lambda = context_.resume->place.lambda;
    start.arc = context_.resume->arc;
    context_.resume.reset();
  }
  analysis::PathCallback callback;
  callback.converged = [&](const analysis::PathPoint& point) {
    if (is_last) note(point);
    bookmark.point->arc = point.arc;
    if (walks || point.lambda < 1) save_point(bookmark, false);
  };
  callback.critical = [&](const analysis::CriticalPoint& point) {
    critical_.push_back(critical_point_json(context_.system(), point, options_.monitor));
    critical_.back()["stage"] = stage.name;
  };
  callback.gave_up = [&](const analysis::LastResortSummary& tried) {
    context_.progress.say(fmt::format("{} | {}: Newton's method gave up at lambda = {:.4g}; {} follows",
                                      context_.step_name, stage.name, tried.gave_up_at,
                                      key_of(tried.method)));
  };
  if (walks) return walk(stage.name, callback, start);
  return follow(context_, stage.name, is_last ? options_.increments : 1, callback, start);
}

Diagnosis StageRunner::diagnosis(bool unstable) const {
  const auto& last = entries_.back();
  Ending ending;
  ending.lambda = last["lambda"];
  ending.found = last["lambda_steps"] > 0 || entries_.size() > 1;
  ending.unstable = unstable;
  ending.bifurcated = std::any_of(critical_.begin(), critical_.end(),
                                  [](const Json& point) { return point["kind"] == "bifurcation"; });
  ending.worst_node = imbalance_.node;
  ending.out_of_balance = imbalance_.force;
  return diagnose(context_, beginning_, ending);
}

/// A part that nothing holds is told as such; where the stage began with resistance it is what acts that took
/// it away, and no support is to blame.
void StageRunner::refuse_mechanism(const StageOptions& stage, const analysis::PathSummary& path,
                                   const analysis::PathProblem::Kept& at_start, bool is_last) {
  auto& system = context_.system();
  if (path.reached && path.inertia.null > 0)
    if (const auto slack = assembly::find_slack(system, context_.workspace())) {
      if (is_last && !slack->nodes.empty()) context_.warn("slack", slack->text);
      return;
    }
  const bool fell = !path.reached && path.points.empty();
  if (!fell && path.inertia.null == 0) return;
  if (fell && analysis::gives_way(system, context_.workspace())) return;  // slack, and no mechanism
  const auto mechanism = assembly::find_mechanism(system, context_.workspace());
  if (!mechanism) return;
  const auto refuse = [&](const std::string& text) {
    throw ModelError(fmt::format("stage \"{}\": {}", stage.name, text));
  };
  if (const auto loose = assembly::find_loose_part(system.model(), boundary_)) refuse(loose->text);
  if (!path.points.empty()) {
    const auto there = system.keep();
    system.return_to(at_start);
    const bool stiff = !assembly::find_mechanism(system, context_.workspace());
    system.return_to(*there);
    if (stiff) refuse(fmt::format("{}. It was stiff before: {}", mechanism->motion, diagnosis(false).text()));
  }
  refuse(mechanism->text);
}

bool StageRunner::run(const StageOptions& stage, const std::vector<std::string>& loads, bool is_last) {
  auto& system = context_.system();
  double seconds = 0;
  auto watch = std::make_optional<Stopwatch>(seconds);
  const bool anew = context_.resume.has_value();
  if (anew) system.restore(context_.resume->start);
  context_.acting_loads = loads;
  boundary_ =
      options_.support == Ground::free ? context_.free_boundary(true) : context_.boundary(stage.hold, true);
  Checkpoint bookmark = context_.checkpoints.latest();
  bookmark.point.emplace();
  bookmark.point->stage = static_cast<int>(entries_.size());
  bookmark.point->start = system.rest();
  const auto start = imbalance_ = system.begin_stage(boundary_);
  const auto at_start = system.keep();
  context_.progress.say(fmt::format("{} | {}: out-of-balance at the start {:.3e} N", context_.step_name,
                                    stage.name, start.force));
  if (!anew && !entries_.empty()) save_point(bookmark, true);
  auto path = follow_stage(stage, is_last, start, bookmark);
  watch.reset();
  if (path.reached) context_.equilibrium_known = true;
  if (path.reached && path.descent_steps > 0)
    context_.progress.say(
        fmt::format("{} | {}: Newton's method failed from this start; {} steps downhill in energy led to the "
                    "equilibrium",
                    context_.step_name, stage.name, path.descent_steps));
  draw_critical_points(context_, path, critical_.size() - path.critical.size() + 1);
  entries_.push_back(entry_of(stage, start, path, seconds));
  refuse_mechanism(stage, path, *at_start, is_last);
  if (path.last_resort)
    entries_.back()[key_of(path.last_resort->method)] = last_resort_json(*path.last_resort);
  return path.reached;
}

}  // namespace tautline::steps
