#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include <tautline/analysis/stability.hpp>

#include "steps/context.hpp"
#include "steps/imperfection.hpp"
#include "steps/linear_buckling.hpp"
#include "steps/mode_shapes.hpp"
#include "steps/path_results.hpp"
#include "steps/summaries.hpp"

namespace tautline::steps {

namespace {

/// Mean of a nodal field over some nodes.
Vec3 mean_of(const Points& field, const std::vector<int>& nodes) {
  Vec3 mean = Vec3::Zero();
  for (const int node : nodes) mean += field[static_cast<std::size_t>(node)];
  return mean / static_cast<double>(nodes.size());
}

/// What the rule is asked: loads that grow, their linear value, and where the undisturbed structure stands
/// and becomes critical.
struct Question {
  std::vector<std::string> loads;
  double linear = 0;
  assembly::Rest rest;          ///< of the undisturbed structure at the start of the step
  std::optional<double> first;  ///< load factor of its first critical point
  Points shape;                 ///< of the imperfection; may be empty
};

/// Signs of an imperfection and of the disturbance.
struct Signs {
  int imperfection = 1, disturbance = 1;
};

/// The published rule: equal load steps on the disturbed structure until one of them makes the motion grow
/// too much.
struct RuleResult {
  Json path = Json::array();
  double critical = 0;
  std::string criterion;
};

/// One run of the rule, on the system as it is (with its imperfection, if any).
class Rule {
 public:
  Rule(Context& context, const CollapseOptions& options, const Question& question, const Signs& signs)
      : context_(context),
        options_(options),
        question_(question),
        signs_(signs),
        nodes_(context.system().model().nodes_of(options.monitor)) {}

  RuleResult run() {
    follow_stage(0, "disturbed");
    for (int k = 1; result_.criterion.empty() && k * options_.step <= options_.last * (1 + 1e-12); ++k)
      make_step(k);
    if (result_.criterion.empty())
      result_.criterion = fmt::format("no step up to {:g} of the linear value grows {:g} times",
                                      options_.last, options_.growth);
    return std::move(result_);
  }

 private:
  /// What is watched, from its place in the undisturbed structure at the start of the step: imperfection and
  /// motion [m].
  Vec3 motion() const {
    Vec3 mean = mean_of(context_.system().state().displacement, nodes_) -
                mean_of(question_.rest.state.displacement, nodes_);
    if (!question_.shape.empty()) mean += signs_.imperfection * mean_of(question_.shape, nodes_);
    return mean;
  }

  /// Notes the point, or why there is none or it tells nothing.
  void follow_stage(double lambda, const std::string& what) {
    const auto has = [](const std::vector<std::string>& names, const std::string& name) {
      return std::find(names.begin(), names.end(), name) != names.end();
    };
    auto boundary =
        lambda > 0 ? boundary_with(context_, question_.loads, lambda) : context_.boundary({}, true);
    for (const auto& load : context_.system().model().loads)
      if (has(options_.disturbance, load.name) && !has(context_.acting_loads, load.name))
        boundary.loads.push_back(model::scaled(load, signs_.disturbance));
    context_.system().begin_stage(boundary);
    const auto path = follow(context_, what);
    if (!path.reached)
      result_.criterion = fmt::format("no equilibrium at load factor {:.5g}: {}", lambda, path.reason);
    else if (path.inertia.negative > 0)
      result_.criterion =
          fmt::format("the disturbed structure is unstable at load factor {:.5g}: {} negative pivot{}",
                      lambda, path.inertia.negative, path.inertia.negative == 1 ? "" : "s");
    else
      note(lambda, motion());
  }

  void note(double lambda, const Vec3& motion) {
    motions_.push_back(motion);
    result_.path.push_back({{"lambda", lambda}, {"monitor", motion.norm()}});
  }

  void make_step(int k) {
    const double lambda = k * options_.step * question_.linear;
    if (question_.first && lambda > *question_.first) {
      result_.criterion = fmt::format(
          "the next step of {:g} of the linear value passes the first critical point of the undisturbed "
          "structure at load factor {:.5g}",
          options_.step, *question_.first);
      return;
    }
    const double largest = largest_so_far(), expected = proportional(k).norm();
    follow_stage(lambda, fmt::format("load factor {:.4g}", lambda));
    if (!result_.criterion.empty()) return;
    const double now = motions_.back().norm();
    if (k > 1 && now > options_.growth * largest && now > proportion * expected) {
      result_.criterion = fmt::format(
          "the monitored displacement grows {:.4g} times, more than {:g}, in the next step of {:g} of "
          "the linear value",
          now / largest, options_.growth, options_.step);
      return;
    }
    result_.critical = lambda;
  }

  /// An imperfection may point against the motion under the load, which then passes through zero.
  double largest_so_far() const {
    double largest = 0;
    for (const Vec3& motion : motions_) largest = std::max(largest, motion.norm());
    return largest;
  }

  /// Where a motion that has grown as the load did until step k - 1 comes in step k: growing so is no sign of
  /// anything, in the first steps least of all.
  Vec3 proportional(int k) const {
    return motions_.back() + (motions_.back() - motions_.front()) / std::max(1, k - 1);
  }

  static constexpr double proportion = 1.25;  // a motion is more than proportional from here on
  Context& context_;
  const CollapseOptions& options_;
  const Question& question_;
  Signs signs_;
  std::vector<int> nodes_;
  Points motions_;  // at the points of the path
  RuleResult result_;
};

/// The rule on the structure with its nodes displaced by the imperfection before it is loaded; afterwards the
/// perfect one is back where it was.
RuleResult follow_rule(Context& context, const CollapseOptions& options, const Question& question,
                       const Signs& signs) {
  if (question.shape.empty()) {
    auto result = Rule(context, options, question, signs).run();
    context.system().restore(question.rest);
    return result;
  }
  const model::Model perfect = context.system().model();
  Points shape = question.shape;
  for (Vec3& v : shape) v *= signs.imperfection;
  context.set_system(made_imperfect(perfect, shape));
  context.system().restore(question.rest);
  auto result = Rule(context, options, question, signs).run();
  context.set_system(perfect);
  context.system().restore(question.rest);
  if (const auto reason = come_to_rest(context); !reason.empty())  // on its supports, which are of a stage
    throw LibraryError("collapse: the state before the imperfection is not found again: " + reason);
  return result;
}

/// The smallest result over both signs of what is wrong with the structure: which way it leans is chance, and
/// what acts already may lean against it.
RuleResult follow_both_signs(Context& context, const CollapseOptions& options, const Question& question,
                             Json& entry) {
  std::vector<Signs> all;
  for (const int imperfection : {1, -1})
    for (const int disturbance : {1, -1})
      if ((imperfection == 1 || !question.shape.empty()) &&
          (disturbance == 1 || !options.disturbance.empty()))
        all.push_back({imperfection, disturbance});
  std::optional<RuleResult> least;
  Json tried = Json::array();
  for (const auto& signs : all) {
    auto result = follow_rule(context, options, question, signs);
    tried.push_back({{"imperfection", signs.imperfection},
                     {"disturbance", signs.disturbance},
                     {"critical_lambda", result.critical},
                     {"criterion", result.criterion}});
    if (!least || result.critical < least->critical) least = std::move(result);
  }
  if (all.size() > 1) entry["signs"] = std::move(tried);
  return std::move(*least);
}

/// What is to be said where the rule ends far below the first critical point beside it.
std::string explanation(const RuleResult& rule, const CollapseOptions& options, const Question& question) {
  const double far = std::min(0.8, 1 - 4 * options.step);  // where the rule ends of itself
  if (!question.first || rule.critical >= far * *question.first) return "";
  const bool disturbed = !question.shape.empty() || !options.disturbance.empty();
  return fmt::format(
      "; the undisturbed structure becomes critical at load factor {:.5g} only, {:.3g} times as much: {}",
      *question.first, *question.first / std::max(rule.critical, 1e-300),
      disturbed
          ? "what is watched is moved that much by the imperfection or the disturbance, which are large, "
            "or in another way than the critical mode's"
          : "what is watched moves in another way than the critical mode's");
}

/// The path of the undisturbed structure to its first critical point.
Json follow_undisturbed(Context& context, const CollapseOptions& options,
                        const std::vector<std::string>& loads, double linear, Json& entry) {
  auto& system = context.system();
  const auto rest = system.rest();
  auto arc = options.arc_length;
  arc.largest_step =  // passes no two limits
      std::min(arc.largest_step, std::max(1.0, 2 * options.step / arc.first_step));
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
  if (const int negative = analysis::count_negative(context.system(), context.workspace()); negative > 0)
    return fail(fmt::format("the present state is unstable already: {} negative pivot{}", negative,
                            negative == 1 ? "" : "s"));
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
  const Json critical_points = follow_undisturbed(context, options, loads, linear, entry);
  Question question{loads, linear, context.system().rest(), {}, std::move(shape)};
  if (!critical_points.empty()) question.first = critical_points.front()["lambda"].get<double>();
  const auto rule = follow_both_signs(context, options, question, entry);
  entry["critical_lambda"] = rule.critical;
  entry["criterion"] = rule.criterion + explanation(rule, options, question);
  entry["path"] = rule.path;
  entry["critical_points"] = critical_points;
  if (const double reference = reference_load(context, loads); reference > 0) {
    entry["critical_load"] = rule.critical * reference;
    entry["safety_factors"] = Json::array();
    for (const double force : options.working_forces)
      entry["safety_factors"].push_back(rule.critical * reference / force);
  }
  return entry;
}

}  // namespace tautline::steps
