#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include <tautline/la/session.hpp>
#include <tautline/model/names.hpp>
#include <tautline/model/response.hpp>
#include <tautline/output/tables.hpp>

#include "steps/inverse_problem.hpp"
#include "steps/rod_structure.hpp"
#include "steps/summaries.hpp"
#include "steps/state_pictures.hpp"
#include "steps/fields.hpp"
#include "steps/prepare.hpp"

namespace tautline::steps {

namespace {

using Quantity = InverseUnknownOptions::Quantity;

/// Misses of one entry of the deck's targets and one of its quantities.
Json targets_json(const CableProblem& problem, const InverseOptions& options,
                  const analysis::GaussNewtonSummary& found) {
  struct Group {
    int count = 0, still = 0, worst = -1;
    double largest = 0, squares = 0;
  };
  std::map<std::pair<int, std::string>, Group> groups;
  const double most = found.influence.size() > 0 ? found.influence.maxCoeff() : 0;
  for (std::size_t i = 0; i < problem.targets().size(); ++i) {
    const auto& target = problem.targets()[i];
    auto& group = groups[{target.entry, target.quantity}];
    const double miss = problem.miss(target).value;
    ++group.count;
    group.squares += miss * miss;
    if (group.worst < 0 || std::abs(miss) > group.largest * (1 + 1e-6)) {
      group.largest = std::abs(miss);
      group.worst = target.node;
    }
    if (found.influence[static_cast<Eigen::Index>(i)] <= options.rank_tolerance * most) ++group.still;
  }
  Json list = Json::array();
  for (const auto& [key, group] : groups) {
    const bool met = group.largest <= options.tolerance;
    list.push_back({{"on", options.targets[key.first].on},
                    {"quantity", key.second},
                    {"nodes", group.count},
                    {"met", met},
                    {"miss_max", group.largest},
                    {"miss_rms", std::sqrt(group.squares / group.count)}});
    if (!met) list.back()["worst_node"] = group.worst + 1;
    if (group.still > 0) list.back()["not_influenced"] = group.still;
  }
  return list;
}

/// Values found, one entry for each unknown.
Json unknowns_json(const CableProblem& problem, const VecX& factors, const model::Response& response) {
  Json list = Json::array();
  for (std::size_t j = 0; j < problem.unknowns().size(); ++j) {
    const auto& unknown = problem.unknowns()[j];
    const double factor = factors[static_cast<Eigen::Index>(j)];
    double least = 0, largest = 0;
    int slack = 0;
    for (const int i : unknown.cables) {
      const double tension = response.cables[i].tension;
      least = i == unknown.cables.front() ? tension : std::min(least, tension);
      largest = i == unknown.cables.front() ? tension : std::max(largest, tension);
      slack += response.cables[i].slack;
    }
    list.push_back({{"name", unknown.name},
                    {"quantity", unknown.quantity == Quantity::unstressed_length ? "unstressed_length"
                                                                                 : "axial_stiffness"},
                    {"cables", unknown.cables.size()},
                    {"start", unknown.start},
                    {"found", unknown.start * factor},
                    {"factor", factor},
                    {"tension_min", least},
                    {"tension_max", largest}});
    if (slack > 0) list.back()["slack"] = slack;
    if (factor == unknown.lower) list.back()["at_bound"] = "min";
    if (factor == unknown.upper) list.back()["at_bound"] = "max";
  }
  return list;
}

Json iterations_json(const analysis::GaussNewtonSummary& found) {
  Json list = Json::array();
  for (const auto& point : found.iterations)
    list.push_back({{"miss_max", point.largest},
                    {"miss_rms", point.rms},
                    {"change", point.change},
                    {"step", point.step}});
  return list;
}

/// What a designer must not overlook.
std::vector<std::string> warnings_of(const model::Model& model, const Json& entry) {
  std::vector<std::string> warnings;
  for (const auto& target : entry["targets"]) {
    const auto on = target["on"].get<std::vector<std::string>>();
    const std::string name =
        fmt::format("\"{}\" of {}", target["quantity"].get<std::string>(), fmt::join(on, ", "));
    if (target["met"].get<bool>()) continue;
    warnings.push_back(
        fmt::format("target {} is missed by up to {:.4g} m, at {}{}", name, target["miss_max"].get<double>(),
                    model::node_in_group(model, target["worst_node"].get<int>() - 1),
                    target.contains("not_influenced")
                        ? fmt::format("; no unknown moves {} of its {} nodes",
                                      target["not_influenced"].get<int>(), target["nodes"].get<int>())
                        : ""));
  }
  for (const auto& unknown : entry["unknowns"]) {
    const std::string name = unknown["name"];
    if (unknown.contains("at_bound"))
      warnings.push_back(fmt::format("{} of \"{}\" is at its {}", unknown["quantity"].get<std::string>(),
                                     name, unknown["at_bound"].get<std::string>()));
    if (unknown.contains("slack"))
      warnings.push_back(fmt::format("{} of the {} cables of \"{}\" are slack and hold nothing",
                                     unknown["slack"].get<int>(), unknown["cables"].get<int>(), name));
  }
  if (entry["negative_pivots"].get<int>() > 0)
    warnings.push_back(fmt::format("the equilibrium found is unstable in {} directions",
                                   entry["negative_pivots"].get<int>()));
  return warnings;
}

/// DIR/<step>_cables.csv and DIR/<step>_targets.csv. Rank 0.
void write_tables(Context& context, const CableProblem& problem, const model::Model& model,
                  const model::Response& response) {
  if (!context.deck.output.tables) return;
  std::array<std::vector<double>, 7> cables;
  const auto& unknowns = problem.unknowns();
  for (std::size_t j = 0; j < unknowns.size(); ++j)
    for (const int i : unknowns[j].cables) {
      const auto& cable = model.cables[i];
      const double row[] = {static_cast<double>(j + 1), i + 1.0,
                            problem.start_length(i),    model.unstressed_length(cable),
                            problem.start_stiffness(i), model.axial_stiffness(cable),
                            response.cables[i].tension};
      for (std::size_t c = 0; c < cables.size(); ++c) cables[c].push_back(row[c]);
    }
  std::array<std::vector<double>, 6> targets;
  for (const auto& target : problem.targets()) {
    const Vec3 at = problem.position(target.node);
    const double row[] = {target.entry + 1.0,        target.node + 1.0, at.x(), at.y(), at.z(),
                          problem.miss(target).value};
    for (std::size_t c = 0; c < targets.size(); ++c) targets[c].push_back(row[c]);
  }
  la::on_root([&] {
    output::write_columns(context.step_path("_cables.csv"),
                          {"unknown", "cable", "start_length", "unstressed_length", "start_stiffness",
                           "axial_stiffness", "tension"},
                          {cables.begin(), cables.end()});
    output::write_columns(context.step_path("_targets.csv"), {"target", "node", "x", "y", "z", "miss"},
                          {targets.begin(), targets.end()});
  });
}

void draw_misses(Context& context, const analysis::GaussNewtonSummary& found) {
  if (!context.draws()) return;
  output::Curve largest{"largest", {}, {}, true}, rms{"rms", {}, {}, true};
  for (std::size_t i = 0; i < found.iterations.size(); ++i)
    for (auto* curve : {&largest, &rms}) {
      const auto& point = found.iterations[i];
      curve->x.push_back(static_cast<double>(i));
      curve->y.push_back(std::max(1e-15, curve == &largest ? point.largest : point.rms));
    }
  output::Chart chart;
  chart.title = "Misses of the targets";
  chart.x_label = "iteration";
  chart.y_label = "miss, weighted [m]";
  chart.log_y = true;
  chart.curves = {largest, rms};
  context.draw("misses", "Misses of the targets by iteration of the inverse problem", chart);
}

void note_warnings(Context& context, Json& entry) {
  const auto warnings = warnings_of(context.system().model(), entry);
  entry["warnings"] = warnings;
  if (warnings.empty()) return;
  std::string text = warnings.front();
  if (warnings.size() > 1)
    text += fmt::format("; {} more in its \"warnings\" of results.json", warnings.size() - 1);
  context.warn("inverse", text);
}

Json status_json(const analysis::GaussNewtonSummary& found) {
  if (found.converged())
    return {{"status", "done"},
            {"reason", found.reason},
            {"targets_met", found.status == analysis::GaussNewtonStatus::met}};
  return {
      {"status", "not_converged"},
      {"reason", found.reason + ". Try targets nearer to the present shape and go there in several steps, "
                                "or cables with more influence"},
      {"targets_met", false}};
}

}  // namespace

void prepare(Context& context, const InverseOptions& options) {
  const CableProblem problem(context, options);
  context.system().begin_stage(context.boundary({}, true));
}

Json run_step(Context& context, const InverseOptions& options) {
  auto& system = context.system();
  CableProblem problem(context, options);
  if (!problem.begin()) {
    problem.restore();
    return {{"status", "not_converged"},
            {"reason", "the cables as they are have no equilibrium to start from"}};
  }
  const auto n = static_cast<Eigen::Index>(problem.unknowns().size());
  analysis::GaussNewtonOptions limits;
  limits.tolerance = options.tolerance;
  limits.rank_tolerance = options.rank_tolerance;
  limits.max_iterations = options.max_iterations;
  const auto found =
      analysis::solve_inverse(problem, VecX::Ones(n), problem.box(), limits, [&](const auto& point) {
        context.progress.say(fmt::format("{} | largest miss {:.3e} m, change {:.2e}, step {:g}",
                                         context.step_name, point.largest, point.change, point.step));
      });
  const auto response = model::evaluate_response(system.model(), system.state());
  Json entry = status_json(found);
  entry["n_targets"] = problem.targets().size();
  entry["n_unknowns"] = n;
  entry["rank"] = found.rank;
  entry["condition"] = found.condition;
  entry["iterations"] = found.iterations.size() - 1;
  entry["way"] = iterations_json(found);
  entry["newton_iterations"] = problem.newton_iterations();
  entry["negative_pivots"] = problem.last_path().inertia.negative;
  entry["unknowns"] = unknowns_json(problem, found.parameters, response);
  entry["targets"] = targets_json(problem, options, found);
  entry["groups"] = groups_json(model::summarise_groups(system.model(), system.state(), response));
  if (context.umbrella) entry["rods"] = rods_json(context, response);
  note_warnings(context, entry);
  write_tables(context, problem, system.model(), response);
  context.write_fields(context.step_name, field_grid(context, response));
  draw_state(context, response);
  draw_misses(context, found);
  return entry;
}

}  // namespace tautline::steps
