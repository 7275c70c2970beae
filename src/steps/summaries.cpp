#include "steps/summaries.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include <fmt/format.h>

#include <tautline/core/error.hpp>

namespace tautline::steps {

double above_rounding(double value, double floor) {
  return std::max(value, floor);
}

double on_grid(double value, double size) {
  if (!(size > 0)) return 0;
  const double grid = std::pow(10.0, std::floor(std::log10(size)) - 10);
  const double steps = std::round(value / grid);
  return steps == 0 ? 0.0 : steps * grid;
}

double rounded(double value) {
  return to_digits(value, 3);
}

double to_digits(double value, int digits) {
  return std::stod(fmt::format("{:.{}g}", value, digits));
}

double without_rounding(double value, double rounding) {
  constexpr double digits = 1e-6;
  if (rounding <= digits * std::abs(value)) return value;
  const double grid = std::pow(10.0, std::ceil(std::log10(rounding)));
  return grid * std::round(value / grid);
}

Json groups_json(const std::map<std::string, model::GroupSummary>& groups, double rounding) {
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
      entry["axial_min"] = without_rounding(g.axial_min, rounding);
      entry["axial_max"] = without_rounding(g.axial_max, rounding);
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

/// Cell arrays run over cables, beams, membranes, shells; entries that do not apply are zero.
class CellArrays {
 public:
  CellArrays(const model::Model& model, const model::Response& response)
      : model_(model), response_(response) {}

  Field scalar(const std::string& name, double (*cable)(const model::CableResult&),
               double (*beam)(const element::BeamForces&), double (*membrane)(const model::MembraneResult&),
               double (*shell)(const element::ShellForces&) = nullptr) const {
    Field field{name, 1, {}};
    for (const auto& r : response_.cables) field.values.push_back(cable ? cable(r) : 0);
    for (const auto& r : response_.beams) field.values.push_back(beam ? beam(r) : 0);
    for (const auto& r : response_.membranes) field.values.push_back(membrane ? membrane(r) : 0);
    for (const auto& r : response_.shells) field.values.push_back(shell ? shell(r) : 0);
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
    field.values.resize(field.values.size() + 3 * (response_.membranes.size() + response_.shells.size()),
                        0.0);
    return field;
  }

  Field group() const {
    Field field{"group", 1, {}};
    for (const auto& e : model_.cables) field.values.push_back(e.group);
    for (const auto& e : model_.beams) field.values.push_back(e.group);
    for (const auto& e : model_.membranes) field.values.push_back(e.group);
    for (const auto& e : model_.shells) field.values.push_back(e.group);
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
  for (const auto& membrane : model.membranes) grid.facets.push_back(membrane.nodes);
  for (const auto& shell : model.shells) grid.facets.push_back(shell.nodes);
  grid.point_fields.push_back(displacement_field(state));
  if (context.surface) grid.point_fields.push_back(deviation_field(context));
  const CellArrays arrays(model, response);
  using model::CableResult, model::MembraneResult, element::BeamForces, element::ShellForces;
  auto& out = grid.cell_fields;
  out.push_back(arrays.group());
  out.push_back(arrays.scalar(
      "tension [N]", [](const CableResult& r) { return r.tension; }, nullptr, nullptr));
  out.push_back(arrays.scalar(
      "slack", [](const CableResult& r) { return r.slack ? 1.0 : 0.0; }, nullptr, nullptr));
  out.push_back(arrays.scalar(
      "axial force [N]", nullptr, [](const BeamForces& f) { return f.axial; }, nullptr));
  out.push_back(arrays.scalar(
      "shear 2 [N]", nullptr, [](const BeamForces& f) { return f.shear[0]; }, nullptr));
  out.push_back(arrays.scalar(
      "shear 3 [N]", nullptr, [](const BeamForces& f) { return f.shear[1]; }, nullptr));
  out.push_back(arrays.beam_vector("end moments 1 [N m]",
                                   [&](std::size_t i) { return Vec3(response.beams[i].end_moment.col(0)); }));
  out.push_back(arrays.beam_vector("end moments 2 [N m]",
                                   [&](std::size_t i) { return Vec3(response.beams[i].end_moment.col(1)); }));
  for (int axis = 0; axis < 3; ++axis)
    out.push_back(arrays.beam_vector(fmt::format("beam axis {}", axis + 1),
                                     [&](std::size_t i) { return Vec3(response.beam_frames[i].col(axis)); }));
  out.push_back(arrays.scalar(
      "principal resultant 1 [N/m]", nullptr, nullptr,
      [](const MembraneResult& r) { return r.principal_cauchy[0]; },
      [](const ShellForces& f) { return model::principal_values(f.membrane)[0]; }));
  out.push_back(arrays.scalar(
      "principal resultant 2 [N/m]", nullptr, nullptr,
      [](const MembraneResult& r) { return r.principal_cauchy[1]; },
      [](const ShellForces& f) { return model::principal_values(f.membrane)[1]; }));
  if (std::any_of(model.groups.begin(), model.groups.end(),
                  [](const model::Group& g) { return g.membrane.wrinkling; }))
    out.push_back(arrays.scalar("wrinkled (1) or slack (2)", nullptr, nullptr,
                                [](const MembraneResult& r) { return static_cast<double>(r.state); }));
  if (!model.shells.empty()) {
    out.push_back(arrays.scalar("principal moment 1 [N]", nullptr, nullptr, nullptr,
                                [](const ShellForces& f) { return model::principal_values(f.moment)[0]; }));
    out.push_back(arrays.scalar("principal moment 2 [N]", nullptr, nullptr, nullptr,
                                [](const ShellForces& f) { return model::principal_values(f.moment)[1]; }));
    out.push_back(arrays.scalar("transverse shear [N/m]", nullptr, nullptr, nullptr,
                                [](const ShellForces& f) { return f.shear.norm(); }));
  }
  return grid;
}

namespace {

/// What holds the front net: a rim, or else all beams.
std::vector<std::array<int, 2>> frame_lines(const model::Model& model) {
  const int rim = model.find_group("front_rim");
  std::vector<std::array<int, 2>> lines;
  for (const auto& beam : model.beams)
    if (rim < 0 || beam.group == rim) lines.push_back(beam.nodes);
  return lines;
}

/// A circle of `radius` about the z axis on the surface, as a closed line.
output::ViewLayer circle_on(const reflector::Paraboloid& surface, double radius) {
  constexpr int parts = 180;
  output::ViewLayer layer;
  for (int i = 0; i < parts; ++i) {
    const double angle = 2 * std::numbers::pi * i / parts;
    const double x = radius * std::cos(angle), y = radius * std::sin(angle);
    layer.points.emplace_back(x, y, surface.height(x, y));
    layer.lines.push_back({i, (i + 1) % parts});
  }
  layer.line_width = 2;
  return layer;
}

/// The measured disc of the cloth coloured by deviation about the mean; the rest of it in grey.
void draw_deviation(Context& context) {
  const auto sample = surface_sample(context);
  const auto error = reflector::measure_surface(*context.surface, sample);
  output::ViewLayer cloth, outside, rim;
  cloth.points = outside.points = rim.points = sample.positions;
  outside.colour = Vec3(0.9, 0.9, 0.92);
  cloth.point_scalars.assign(sample.positions.size(), 0.0);
  for (const int node : sample.surface_nodes)
    cloth.point_scalars[node] =
        1e3 * (reflector::deviation(*context.surface, sample.positions[node]) - error.mean_shift);
  double range = 0;
  for (const auto& triangle : sample.triangles) {
    Vec3 centre = Vec3::Zero();
    for (const int node : triangle) centre += sample.positions[node] / 3;
    if (error.radius > 0 && centre.head<2>().norm() > error.radius) {
      outside.triangles.push_back(triangle);
      continue;
    }
    cloth.triangles.push_back(triangle);
    for (const int node : triangle) range = std::max(range, std::abs(cloth.point_scalars[node]));
  }
  for (const auto& line : sample.lines) {
    const Vec3 middle = (sample.positions[line[0]] + sample.positions[line[1]]) / 2;
    if (error.radius > 0 && middle.head<2>().norm() > error.radius) {
      outside.lines.push_back(line);
      continue;
    }
    cloth.lines.push_back(line);
    for (const int node : line) range = std::max(range, std::abs(cloth.point_scalars[node]));
  }
  cloth.line_width = 4;
  const char* what = sample.lines.empty() ? "cloth" : "net";
  rim.lines = frame_lines(context.system().model());
  const std::set<std::array<int, 2>> measured(sample.lines.begin(), sample.lines.end());
  std::erase_if(rim.lines, [&](const auto& line) { return measured.contains(line); });
  rim.line_width = 2.5;
  output::View view;
  view.title = fmt::format("Deviation of the {} from the paraboloid", what);
  view.subtitle = fmt::format(
      "RMS {:.3f} mm over {} nodes{}, about the mean shift of {:.3f} mm", 1e3 * error.rms, error.samples,
      error.radius > 0 ? fmt::format(" within radius {:g} m", error.radius) : "", 1e3 * error.mean_shift);
  view.scalar_title = "deviation [mm]";
  view.diverging = true;
  view.range = {{-range, range}};
  view.direction = Vec3(0, 0, 1);
  view.up = Vec3(0, 1, 0);
  view.layers = {std::move(outside), std::move(cloth), std::move(rim)};
  if (error.radius > 0) view.layers.push_back(circle_on(*context.surface, error.radius));
  context.draw("deviation",
               fmt::format("Deviation of the {} from the paraboloid about its mean, RMS {:.3f} mm", what,
                           1e3 * error.rms),
               view);
}

/// Cables coloured by tension before a grey frame.
output::View tension_view(Context& context, const model::Response& response, const std::vector<int>& cables,
                          std::vector<std::array<int, 2>> frame_edges) {
  const auto& model = context.system().model();
  output::ViewLayer layer, frame;
  layer.points = frame.points = model::positions(model, context.system().state());
  double least = 1e300, largest = 0, sum = 0;
  for (const int i : cables) {
    const double tension = response.cables[i].tension;
    layer.lines.push_back(model.cables[i].nodes);
    layer.cell_scalars.push_back(tension);
    least = std::min(least, tension);
    largest = std::max(largest, tension);
    sum += tension;
  }
  frame.lines = std::move(frame_edges);
  frame.line_width = 2;
  output::View view;
  const auto newtons = [](double value) {
    return std::abs(value) >= 1e4 ? fmt::format("{:.0f}", value) : fmt::format("{:.4g}", value);
  };
  view.subtitle = fmt::format("least {} N, mean {} N, largest {} N", newtons(least),
                              newtons(sum / static_cast<double>(cables.size())), newtons(largest));
  view.scalar_title = "tension [N]";
  view.layers = {std::move(frame), std::move(layer)};
  return view;
}

/// The displaced structure coloured by how far it went, drawn to a visible scale; light grey: before.
void draw_displacements(Context& context) {
  const auto& model = context.system().model();
  const auto& state = context.system().state();
  double most = 0;
  for (const auto& u : state.displacement) most = std::max(most, u.norm());
  if (most == 0) return;
  const double size = context.system().size(), natural = most / size;
  const double scale = natural >= 0.01 ? 1 : std::pow(10, std::floor(std::log10(0.05 / natural)));
  output::ViewLayer faces, lines, before;
  before.points = model.nodes;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    faces.points.push_back(model.nodes[i] + scale * state.displacement[i]);
    faces.point_scalars.push_back(1e3 * state.displacement[i].norm());
  }
  lines.points = faces.points;
  lines.point_scalars = faces.point_scalars;
  add_triangles(model.membranes, faces);
  add_triangles(model.shells, faces);
  for (const auto& cable : model.cables) lines.lines.push_back(cable.nodes);
  for (const auto& beam : model.beams) lines.lines.push_back(beam.nodes);
  before.lines = lines.lines;
  before.line_width = 1;
  before.colour = Vec3(0.75, 0.75, 0.78);
  lines.line_width = 2.5;
  output::View view;
  view.title =
      scale == 1 ? std::string("Displacements") : fmt::format("Displacements, {:g} times as large", scale);
  view.subtitle = fmt::format("largest {:.4g} mm", 1e3 * most);
  view.scalar_title = "displacement [mm]";
  view.layers = {std::move(before), std::move(faces), std::move(lines)};
  context.draw("displacements",
               fmt::format("Displacements, largest {:.4g} mm; light grey: before", 1e3 * most), view);
}

/// Membranes behind everything else, with the sides of their facets.
void add_cloth(Context& context, output::View& view) {
  const auto& model = context.system().model();
  output::ViewLayer cloth, mesh;
  cloth.points = mesh.points = model::positions(model, context.system().state());
  add_triangles(model.membranes, cloth);
  for (const auto& membrane : model.membranes)
    for (int k = 0, n = membrane.nodes.size(); k < n; ++k)
      mesh.lines.push_back({membrane.nodes[k], membrane.nodes[(k + 1) % n]});
  cloth.colour = Vec3(0.86, 0.87, 0.88);
  mesh.colour = Vec3(0.68, 0.70, 0.72);
  mesh.line_width = 1;
  view.layers.insert(view.layers.begin(), {std::move(cloth), std::move(mesh)});
}

/// Cords of the front net between its edges.
std::vector<int> front_cords(const model::Model& model) {
  std::vector<int> cords;
  for (const char* name : {"front_net", "front_rings", "front_columns"}) {
    if (model.find_group(name) < 0) continue;
    const auto group = model.select(name).cables;
    cords.insert(cords.end(), group.begin(), group.end());
  }
  return cords.empty() ? model.select("front_surface").cables : cords;
}

}  // namespace

void draw_tensions(Context& context, const model::Response& response) {
  const auto& model = context.system().model();
  std::vector<int> all(model.cables.size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<std::array<int, 2>> frame;
  for (const auto& shell : model.shells)
    for (int k = 0, n = shell.nodes.size(); k < n; ++k)
      frame.push_back({shell.nodes[k], shell.nodes[(k + 1) % n]});
  for (const auto& beam : model.beams) frame.push_back(beam.nodes);
  auto view = tension_view(context, response, all, frame);
  view.title = "Tensions of all cables";
  if (!context.surface && !model.membranes.empty()) add_cloth(context, view);
  context.draw("tensions", "Tensions of all cables; the frame in grey", view);
  if (!context.surface) return;
  view = tension_view(context, response, front_cords(model), frame_lines(model));
  view.title = "Tensions of the front net";
  view.direction = Vec3(0, 0, 1);
  view.up = Vec3(0, 1, 0);
  view.layers.back().line_width = 3;
  context.draw("net_tensions", "Tensions of the front net, seen along the axis", view);
}

void draw_state(Context& context, const model::Response& response) {
  if (!context.draws()) return;
  if (!context.surface) draw_displacements(context);
  if (context.surface) draw_deviation(context);
  if (!context.system().model().cables.empty()) draw_tensions(context, response);
}

}  // namespace tautline::steps
