#include "steps/path_results.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <tautline/model/response.hpp>

#include "steps/balance.hpp"
#include "steps/mode_shapes.hpp"
#include "steps/summaries.hpp"
#include "steps/fields.hpp"

namespace tautline::steps {

namespace {

const char* name_of(analysis::CriticalPoint::Kind kind) {
  return kind == analysis::CriticalPoint::Kind::limit ? "limit" : "bifurcation";
}

constexpr double worth_showing = 0.2;  // a component that reaches this part of the largest one

/// A component of one monitor's displacement.
struct Watched {
  std::string name;
  int component = 0;
};

std::vector<Watched> watched_of(const Json& path) {
  std::vector<Watched> list;
  if (path.empty() || !path.front().contains("monitors")) return list;
  for (const auto& [name, value] : path.front()["monitors"].items()) {
    std::array<double, 3> reach{};
    for (const auto& point : path)
      for (std::size_t c = 0; c < 3; ++c)
        reach[c] = std::max(reach[c], std::abs(point["monitors"][name]["displacement"][c].get<double>()));
    const double most = *std::max_element(reach.begin(), reach.end());
    for (std::size_t c = 0; c < 3; ++c)
      if (most > 0 && reach[c] >= worth_showing * most) list.push_back({name, static_cast<int>(c)});
  }
  return list;
}

output::Curve curve_of(const Json& points, const Watched& watched, const std::string& label, bool line) {
  output::Curve curve{label, {}, {}, true, line};
  for (const auto& point : points) {
    curve.x.push_back(point["monitors"][watched.name]["displacement"][watched.component].get<double>());
    curve.y.push_back(point["lambda"].get<double>());
  }
  return curve;
}

}  // namespace

Json critical_point_json(assembly::System& system, const analysis::CriticalPoint& point,
                         const std::vector<std::string>& monitors) {
  Json entry{{"lambda", point.lambda},
             {"kind", name_of(point.kind)},
             {"negative_before", point.negative_before},
             {"negative_after", point.negative_after},
             {"load_share", point.load_share}};
  if (monitors.empty()) return entry;
  const auto there = system.keep();
  system.return_to(*point.kept);
  entry["monitors"] = monitors_json(system, monitors);
  system.return_to(*there);
  return entry;
}

void draw_critical_points(Context& context, const analysis::PathSummary& path, std::size_t first) {
  if (path.critical.empty()) return;
  auto& system = context.system();
  const auto there = system.keep();
  auto grid = field_grid(context, model::evaluate_response(system.model(), system.state()));
  grid.point_fields.clear();
  for (auto number = first; const auto& point : path.critical) {
    system.return_to(*point.kept);
    const Points shape = display_shape(system, point.mode);
    const std::string title =
        fmt::format("Critical mode {}: {} at load factor {:.5g}", number, name_of(point.kind), point.lambda);
    grid.point_fields.push_back(mode_field(title, shape));
    if (context.draws() && number <= 3)
      draw_mode(context, shape, fmt::format("critical_{}", number), title, title + "; light grey: the state");
    ++number;
  }
  system.return_to(*there);
  const std::string name = context.step_name + " critical points";
  context.write_fields(first == 1 ? name : fmt::format("{} from {} on", name, first), grid);
}

void draw_path(Context& context, const Json& path, const Json& critical) {
  if (!context.draws() || path.size() < 2) return;
  const auto list = watched_of(path);
  if (list.empty()) return;
  output::Chart chart;
  chart.title = "Load path";
  chart.x_label = "displacement [m]";
  chart.y_label = "load factor";
  for (const auto& watched : list) {
    const std::string label = fmt::format("{}, {}", watched.name, "xyz"[watched.component]);
    chart.curves.push_back(curve_of(path, watched, label, true));
    if (!critical.empty())
      chart.curves.push_back(curve_of(critical, watched, "critical points, " + label, false));
  }
  context.draw("path", "Load factor against the motion of what is watched, with the critical points", chart);
}

}  // namespace tautline::steps
