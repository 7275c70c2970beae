#include <numbers>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/rod/cantilever_model.hpp>
#include <tautline/rod/exact_rod.hpp>
#include <tautline/rod/report.hpp>

#include "steps/context.hpp"
#include "steps/rod_pictures.hpp"
#include "steps/rod_structure.hpp"

namespace tautline::steps {

namespace {

using Method = RodShapingOptions::Method;

template <class Options>
Options with_limits(Options options, const RodShapingOptions& step) {
  options.tolerance = step.tolerance.value_or(options.tolerance);
  options.max_iterations = step.max_iterations.value_or(options.max_iterations);
  return options;
}

/// A value for each link from one for all, or as many.
VecX for_links(const rod::Umbrella& umbrella, const std::vector<double>& given) {
  VecX values(umbrella.rod.links());
  for (int k = 0; k < values.size(); ++k) values[k] = given.size() == 1 ? given[0] : given.at(k);
  return values;
}

/// Angles of the nodes on an arc that begins at the root and turns by the start angle.
VecX start_angles(const rod::Rod& rod, double start_angle_deg) {
  VecX angles(rod.links());
  double s = 0;
  for (int k = 0; k < angles.size(); ++k) {
    s += rod.lengths[k] / rod.lengths.sum();
    angles[k] = rod.root.angle + s * start_angle_deg * std::numbers::pi / 180;
  }
  return angles;
}

rod::RodSolution solve(const rod::Umbrella& umbrella, const RodShapingOptions& options) {
  const auto exact = with_limits(options.exact, options);
  const auto cantilevers = with_limits(options.cantilevers, options);
  const bool is_exact = options.method == Method::exact;
  if (options.reaction) {
    const VecX forces = for_links(umbrella, *options.reaction);
    const VecX start = start_angles(umbrella.rod, options.start_angle);
    return is_exact ? load_exact(umbrella.rod, forces, start, exact)
                    : load_cantilevers(umbrella.rod, forces, start, cantilevers);
  }
  if (!options.stiffness)
    return is_exact ? design_exact(umbrella, exact) : design_cantilevers(umbrella, cantilevers);
  const VecX stiffness = for_links(umbrella, *options.stiffness);
  return is_exact ? turn_exact(umbrella, umbrella.rod.lengths, stiffness, exact)
                  : turn_cantilevers(umbrella, stiffness, cantilevers);
}

Json list(const VecX& values) {
  return Json(std::vector<double>(values.begin(), values.end()));
}

/// What the step was told, in the words of the deck.
void add_method(Json& entry, const RodShapingOptions& options) {
  const bool cables = !options.stiffness && !options.reaction;
  entry["sought"] = cables ? "cables" : "shape";
  if (options.method == Method::exact) {
    entry["rod_model"] = "exact";
    if (cables) entry["form"] = options.exact.form == rod::ExactForm::nodes_on_surface ? "a" : "b";
    return;
  }
  entry["rod_model"] = "cantilevers";
  entry["shortening"] =
      options.cantilevers.shortening == rod::Shortening::consistent ? "consistent" : "as_published";
  if (cables)
    entry["solver"] = options.cantilevers.method == rod::CantileverMethod::newton ? "newton" : "successive";
}

void add_solve(Json& entry, const rod::SolveSummary& summary) {
  entry["iterations"] = summary.steps > 1 ? summary.total_iterations : summary.iterations();
  entry["increments"] = summary.increments;
  if (summary.steps > 1) entry["turning_steps"] = summary.steps;
  if (summary.contraction_rate > 0) entry["contraction_rate"] = summary.contraction_rate;
}

void add_shape(Json& entry, const rod::Umbrella& umbrella, const rod::RodShape& shape,
               const rod::RodReport& report) {
  const auto& root = shape.rod.root;
  entry["rod_error_rms"] = report.along.rms;
  entry["rod_error_max"] = report.along.max;
  entry["rod_error_max_at"] = report.along.max_at;
  entry["root"] = {{"X", root.x}, {"Y", root.y}, {"theta", root.angle}};
  entry["target"] = {
      {"X", list(umbrella.target_x)}, {"Y", list(umbrella.target_y)}, {"theta", list(umbrella.target_angle)}};
  entry["lengths"] = list(shape.rod.lengths);
  entry["X"] = list(shape.x);
  entry["Y"] = list(shape.y);
  entry["theta"] = list(shape.angle);
  entry["reaction"] = list(shape.reaction);
  entry["strain"] = list(report.strain);
  entry["stiffness"] = list(report.stiffness);
  entry["moments"] = {{"I", list(shape.moment)}, {"II", list(shape.moment_of_links)}};
  entry["node_error"] = list(report.node_error);
  entry["miss_X"] = list(report.miss_x);
  entry["miss_Y"] = list(report.miss_y);
}

void add_warnings(Context& context, Json& entry, std::vector<std::string> warnings,
                  const rod::Stability& stability) {
  if (stability.unstable > 0)
    warnings.insert(warnings.begin(),
                    fmt::format("the equilibrium is unstable in {} direction{}, least eigenvalue "
                                "{:.3g}",
                                stability.unstable, stability.unstable > 1 ? "s" : "", stability.least));
  entry["warnings"] = warnings;
  if (warnings.empty()) return;
  std::string text = warnings.front();
  if (warnings.size() > 1)
    text += fmt::format("; {} more in its \"warnings\" of results.json", warnings.size() - 1);
  context.warn("rod_shaping", text);
}

/// Leaves the umbrella as a structure for the steps that follow; or word of why it cannot be built.
void leave_structure(Context& context, const VecX& lengths, const VecX& stiffness) {
  model::Model structure;
  try {
    structure = make_rod_structure(*context.umbrella, *context.deck.rod_umbrella(), lengths, stiffness);
  } catch (const ModelError& error) {
    context.set_structure({}, error.what());
    return;
  }
  add_loads(structure, context.deck);
  context.set_structure(std::move(structure));
}

}  // namespace

Json run_step(Context& context, const RodShapingOptions& options) {
  if (!context.umbrella) throw ModelError("rod_shaping needs a rod-umbrella: this deck has none");
  const rod::RodSolution found = solve(*context.umbrella, options);
  Json entry{{"status", found.summary.converged() ? "done" : "not_converged"},
             {"reason", found.summary.reason}};
  if (!found.summary.converged()) {
    context.set_structure({}, fmt::format("step \"{}\" found no shape of the rods", context.step_name));
    add_method(entry, options);
    add_solve(entry, found.summary);
    return entry;
  }
  const rod::RodReport report = rod::make_report(*context.umbrella, found.shape);
  add_shape(entry, *context.umbrella, found.shape, report);
  add_method(entry, options);
  add_solve(entry, found.summary);
  entry["rod_error_rms_axial"] = report.along.rms_axial;
  entry["unstable_directions"] = found.stability.unstable;
  entry["least_stability"] = found.stability.least;
  add_warnings(context, entry, options.reaction ? std::vector<std::string>() : report.warnings,
               found.stability);
  if (options.reaction)
    context.set_structure({},
                          fmt::format("step \"{}\" has forces, no cables, of which no structure can be built",
                                      context.step_name));
  else
    leave_structure(context, found.shape.rod.lengths,
                    options.stiffness ? for_links(*context.umbrella, *options.stiffness) : report.stiffness);
  write_rod_tables(context, found.shape, report);
  draw_rod(context, found.shape, report);
  return entry;
}

}  // namespace tautline::steps
