#include "steps/summaries.hpp"

#include <cmath>

#include <tautline/core/error.hpp>

namespace tautline::steps {

Json groups_json(const std::map<std::string, model::GroupSummary>& groups) {
  Json result = Json::object();
  for (const auto& [name, g] : groups) {
    Json entry{{"count", g.count}};
    using model::ElementKind;
    if (model::is_cable_like(g.kind)) {
      entry["tension_min"] = g.tension_min;
      entry["tension_max"] = g.tension_max;
      entry["tension_mean"] = g.tension_mean;
      if (g.has_target) entry["tension_rms_from_target"] = g.tension_rms_from_target;
      entry["slack"] = g.slack;
      if (g.kind == ElementKind::bar) {
        entry["axial_min"] = g.axial_min;
        entry["axial_max"] = g.axial_max;
      }
    } else if (g.kind == ElementKind::beam) {
      entry["axial_min"] = g.axial_min;
      entry["axial_max"] = g.axial_max;
      entry["moment_max"] = g.moment_max;
    } else if (g.kind == ElementKind::membrane || g.kind == ElementKind::shell) {
      entry["principal_min"] = g.principal_min;
      entry["principal_max"] = g.principal_max;
      if (g.kind == ElementKind::shell) entry["moment_max"] = g.moment_max;
      if (g.kind == ElementKind::membrane && (g.wrinkled > 0 || g.slack > 0)) {
        entry["wrinkled"] = g.wrinkled;
        entry["slack"] = g.slack;
      }
    } else if (g.kind == ElementKind::spring) {
      entry["force_max"] = g.force_max;
      entry["moment_max"] = g.moment_max;
    }
    if (entry.size() > 1) entry["rounding"] = g.rounding.force;
    if (entry.contains("moment_max")) entry["rounding_moment"] = g.rounding.moment;
    result[name] = entry;
  }
  return result;
}

Json surface_json(Context& context, const reflector::SurfaceError& e) {
  if (!e.best_fit_converged)
    context.warn(
        "best_fit_not_converged",
        "the search for the best-fit paraboloid ended before it converged: its RMS is an upper bound "
        "and its focal length is not to be used");
  Json entry{{"rms", e.rms},
             {"mean_shift", e.mean_shift},
             {"rms_direct", e.rms_direct},
             {"rms_best_fit", e.rms_best_fit},
             {"best_fit_focal_length", e.best_fit_focal_length},
             {"best_fit_converged", e.best_fit_converged},
             {"rms_area_weighted", e.rms_area_weighted},
             {"rms_nodes", e.rms_nodes},
             {"rms_half_path", e.rms_half_path},
             {"radius", e.radius},
             {"samples", e.samples}};
  if (e.frequency > 0) {
    entry["frequency"] = e.frequency;
    entry["gain_loss_db"] = e.gain_loss_db;
    entry["gain_loss_half_path_db"] = e.gain_loss_half_path_db;
  }
  return entry;
}

Json model_json(const model::Model& model, int dofs) {
  Json entry{{"nodes", model.nodes.size()},         {"dofs", dofs},
             {"cables", model.cables.size()},       {"beams", model.beams.size()},
             {"membranes", model.membranes.size()}, {"shells", model.shells.size()}};
  if (!model.springs.empty()) entry["springs"] = model.springs.size();
  if (!model.masses.empty()) entry["masses"] = model.masses.size();
  if (!model.links.empty()) entry["links"] = model.links.size();
  entry["mass"] = model::total_mass(model);
  return entry;
}

Json umbrella_json(const rod::Umbrella& umbrella) {
  const int rods = umbrella.cables.rods, links = umbrella.rod.links();
  return {{"nodes", rods * (links + 1)},
          {"dofs", 0},
          {"cables", rods * links},
          {"beams", rods * links},
          {"membranes", 0},
          {"shells", 0},
          {"mass", nullptr},
          {"rods", rods},
          {"links", links}};
}

reflector::SurfaceSample surface_sample(Context& context) {
  const auto& model = context.system().model();
  reflector::SurfaceSample sample;
  sample.positions = model::positions(model, context.system().state());
  if (model.find_group("cloth") >= 0) {
    const auto cloth = model.select("cloth");
    sample.surface_nodes = cloth.nodes;
    for (const int i : cloth.membranes)
      for (const auto& triangle : model.membranes[i].nodes.triangles()) sample.triangles.push_back(triangle);
  } else {
    const auto net = model.select("front_surface");
    sample.surface_nodes = model.nodes_of({"front_surface"});
    for (const int i : net.cables) sample.lines.push_back(model.cables[i].nodes);
    for (const int i : net.beams) sample.lines.push_back(model.beams[i].nodes);
  }
  sample.net_nodes = model.select("front_net_nodes").nodes;
  const double radius = context.deck.dish()->evaluation_radius;
  sample.radius = std::isnan(radius) ? 0 : radius;
  sample.frequency = context.deck.dish()->frequency;
  return sample;
}

reflector::SurfaceError measure(Context& context) {
  return reflector::measure_surface(*context.surface, surface_sample(context));
}

}  // namespace tautline::steps
