#include "steps/rod_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include <tautline/la/session.hpp>
#include <tautline/output/tables.hpp>

namespace tautline::steps {

namespace {

using output::Curve;
using List = std::vector<double>;

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

template <class Get>
List along(const rod::RodShape& shape, const Get& get) {
  List values;
  for (const auto& point : shape.curve) values.push_back(get(point));
  return values;
}

/// Values of nodes 1..m with one for node 0 before them.
List from_root(double first, const VecX& values) {
  List list{first};
  list.insert(list.end(), values.begin(), values.end());
  return list;
}

/// Length from the root at nodes 0..m.
List node_lengths(const rod::RodShape& shape) {
  List s{0};
  for (const double length : shape.rod.lengths) s.push_back(s.back() + length);
  return s;
}

List deviations(const rod::Umbrella& umbrella, const rod::RodShape& shape) {
  return along(shape, [&](const rod::RodPoint& p) { return umbrella.meridian.distance(p.x, p.y); });
}

void draw_meridians(Context& context, const rod::RodShape& shape) {
  const rod::Umbrella& umbrella = *context.umbrella;
  const rod::Root straight = umbrella.root_at(0);
  Curve before{"straight, before the turn", {}, {}, true}, target{"meridian wanted", {}, {}, true, false};
  for (const double s : node_lengths(shape)) {
    before.x.push_back(straight.x + s * std::cos(straight.angle));
    before.y.push_back(straight.y + s * std::sin(straight.angle));
  }
  const double reach = std::max(shape.curve.back().x, umbrella.target_x.maxCoeff());
  constexpr int parts = 30;
  for (int i = 0; i <= parts; ++i) {
    target.x.push_back(shape.rod.root.x + (reach - shape.rod.root.x) * i / parts);
    target.y.push_back(umbrella.meridian.at(target.x.back()).value);
  }
  output::Chart chart;
  chart.title = "Meridian before and after";
  chart.x_label = "X, from the axis [m]";
  chart.y_label = "Y, along the axis [m]";
  chart.curves = {std::move(before),
                  Curve{"nodes of the bent rod", from_root(shape.rod.root.x, shape.x),
                        from_root(shape.rod.root.y, shape.y), true, false},
                  std::move(target),
                  Curve{"bent rod", along(shape, [](const auto& p) { return p.x; }),
                        along(shape, [](const auto& p) { return p.y; }), false}};
  context.draw("meridian",
               "Rod before the turn of its root and bent by the cables, beside the meridian wanted", chart);
}

/// The rods of this and all steps before in one chart.
void draw_shapes(Context& context, const rod::RodShape& shape) {
  context.rod_shapes.push_back(Curve{context.step_name, along(shape, [](const auto& p) { return p.x; }),
                                     along(shape, [](const auto& p) { return p.y; }), false});
  if (context.rod_shapes.size() < 2) return;
  output::Chart chart;
  chart.title = "Bent rods of the steps so far";
  chart.x_label = "X, from the axis [m]";
  chart.y_label = "Y, along the axis [m]";
  chart.curves = context.rod_shapes;
  context.draw("shapes", "Rods found by this step and those before", chart);
}

void draw_deviation(Context& context, const rod::RodShape& shape, const rod::RodReport& report) {
  List deviation = deviations(*context.umbrella, shape), at_nodes;
  for (double& value : deviation) value *= 1e3;
  for (std::size_t k = 0; k < node_lengths(shape).size(); ++k)
    at_nodes.push_back(deviation[k * rod::intervals_per_link]);
  output::Chart chart;
  chart.title = fmt::format("Distance from the meridian, RMS {:.3g} mm", 1e3 * report.along.rms);
  chart.x_label = "length from the root [m]";
  chart.y_label = "normal distance, positive towards +Y [mm]";
  chart.curves = {Curve{"rod", along(shape, [](const auto& p) { return p.s; }), deviation, false},
                  Curve{"nodes", node_lengths(shape), at_nodes, true, false}};
  context.draw(
      "deviation",
      fmt::format("Normal distance of the bent rod from the meridian, RMS {:.3g} mm", 1e3 * report.along.rms),
      chart);
}

void draw_moments(Context& context, const rod::RodShape& shape) {
  output::Chart chart;
  chart.title = "Bending moment along the rod";
  chart.x_label = "length from the root [m]";
  chart.y_label = "moment [N m]";
  const List s = node_lengths(shape);
  chart.curves = {
      Curve{"EI dtheta/ds", along(shape, [](const auto& p) { return p.s; }),
            along(shape, [](const auto& p) { return p.moment; }), false},
      Curve{"I: of the forces beyond", s, List(shape.moment.begin(), shape.moment.end()), true, false},
      Curve{"II: of the links, mean", s, List(shape.moment_of_links.begin(), shape.moment_of_links.end()),
            true, false}};
  context.draw("moments", "Bending moment along the rod, and at the nodes in both ways", chart);
}

Vec3 in_space(double azimuth, double x, double y) {
  return {x * std::cos(azimuth), x * std::sin(azimuth), y};
}

/// All rods coloured by moment, the cables of the parallels, and the straight rods in grey.
void draw_umbrella(Context& context, const rod::RodShape& shape) {
  const rod::Umbrella& umbrella = *context.umbrella;
  const rod::Root straight = umbrella.root_at(0);
  const int rods = umbrella.cables.rods, points = static_cast<int>(shape.curve.size());
  const List lengths = node_lengths(shape);
  output::ViewLayer bent, cables, before;
  for (int i = 0; i < rods; ++i) {
    const double azimuth = 2 * std::numbers::pi * i / rods;
    for (int k = 0; k < points; ++k) {
      const auto& p = shape.curve[k];
      bent.points.push_back(in_space(azimuth, p.x, p.y));
      bent.point_scalars.push_back(p.moment);
      if (k > 0) bent.lines.push_back({i * points + k - 1, i * points + k});
    }
    for (const double s : {0.0, lengths.back()})
      before.points.push_back(in_space(azimuth, straight.x + s * std::cos(straight.angle),
                                       straight.y + s * std::sin(straight.angle)));
    before.lines.push_back({2 * i, 2 * i + 1});
    for (int k = 1; k < static_cast<int>(lengths.size()); ++k)
      cables.lines.push_back(
          {i * points + k * rod::intervals_per_link, (i + 1) % rods * points + k * rod::intervals_per_link});
  }
  cables.points = bent.points;
  bent.line_width = 3.5;
  before.line_width = 1;
  before.colour = Vec3(0.8, 0.8, 0.83);
  output::View view;
  view.title = "Umbrella of all rods";
  view.subtitle =
      fmt::format("{} rods of {} links; light grey: straight, before the turn", rods, umbrella.rod.links());
  view.scalar_title = "bending moment [N m]";
  view.layers = {std::move(before), std::move(cables), std::move(bent)};
  context.draw("umbrella", "All rods bent by the cables of the parallels, coloured by bending moment", view);
}

}  // namespace

void draw_rod(Context& context, const rod::RodShape& shape, const rod::RodReport& report) {
  if (!context.draws()) return;
  draw_umbrella(context, shape);
  draw_meridians(context, shape);
  draw_shapes(context, shape);
  draw_deviation(context, shape, report);
  draw_moments(context, shape);
}

void write_rod_tables(const Context& context, const rod::RodShape& shape, const rod::RodReport& report) {
  if (!context.deck.output.tables) return;
  la::on_root([&] {
    List number;
    for (int k = 0; k <= shape.rod.links(); ++k) number.push_back(k);
    const auto& root = shape.rod.root;
    output::write_columns(
        context.step_path("_nodes.csv"),
        {"node", "x", "y", "theta", "reaction", "strain", "stiffness", "moment", "moment_of_links",
         "node_error", "miss_x", "miss_y"},
        {number, from_root(root.x, shape.x), from_root(root.y, shape.y), from_root(root.angle, shape.angle),
         from_root(nothing, shape.reaction), from_root(nothing, report.strain),
         from_root(nothing, report.stiffness), List(shape.moment.begin(), shape.moment.end()),
         List(shape.moment_of_links.begin(), shape.moment_of_links.end()), from_root(0, report.node_error),
         from_root(0, report.miss_x), from_root(0, report.miss_y)});
    output::write_columns(
        context.step_path("_rod.csv"), {"s", "x", "y", "theta", "moment", "deviation"},
        {along(shape, [](const auto& p) { return p.s; }), along(shape, [](const auto& p) { return p.x; }),
         along(shape, [](const auto& p) { return p.y; }), along(shape, [](const auto& p) { return p.angle; }),
         along(shape, [](const auto& p) { return p.moment; }), deviations(*context.umbrella, shape)});
  });
}

}  // namespace tautline::steps
