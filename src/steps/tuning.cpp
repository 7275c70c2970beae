#include <tautline/reflector/tuning.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <tautline/assembly/influence.hpp>
#include <tautline/core/error.hpp>
#include <tautline/model/element_data.hpp>
#include <tautline/model/response.hpp>

#include "steps/context.hpp"
#include "steps/summaries.hpp"
#include "steps/state_pictures.hpp"
#include "steps/fields.hpp"
#include "steps/prepare.hpp"

namespace tautline::steps {

namespace {

using reflector::TuningMethod;

double length_now(const assembly::System& system, const std::array<int, 2>& nodes) {
  const auto at = [&](int node) -> Vec3 {
    return system.model().nodes[node] + system.state().displacement[node];
  };
  return (at(nodes[1]) - at(nodes[0])).norm();
}

/// Displacements of the surface and tie tensions for a unit change of each tie's unstressed length.
reflector::TieInfluence tie_influence(Context& context, const std::vector<int>& ties,
                                      const reflector::SurfaceSample& sample) {
  auto& system = context.system();
  const auto& model = system.model();
  std::vector<int> nodes = sample.surface_nodes;
  for (const int tie : ties)
    nodes.insert(nodes.end(), model.cables[tie].nodes.begin(), model.cables[tie].nodes.end());
  const MatX all = assembly::length_influence(system, context.workspace(), ties, nodes);
  const auto n_surface = static_cast<Eigen::Index>(3 * sample.surface_nodes.size());
  const auto n = static_cast<Eigen::Index>(ties.size());
  reflector::TieInfluence influence{sample.surface_nodes, all.topRows(n_surface), MatX::Zero(n, n), VecX(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& cable = model.cables[ties[static_cast<std::size_t>(i)]];
    const double stiffness = model.axial_stiffness(cable), unstressed = model.unstressed_length(cable);
    const auto& [a, b] = cable.nodes;
    const double length = length_now(system, cable.nodes);
    const Vec3 direction = (system.model().nodes[b] + system.state().displacement[b] -
                            system.model().nodes[a] - system.state().displacement[a]) /
                           length;
    const auto row = n_surface + 6 * i;
    influence.tension.row(i) = stiffness / unstressed * direction.transpose() *
                               (all.middleRows(row + 3, 3) - all.middleRows(row, 3));
    influence.tension(i, i) -= stiffness * length / (unstressed * unstressed);
    influence.present_tension[i] = std::max(0.0, stiffness * (length / unstressed - 1));
  }
  return influence;
}

/// The cables of all groups to be tuned. @throws ModelError for a group without cables, and for one that the
/// rule does not know what to do with
std::vector<int> tuned_cables(Context& context, const reflector::TuningOptions& options) {
  const auto& model = context.system().model();
  std::vector<bool> in_front(model.nodes.size(), false);
  for (const int node : surface_sample(context).net_nodes) in_front[node] = true;
  std::vector<int> ties;
  for (const auto& group : options.ties) {
    const auto cables = model.select(group).cables;
    if (cables.empty()) throw ModelError(fmt::format("tuning: group \"{}\" has no cables", group));
    for (const int cable : cables)
      if (options.method == TuningMethod::rule && !in_front[model.cables[cable].nodes[0]])
        throw ModelError(fmt::format(
            "tuning: the rule shortens a tie by the deviation of its front node, but the cables of "
            "\"{}\" do not begin at the front net's nodes; method: sensitivity tunes any cables",
            group));
    ties.insert(ties.end(), cables.begin(), cables.end());
  }
  return ties;
}

VecX changes(Context& context, const std::vector<int>& ties, const reflector::TuningOptions& options) {
  const auto sample = surface_sample(context);
  if (options.method == TuningMethod::sensitivity)
    return reflector::sensitivity_change(*context.surface, sample, tie_influence(context, ties, sample),
                                         options);
  Points fronts;
  for (const int tie : ties)
    fronts.push_back(sample.positions[context.system().model().cables[tie].nodes[0]]);
  VecX change = reflector::rule_change(*context.surface, fronts);
  return change.cwiseMax(-options.max_change).cwiseMin(options.max_change);
}

/// Strains of all cables with the ties' unstressed lengths changed. @throws ModelError if a tie would have no
/// length
std::vector<double> changed_strains(const model::Model& model, const std::vector<int>& ties,
                                    const VecX& change) {
  std::vector<double> strains;
  for (const auto& cable : model.cables) strains.push_back(cable.initial_strain);
  for (std::size_t i = 0; i < ties.size(); ++i) {
    const auto& tie = model.cables[ties[i]];
    const double length = model.reference_length(tie),
                 unstressed = model.unstressed_length(tie) + change[static_cast<Eigen::Index>(i)];
    if (unstressed <= 0)
      throw ModelError(
          fmt::format("tuning: tie {} of {:.4g} m would have to be shortened by {:.4g} m; a larger "
                      "reflector.gap gives it room",
                      i + 1, length, -change[static_cast<Eigen::Index>(i)]));
    strains[ties[i]] = length / unstressed - 1;
  }
  return strains;
}

void draw_passes(Context& context, const Json& passes) {
  if (!context.draws()) return;
  output::Curve curve{"about the mean, all nodes", {}, {}, true}, area{"weighted by area", {}, {}, true};
  for (std::size_t i = 0; i < passes.size(); ++i) {
    curve.x.push_back(static_cast<double>(i));
    area.x.push_back(static_cast<double>(i));
    curve.y.push_back(1e3 * passes[i]["rms"].get<double>());
    area.y.push_back(1e3 * passes[i]["rms_area_weighted"].get<double>());
  }
  output::Chart chart;
  chart.title = "Surface error by tuning pass";
  chart.x_label = "tuning pass";
  chart.y_label = "RMS [mm]";
  chart.curves = {curve, area};
  context.draw("rms",
               "RMS of the deviation from the paraboloid by tuning pass, unweighted over nodes (eq. "
               "3.13) and weighted by area (eq. 3.1)",
               chart);
}

Json pass_json(const reflector::SurfaceError& error, double change) {
  return {{"rms", error.rms},
          {"max_change", change},
          {"rms_area_weighted", error.rms_area_weighted},
          {"rms_nodes", error.rms_nodes}};
}

double least_tension(const assembly::System& system, const std::vector<int>& ties) {
  const auto response = model::evaluate_response(system.model(), system.state());
  double least = response.cables[ties[0]].tension;
  for (const int tie : ties) least = std::min(least, response.cables[tie].tension);
  return least;
}

double measure_of(const reflector::SurfaceError& error, const reflector::TuningOptions& options) {
  const bool area =
      options.method == TuningMethod::sensitivity && options.objective == reflector::TuningObjective::area;
  return area ? error.rms_area_weighted : error.rms;
}

/// One pass: lengths changed along a path. @return the path's summary
analysis::PathSummary make_pass(Context& context, const std::vector<int>& ties, const VecX& change,
                                int pass) {
  auto& system = context.system();
  system.set_target_strains(changed_strains(system.model(), ties, change));
  system.begin_stage(context.boundary({}, true));
  return follow(context, fmt::format("pass {}", pass));
}

}  // namespace

void prepare(Context& context, const TuningStepOptions& step) {
  if (!context.surface) throw ModelError("tuning needs a reflector: this deck has none");
  tuned_cables(context, step.tuning);
  context.system().begin_stage(context.boundary({}, true));
}

Json run_step(Context& context, const TuningStepOptions& step) {
  auto options = step.tuning;
  prepare(context, step);
  auto& system = context.system();
  const auto ties = tuned_cables(context, options);
  if (std::isnan(options.tension_min)) options.tension_min = 0.5 * least_tension(system, ties);
  auto error = measure(context);
  Json entry{{"status", "done"}, {"method", options.method == TuningMethod::rule ? "rule" : "sensitivity"}};
  Json passes = Json::array({pass_json(error, 0)});
  int newton = 0;
  for (int pass = 1; pass <= options.max_passes; ++pass) {
    const auto state_before = system.state();
    const auto strains_before = system.strains();
    const VecX change = changes(context, ties, options);
    const auto path = make_pass(context, ties, change, pass);
    newton += path.newton_iterations;
    const auto error_before = error;
    error = measure(context);
    const double before = measure_of(error_before, options), after = measure_of(error, options);
    passes.push_back(pass_json(error, change.cwiseAbs().maxCoeff()));
    context.progress.say(fmt::format("{} | pass {}: RMS {:.4f} mm, largest change {:.3e} m",
                                     context.step_name, pass, 1e3 * error.rms, change.cwiseAbs().maxCoeff()));
    if (!path.reached) {
      entry["status"] = "not_converged";
      entry["reason"] =
          fmt::format("pass {} {}. Try a smaller max_change or a larger reflector.gap", pass, path.reason);
      break;
    }
    if (after > before * (1 + options.tolerance)) {
      system.set_state(state_before, strains_before);
      error = error_before;
      entry["reason"] = fmt::format("pass {} made the error larger ({:.4e} m after {:.4e} m) and was undone",
                                    pass, after, before);
      break;
    }
    if (before - after <= options.tolerance * before) {
      entry["reason"] =
          fmt::format("the RMS changed by less than {:g} of itself in pass {}", options.tolerance, pass);
      break;
    }
  }
  entry["iterations"] = passes;
  entry["newton_iterations"] = newton;
  const auto response = model::evaluate_response(system.model(), system.state());
  entry["groups"] = groups_json(model::summarise_groups(system.model(), system.state(), response));
  entry["surface"] = surface_json(context, error);
  context.write_fields(context.step_name, field_grid(context, response));
  draw_state(context, response);
  draw_passes(context, passes);
  return entry;
}

}  // namespace tautline::steps
