#include "steps/summaries.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <tautline/core/error.hpp>

namespace tautline::steps {

double above_rounding(double value, double floor) { return std::max(value, floor); }

double rounded(double value) { return std::stod(fmt::format("{:.3g}", value)); }

Json groups_json(const std::map<std::string, model::GroupSummary>& groups) {
  Json result = Json::object();
  for (const auto& [name, g] : groups) {
    Json entry{{"count", g.count}};
    if (g.kind == model::ElementKind::cable) {
      entry["tension_min"] = g.tension_min;
      entry["tension_max"] = g.tension_max;
      entry["tension_mean"] = g.tension_mean;
      if (g.has_target) entry["tension_rms_from_target"] = g.tension_rms_from_target;
      entry["slack"] = g.slack;
    } else if (g.kind == model::ElementKind::beam) {
      entry["axial_min"] = g.axial_min;
      entry["axial_max"] = g.axial_max;
      entry["moment_max"] = g.moment_max;
    } else {
      entry["principal_min"] = g.principal_min;
      entry["principal_max"] = g.principal_max;
    }
    result[name] = entry;
  }
  return result;
}

Json surface_json(const reflector::SurfaceError& e) {
  Json entry{{"rms", e.rms},
             {"mean_shift", e.mean_shift},
             {"rms_direct", e.rms_direct},
             {"rms_best_fit", e.rms_best_fit},
             {"best_fit_focal_length", e.best_fit_focal_length},
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
  return {{"nodes", model.nodes.size()}, {"dofs", dofs}, {"cables", model.cables.size()}, {"beams", model.beams.size()},
          {"membranes", model.membranes.size()}, {"shells", 0}, {"mass", model::total_mass(model)}};
}

reflector::SurfaceSample surface_sample(Context& context) {
  const auto& model = context.system().model();
  reflector::SurfaceSample sample;
  sample.positions = model::positions(model, context.system().state());
  const auto cloth = model.select("cloth");
  sample.surface_nodes = cloth.nodes;
  for (const int i : cloth.membranes) sample.triangles.push_back(model.membranes[i].nodes);
  sample.net_nodes = model.select("front_net_nodes").nodes;
  const double radius = context.deck.reflector->evaluation_radius;
  sample.radius = std::isnan(radius) ? 0 : radius;
  sample.frequency = context.deck.reflector->frequency;
  return sample;
}

reflector::SurfaceError measure(Context& context) {
  return reflector::measure_surface(*context.surface, surface_sample(context));
}

namespace {

using output::Field;

Field displacement_field(const model::State& state) {
  Field field{"displacement [m]", 3, {}};
  for (const auto& u : state.displacement) field.values.insert(field.values.end(), u.begin(), u.end());
  return field;
}

/// NaN away from the cloth, so that ParaView leaves it blank.
Field deviation_field(Context& context) {
  const auto sample = surface_sample(context);
  Field field{"surface deviation [m]", 1, std::vector<double>(sample.positions.size(), std::nan(""))};
  for (const int node : sample.surface_nodes)
    field.values[node] = reflector::deviation(*context.surface, sample.positions[node]);
  return field;
}

/// Cell arrays run over cables, beams, membranes; entries that do not apply are zero.
class CellArrays {
 public:
  CellArrays(const model::Model& model, const model::Response& response) : model_(model), response_(response) {}

  Field scalar(const std::string& name, double (*cable)(const model::CableResult&),
               double (*beam)(const element::BeamForces&), double (*membrane)(const model::MembraneResult&)) const {
    Field field{name, 1, {}};
    for (const auto& r : response_.cables) field.values.push_back(cable ? cable(r) : 0);
    for (const auto& r : response_.beams) field.values.push_back(beam ? beam(r) : 0);
    for (const auto& r : response_.membranes) field.values.push_back(membrane ? membrane(r) : 0);
    return field;
  }

  /// A beam's axis `k`, or its moments at end `k`.
  template <class Pick>
  Field beam_vector(const std::string& name, const Pick& pick) const {
    Field field{name, 3, std::vector<double>(3 * response_.cables.size(), 0.0)};
    for (std::size_t i = 0; i < response_.beams.size(); ++i) {
      const Vec3 v = pick(i);
      field.values.insert(field.values.end(), v.begin(), v.end());
    }
    field.values.resize(field.values.size() + 3 * response_.membranes.size(), 0.0);
    return field;
  }

  Field group() const {
    Field field{"group", 1, {}};
    for (const auto& e : model_.cables) field.values.push_back(e.group);
    for (const auto& e : model_.beams) field.values.push_back(e.group);
    for (const auto& e : model_.membranes) field.values.push_back(e.group);
    return field;
  }

 private:
  const model::Model& model_;
  const model::Response& response_;
};

}  // namespace

output::FieldGrid field_grid(Context& context, const model::Response& response) {
  const auto& model = context.system().model();
  const auto& state = context.system().state();
  output::FieldGrid grid;
  grid.points = model.nodes;
  for (const auto& cable : model.cables) grid.lines.push_back(cable.nodes);
  for (const auto& beam : model.beams) grid.lines.push_back(beam.nodes);
  for (const auto& membrane : model.membranes) grid.triangles.push_back(membrane.nodes);
  grid.point_fields.push_back(displacement_field(state));
  if (context.surface) grid.point_fields.push_back(deviation_field(context));
  const CellArrays arrays(model, response);
  using model::CableResult, model::MembraneResult, element::BeamForces;
  auto& out = grid.cell_fields;
  out.push_back(arrays.group());
  out.push_back(arrays.scalar("tension [N]", [](const CableResult& r) { return r.tension; }, nullptr, nullptr));
  out.push_back(arrays.scalar("slack", [](const CableResult& r) { return r.slack ? 1.0 : 0.0; }, nullptr, nullptr));
  out.push_back(arrays.scalar("axial force [N]", nullptr, [](const BeamForces& f) { return f.axial; }, nullptr));
  out.push_back(arrays.scalar("shear 2 [N]", nullptr, [](const BeamForces& f) { return f.shear[0]; }, nullptr));
  out.push_back(arrays.scalar("shear 3 [N]", nullptr, [](const BeamForces& f) { return f.shear[1]; }, nullptr));
  out.push_back(arrays.beam_vector("end moments 1 [N m]", [&](std::size_t i) { return Vec3(response.beams[i].end_moment.col(0)); }));
  out.push_back(arrays.beam_vector("end moments 2 [N m]", [&](std::size_t i) { return Vec3(response.beams[i].end_moment.col(1)); }));
  for (int axis = 0; axis < 3; ++axis)
    out.push_back(arrays.beam_vector(fmt::format("beam axis {}", axis + 1),
                                     [&](std::size_t i) { return Vec3(response.beam_frames[i].col(axis)); }));
  out.push_back(arrays.scalar("principal resultant 1 [N/m]", nullptr, nullptr,
                              [](const MembraneResult& r) { return r.principal_cauchy[0]; }));
  out.push_back(arrays.scalar("principal resultant 2 [N/m]", nullptr, nullptr,
                              [](const MembraneResult& r) { return r.principal_cauchy[1]; }));
  return grid;
}

namespace {

void draw_deviation(Context& context) {
  const auto sample = surface_sample(context);
  const auto error = reflector::measure_surface(*context.surface, sample);
  output::ViewLayer cloth, frame;
  cloth.points = frame.points = sample.positions;
  cloth.point_scalars.assign(sample.positions.size(), 0.0);
  for (const int node : sample.surface_nodes)
    cloth.point_scalars[node] = 1e3 * (reflector::deviation(*context.surface, sample.positions[node]) - error.mean_shift);
  double range = 0;
  const double radius = error.radius > 0 ? error.radius : 1e300;
  for (const auto& triangle : sample.triangles) {
    Vec3 centre = Vec3::Zero();
    for (const int node : triangle) centre += sample.positions[node] / 3;
    if (centre.head<2>().norm() > radius) continue;
    cloth.triangles.push_back(triangle);
    for (const int node : triangle) range = std::max(range, std::abs(cloth.point_scalars[node]));
  }
  for (const auto& beam : context.system().model().beams) frame.lines.push_back(beam.nodes);
  frame.line_width = 2.5;
  output::View view;
  view.title = "Deviation of the cloth from the paraboloid";
  view.subtitle = fmt::format("RMS {:.3f} mm over {} nodes, mean shift {:.3f} mm", 1e3 * error.rms, error.samples, 1e3 * error.mean_shift);
  view.scalar_title = "deviation [mm]";
  view.diverging = true;
  view.range = {{-range, range}};
  view.direction = Vec3(0, -0.02, 1);
  view.up = Vec3(0, 1, 0);
  view.layers = {std::move(cloth), std::move(frame)};
  context.draw("deviation", fmt::format("Deviation of the cloth from the paraboloid about its mean, RMS {:.3f} mm", 1e3 * error.rms), view);
}

void draw_tensions(Context& context, const model::Response& response) {
  const auto& model = context.system().model();
  output::ViewLayer cables, frame;
  cables.points = frame.points = model::positions(model, context.system().state());
  for (std::size_t i = 0; i < model.cables.size(); ++i) {
    cables.lines.push_back(model.cables[i].nodes);
    cables.cell_scalars.push_back(response.cables[i].tension);
  }
  for (const auto& beam : model.beams) frame.lines.push_back(beam.nodes);
  frame.line_width = 3;
  cables.line_width = 1.6;
  output::View view;
  view.title = "Cable tensions";
  view.scalar_title = "tension [N]";
  view.layers = {std::move(cables), std::move(frame)};
  context.draw("tensions", "Tensions of all cables; the frame in grey", view);
}

}  // namespace

void draw_state(Context& context, const model::Response& response) {
  if (!context.draws()) return;
  if (context.surface) draw_deviation(context);
  if (!context.system().model().cables.empty()) draw_tensions(context, response);
}

}  // namespace tautline::steps
