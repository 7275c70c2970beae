#include "steps/state_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include <fmt/format.h>

#include "steps/summaries.hpp"

namespace tautline::steps {

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
