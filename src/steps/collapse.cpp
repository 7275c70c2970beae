#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <tautline/core/error.hpp>

#include "steps/context.hpp"
#include "steps/imperfection.hpp"
#include "steps/linear_buckling.hpp"
#include "steps/mode_shapes.hpp"
#include "steps/path_results.hpp"
#include "steps/summaries.hpp"

namespace tautline::steps {

namespace {

/// Length of the mean displacement of what is watched from its place in the perfect structure: that of an
/// imperfection, if any, and the motion [m].
double watched_motion(const assembly::System& system, const std::vector<int>& nodes,
                      const Points& imperfection) {
  Vec3 mean = Vec3::Zero();
  for (const int node : nodes) {
    const auto i = static_cast<std::size_t>(node);
    mean += system.state().displacement[i] / static_cast<double>(nodes.size());
    if (!imperfection.empty()) mean += imperfection[i] / static_cast<double>(nodes.size());
  }
  return mean.norm();
}

/// Names put together, each once.
std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b) {
  for (const auto& name : b)
    if (std::find(a.begin(), a.end(), name) == a.end()) a.push_back(name);
  return a;
}

/// The published rule: equal load steps on the disturbed structure until one of them makes the motion grow
/// too much.
struct RuleResult {
  Json path = Json::array();
  double critical = 0;
  std::string criterion;
};

RuleResult follow_rule(Context& context, const CollapseOptions& options,
                       const std::vector<std::string>& loads, double linear,
                       const Points& imperfection = {}) {
  auto& system = context.system();
  RuleResult result;
  const auto nodes = system.model().nodes_of(options.monitor);
  const auto rest = system.rest();
  const auto acting = context.acting_loads;
  context.acting_loads = joined(acting, options.disturbance);
  std::string failure = come_to_rest(context);
  const double start = watched_motion(system, nodes, imperfection);
  if (failure.empty()) result.path.push_back({{"lambda", 0.0}, {"monitor", start}});
  double before = start;
  for (int k = 1; failure.empty() && k * options.step <= options.last * (1 + 1e-12); ++k) {
    const double lambda = k * options.step * linear;
    system.begin_stage(boundary_with(context, loads, lambda));
    const auto path = follow(context, fmt::format("load factor {:.4g}", lambda));
    if (!path.reached) {
      result.criterion = fmt::format("no equilibrium at load factor {:.5g}: {}", lambda, path.reason);
      break;
    }
    const double now = watched_motion(system, nodes, imperfection);
    result.path.push_back({{"lambda", lambda}, {"monitor", now}});
    // A motion that grows as the load does is no sign of anything.
    if (k > 1 && now > before * std::max(options.growth, k / (k - 1.0))) {
      result.criterion = fmt::format(
          "the monitored displacement grows {:.4g} times, more than {:g}, in the next step of {:g} of "
          "the linear value",
          now / before, options.growth, options.step);
      break;
    }
    result.critical = lambda;
    before = now;
  }
  if (!failure.empty()) result.criterion = failure;
  if (result.criterion.empty())
    result.criterion =
        fmt::format("no step up to {:g} of the linear value grows {:g} times", options.last, options.growth);
  context.acting_loads = acting;
  system.restore(rest);
  return result;
}

/// The published rule on the structure with its nodes displaced by `shape` before it is loaded; afterwards
/// the perfect one is back where it was.
RuleResult follow_imperfect(Context& context, const CollapseOptions& options,
                            const std::vector<std::string>& loads, double linear, const Points& shape) {
  const model::Model perfect = context.system().model();
  const auto rest = context.system().rest();
  context.set_system(made_imperfect(perfect, shape));
  context.system().restore(rest);
  auto result = follow_rule(context, options, loads, linear, shape);
  context.set_system(perfect);
  context.system().restore(rest);
  return result;
}

/// The path of the undisturbed structure to its first critical point.
Json follow_undisturbed(Context& context, const CollapseOptions& options,
                        const std::vector<std::string>& loads, double linear, Json& entry) {
  auto& system = context.system();
  const auto rest = system.rest();
  auto arc = options.arc_length;
  arc.stop_at_critical = 1;
  arc.load_factor = 2 * options.last;
  system.begin_stage(boundary_with(context, loads, linear));
  const auto path = follow_arc(context, "undisturbed", arc);
  draw_critical_points(context, path);
  Json critical = Json::array();
  for (const auto& met : path.critical) {
    critical.push_back(critical_point_json(system, met, options.monitor));
    auto& point = critical.back();
    point["lambda"] = point["lambda"].get<double>() * linear;
    const bool limit = point["kind"] == "limit";
    entry[limit ? "limit_lambda" : "bifurcation_lambda"] = point["lambda"];
  }
  if (critical.empty()) entry["undisturbed"] = path.reason;
  system.restore(rest);
  return critical;
}

std::string too_few_modes(const LinearBuckling& found, const CollapseOptions& options) {
  if (found.factors.empty())
    return "no positive factor makes the structure buckle: give linear_factor, of which `step` is a part, "
           "and no "
           "imperfection";
  return fmt::format("the imperfection asks for mode {}, but linear buckling has only {} positive factor{}",
                     options.imperfection.mode, found.factors.size(), found.factors.size() == 1 ? "" : "s");
}

}  // namespace

Json run_step(Context& context, const CollapseOptions& options) {
  const auto loads = scaled_loads(context, options.loads, options.disturbance);
  Json entry{{"status", "done"}};
  const auto fail = [&](const std::string& reason) {
    entry["status"] = "not_converged";
    entry["reason"] = reason;
    return entry;
  };
  if (const auto reason = come_to_rest(context); !reason.empty()) return fail(reason);
  const auto& [mode, amplitude] = options.imperfection;
  double linear = options.linear_factor.value_or(0);
  Points shape;  // of the imperfection
  if (!options.linear_factor || amplitude != 0) {
    const int modes = amplitude != 0 ? mode : 1;
    const auto found = linear_buckling(context, loads, modes, BucklingOptions::Sign::positive);
    if (!found.failure.empty()) return fail(found.failure);
    for (const auto& doubt : found.doubts) context.warn(doubt.code, doubt.message);
    if (static_cast<int>(found.factors.size()) < modes) return fail(too_few_modes(found, options));
    if (!options.linear_factor) linear = found.factors.front();
    if (amplitude != 0) {
      shape = display_shape(context.system(), found.modes[static_cast<std::size_t>(mode - 1)]);
      for (Vec3& v : shape) v *= amplitude;
    }
  }
  entry["linear_lambda"] = linear;
  const auto rule = shape.empty() ? follow_rule(context, options, loads, linear)
                                  : follow_imperfect(context, options, loads, linear, shape);
  entry["critical_lambda"] = rule.critical;
  entry["criterion"] = rule.criterion;
  entry["path"] = rule.path;
  entry["critical_points"] = follow_undisturbed(context, options, loads, linear, entry);
  if (const double reference = reference_load(context, loads); reference > 0) {
    entry["critical_load"] = rule.critical * reference;
    entry["safety_factors"] = Json::array();
    for (const double force : options.working_forces)
      entry["safety_factors"].push_back(rule.critical * reference / force);
  }
  return entry;
}

}  // namespace tautline::steps
