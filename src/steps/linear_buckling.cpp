#include "steps/linear_buckling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include <tautline/analysis/stability.hpp>
#include <tautline/assembly/mechanism.hpp>
#include <tautline/assembly/slack.hpp>
#include <tautline/core/error.hpp>

#include "steps/buckling_course.hpp"

namespace tautline::steps {

namespace {

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

using assembly::Branch;
using Sign = BucklingOptions::Sign;

/// Why the present state has no factors, or nothing. Parts that hang slack and that nothing loads are braced.
std::string why_unstable(assembly::System& system, analysis::Workspace& workspace,
                         std::optional<assembly::Bracing>& bracing) {
  int negative = analysis::count_negative(system, workspace);
  if (workspace.solver.inertia().null > 0 || !workspace.solver.failure().empty()) {
    bracing.emplace(system, workspace);
    const auto mechanism = bracing->holds() ? std::nullopt : assembly::find_mechanism(system, workspace);
    if (mechanism) throw ModelError(fmt::format("linear buckling: {}", mechanism->text));
    negative = analysis::count_negative(system, workspace);
  }
  if (negative == 0) return "";
  return fmt::format(
      "the present state is unstable already: {} negative pivot{}. Buckling is looked for from a stable "
      "state, so take away loads that act (loads of an equilibrium before)",
      negative, negative == 1 ? "" : "s");
}

/// Whether elements answer a load and the opposite one differently.
bool one_sided(assembly::System& system) {
  la::Vector none(system.layout());
  none.set_zero();
  return system.may_wrinkle() || !system.pulls(none, 1).empty();
}

/// Whether all there is has a convex energy: cables, and cloth that wrinkles, under loads that do not follow.
bool never_buckles(const model::Model& model) {
  const auto kind_of = [&](const auto& element) -> const model::Group& {
    return model.groups[static_cast<std::size_t>(element.group)];
  };
  return model.beams.empty() && model.shells.empty() && model.springs.empty() && model.links.empty() &&
         std::none_of(model.cables.begin(), model.cables.end(),
                      [&](const auto& cable) { return kind_of(cable).kind == model::ElementKind::bar; }) &&
         std::all_of(model.membranes.begin(), model.membranes.end(),
                     [&](const auto& m) { return kind_of(m).membrane.wrinkling; }) &&
         std::all_of(model.loads.begin(), model.loads.end(),
                     [](const auto& load) { return load.pressure == 0; });
}

void doubt_slack(const BucklingCourse& course, double sense, LinearBuckling& found) {
  const auto next = course.next_switch();
  if (!next) return;
  if (course.stopped_short())
    found.doubts.push_back(
        {"buckling_many_slack",
         fmt::format("cables go slack and taut so often that this was followed only to load factor {:.5g}: "
                     "beyond it the factors let cables push that would be slack",
                     sense * *next)});
  else if (!course.factors().empty() && course.factors().back() > *next * (1 + 1e-9))
    found.doubts.push_back(
        {"buckling_slack",
         fmt::format("at load factor {:.5g}, behind the first, a cable goes slack or taut: factors beyond it "
                     "take the cables as they are at the first",
                     sense * *next)});
}

/// 2 P / E A at the first factor, where that is no longer small.
void doubt_strain(const assembly::System& system, const BucklingCourse& course, double sense,
                  LinearBuckling& found) {
  constexpr double large = 0.02;
  if (course.factors().empty() || course.factors().front() == 0) return;
  const double factor = course.factors().front();
  la::Vector mean = course.response_at(factor);
  mean.scale(1 / factor);
  const auto strains = system.largest_strains(mean);
  const auto most = std::max_element(strains.begin(), strains.end());
  const double measure = 2 * std::abs(*most * factor);
  if (!(measure > large)) return;
  found.doubts.push_back(
      {"buckling_large_strain",
       fmt::format("at load factor {:.5g} members of \"{}\" are strained by {:.3g} % before they buckle, "
                   "2 P/EA = {:.3g} %: linear buckling leaves out effects of this size. Ask for the path "
                   "(control: arc_length, or the step collapse)",
                   sense * factor,
                   system.model().groups[static_cast<std::size_t>(most - strains.begin())].name, 50 * measure,
                   100 * measure)});
}

/// Factors of loads times `sense`, nearest to zero first.
void find_along(Context& context, const std::vector<std::string>& loads, int modes, double sense,
                la::Extreme which, LinearBuckling& found) {
  auto& system = context.system();
  auto& workspace = context.workspace();
  system.begin_stage(boundary_with(context, loads, sense));
  std::optional<assembly::Bracing> bracing;
  found.failure = why_unstable(system, workspace, bracing);
  if (!found.failure.empty()) return;
  const bool changes = system.changes_at_rest();
  BucklingCourse course(system, workspace);
  if (!changes || !course.stresses())
    throw ModelError(fmt::format(
        "linear buckling: the loads that grow ({}) stress nothing, so that nothing can buckle under them. "
        "Name loads that press the structure: loads: [...]",
        loads.empty() ? "none" : fmt::format("{}", fmt::join(loads, ", "))));
  std::vector<double> known;  // on the other side
  for (const double factor : found.factors) known.push_back(std::abs(factor));
  std::sort(known.begin(), known.end());
  const auto enough = static_cast<std::size_t>(modes);
  course.find(modes, which,
              known.size() >= enough ? known[enough - 1] : std::numeric_limits<double>::infinity());
  doubt_slack(course, sense, found);
  doubt_strain(system, course, sense, found);
  auto& slack = found.slack[sense > 0 ? "positive" : "negative"];
  const auto& cables = system.model().cables;
  for (std::size_t i = 0; i < cables.size() && !course.factors().empty(); ++i)
    if (course.branches()[i] == Branch::slack)
      ++slack[system.model().groups[static_cast<std::size_t>(cables[i].group)].name];
  auto& pairs = course.pairs();
  for (std::size_t i = 0; i < course.factors().size(); ++i) {
    found.factors.push_back(sense * course.factors()[i]);
    found.residuals.push_back(pairs.residuals[i]);
    found.modes.push_back(std::move(pairs.vectors[i]));
  }
}

/// The `count` factors nearest to zero.
void sort_and_cut(LinearBuckling& found, int count) {
  std::vector<std::size_t> order(found.factors.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return std::abs(found.factors[i]) < std::abs(found.factors[j]);
  });
  order.resize(std::min<std::size_t>(order.size(), static_cast<std::size_t>(count)));
  LinearBuckling kept;
  for (const std::size_t i : order) {
    kept.factors.push_back(found.factors[i]);
    kept.residuals.push_back(found.residuals[i]);
    kept.modes.push_back(std::move(found.modes[i]));
  }
  found.factors = std::move(kept.factors);
  found.residuals = std::move(kept.residuals);
  found.modes = std::move(kept.modes);
}

}  // namespace

std::vector<std::string> scaled_loads(const Context& context,
                                      const std::optional<std::vector<std::string>>& given,
                                      const std::vector<std::string>& but) {
  if (given) return *given;
  std::vector<std::string> names;
  for (const auto& load : context.deck.loads)
    if (!has(context.acting_loads, load.name) && !has(but, load.name)) names.push_back(load.name);
  return names;
}

assembly::Boundary boundary_with(Context& context, const std::vector<std::string>& loads, double factor) {
  auto boundary = context.boundary({}, true);
  for (const auto& load : context.system().model().loads)
    if (has(loads, load.name)) boundary.loads.push_back(model::scaled(load, factor));
  return boundary;
}

double reference_load(Context& context, const std::vector<std::string>& loads) {
  double force = 0, moment = 0;
  for (const auto& load : context.system().model().loads) {
    if (!has(loads, load.name)) continue;
    force += static_cast<double>(load.nodes.size()) * load.force.norm();
    moment += static_cast<double>(load.nodes.size()) * load.moment.norm();
  }
  return force > 0 ? force : moment;
}

void require_compression(const model::Model& model) {
  if (never_buckles(model))
    throw ModelError(
        "linear buckling: cables, and cloth that wrinkles, carry no compression, so that no load makes a "
        "structure of them alone buckle. Ask for an equilibrium, or for modes");
}

std::string come_to_rest(Context& context) {
  context.system().begin_stage(context.boundary({}, true));
  const auto path = follow(context, "at rest");
  return path.reached ? "" : "no equilibrium under what acts already: " + path.reason;
}

LinearBuckling linear_buckling(Context& context, const std::vector<std::string>& loads, int modes,
                               Sign sign) {
  auto& system = context.system();
  require_compression(system.model());
  LinearBuckling found;
  const auto rest = system.rest();
  if (sign == Sign::both && !one_sided(system)) {
    find_along(context, loads, modes, 1, la::Extreme::both, found);
  } else {
    for (const double sense : {1.0, -1.0}) {
      if (sign == (sense > 0 ? Sign::negative : Sign::positive) || !found.failure.empty()) continue;
      find_along(context, loads, modes, sense, la::Extreme::lowest, found);
      system.restore(rest);
    }
    sort_and_cut(found, modes);
  }
  system.restore(rest);
  return found;
}

}  // namespace tautline::steps
