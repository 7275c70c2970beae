#include "steps/mode_shapes.hpp"

#include <cmath>

#include "steps/summaries.hpp"
#include "steps/state_pictures.hpp"

namespace tautline::steps {

Points display_shape(const assembly::System& system, const la::Vector& mode) {
  Points shape = system.nodal(mode).displacement;
  double largest = 0;
  for (const auto& v : shape) largest = std::max(largest, v.norm());
  double signed_peak = 0;
  for (const auto& v : shape)
    for (int c = 0; c < 3; ++c)
      if (std::abs(v[c]) > std::abs(signed_peak) * (1 + 1e-6)) signed_peak = v[c];
  const double scale = (signed_peak < 0 ? -1.0 : 1.0) / largest;
  for (auto& v : shape) v *= scale;
  return shape;
}

output::Field mode_field(const std::string& name, const Points& shape) {
  output::Field field{name, 3, {}};
  for (const auto& v : shape) field.values.insert(field.values.end(), v.begin(), v.end());
  return field;
}

void draw_mode(Context& context, const Points& shape, const std::string& name, const std::string& title,
               const std::string& caption) {
  const auto& system = context.system();
  const auto& model = system.model();
  Points points = model::positions(model, system.state());
  Vec3 low = points.front(), high = low;
  for (const auto& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double size = 0.05 * (high - low).norm();
  output::ViewLayer surface, frame, rest;
  for (std::size_t i = 0; i < points.size(); ++i) surface.point_scalars.push_back(shape[i].norm());
  rest.points = points;
  for (std::size_t i = 0; i < points.size(); ++i) points[i] += size * shape[i];
  surface.points = frame.points = points;
  add_triangles(model.membranes, surface);
  add_triangles(model.shells, surface);
  for (const auto& b : model.beams) frame.lines.push_back(b.nodes);
  if (surface.triangles.empty())
    for (const auto& c : model.cables) surface.lines.push_back(c.nodes);
  rest.lines = frame.lines;
  rest.line_width = 1;
  frame.line_width = 2.5;
  rest.colour = Vec3(0.75, 0.75, 0.78);
  output::View view;
  view.title = title;
  view.layers = {std::move(surface), std::move(rest), std::move(frame)};
  view.scalar_title = "relative amplitude";
  context.draw(name, caption, view);
}

}  // namespace tautline::steps
