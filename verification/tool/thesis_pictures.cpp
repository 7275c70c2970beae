#include "thesis_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <unordered_map>

#include <fmt/format.h>

#include <tautline/output/pictures.hpp>

namespace verify {

namespace {

namespace out = tautline::output;

Values all_of(const std::vector<std::string>& expressions, const Lookup& lookup) {
  Values values;
  for (const auto& expression : expressions) {
    const Values part = evaluate(expression, lookup);
    values.insert(values.end(), part.begin(), part.end());
  }
  return values;
}

out::Curve curve_of(const ChartCurve& item, const Lookup& lookup) {
  out::Curve curve{item.label, all_of(item.x, lookup), all_of(item.y, lookup), !item.sorted, item.line};
  if (item.sorted) {
    std::sort(curve.y.begin(), curve.y.end());
    const auto n = static_cast<double>(curve.y.size());
    for (std::size_t i = 0; i < curve.y.size(); ++i)
      curve.x.push_back(100 * (static_cast<double>(i) + 0.5) / n);
  } else if (curve.x.empty()) {
    curve.x.resize(curve.y.size());
    std::iota(curve.x.begin(), curve.x.end(), item.first);
  }
  if (curve.x.size() != curve.y.size())
    throw std::runtime_error(
        fmt::format("curve {}: {} abscissae, {} ordinates", item.label, curve.x.size(), curve.y.size()));
  return curve;
}

/// The columns of a table of elements or nodes.
class Columns {
 public:
  explicit Columns(const Table& table) : table_(table) {}
  std::size_t size() const { return table_.rows.size(); }
  bool has(const std::string& column) const { return table_.columns.count(column) > 0; }
  const std::string& text(std::size_t row, const std::string& column) const {
    static const std::string nothing;
    const auto& cells = table_.rows[row];
    const auto at = table_.columns.at(column);
    return at < cells.size() ? cells[at] : nothing;
  }
  double number(std::size_t row, const std::string& column) const { return std::stod(text(row, column)); }

 private:
  const Table& table_;
};

/// Draws elements of a run from its tables.
class Scene {
 public:
  Scene(Data& data, const ViewItem& item) : data_(data), item_(item), nodes_(data.table("nodes.csv")) {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      index_[nodes_.text(i, "id")] = static_cast<int>(i);
      points_.emplace_back(nodes_.number(i, "x"), nodes_.number(i, "y"), nodes_.number(i, "z"));
      displacement_.push_back(
          1e3 * std::hypot(nodes_.number(i, "ux"), nodes_.number(i, "uy"), nodes_.number(i, "uz")));
    }
  }

  out::ViewLayer coloured() {
    out::ViewLayer layer;
    layer.points = points_;
    layer.line_width = 2;
    if (item_.colour == Colour::displacement) {
      layer.point_scalars = displacement_;
      add_lines("cables.csv", item_.groups, layer);
      add_lines("beams.csv", item_.groups, layer);
      add_facets(layer);
    } else if (item_.colour == Colour::tension) {
      add_lines("cables.csv", item_.groups, layer, "tension");
    } else {
      layer.line_width = 4;
      add_lines("beams.csv", item_.groups, layer, "axial", -1);
    }
    if (layer.lines.empty() && layer.triangles.empty())
      throw std::runtime_error(item_.file + ": there is nothing to draw");
    return layer;
  }

  out::ViewLayer plain() {
    out::ViewLayer layer;
    layer.points = points_;
    layer.colour = {0.75, 0.75, 0.78};
    add_lines("cables.csv", item_.plain, layer);
    add_lines("beams.csv", item_.plain, layer);
    return layer;
  }

 private:
  static bool among(const std::vector<std::string>& groups, const std::string& group) {
    return std::find(groups.begin(), groups.end(), group) != groups.end();
  }

  void add_lines(const std::string& file, const std::vector<std::string>& groups, out::ViewLayer& layer,
                 const std::string& column = "", double factor = 1) {
    const Columns table(data_.table(file));
    for (std::size_t i = 0; i < table.size(); ++i) {
      if (!among(groups, table.text(i, "group"))) continue;
      layer.lines.push_back({index_.at(table.text(i, "node_1")), index_.at(table.text(i, "node_2"))});
      if (!column.empty()) layer.cell_scalars.push_back(factor * table.number(i, column));
    }
  }

  void add_facets(out::ViewLayer& layer) {
    const Columns table(data_.table("membranes.csv"));
    for (std::size_t i = 0; i < table.size(); ++i) {
      if (!among(item_.groups, table.text(i, "group"))) continue;
      const auto node = [&](const char* column) { return index_.at(table.text(i, column)); };
      layer.triangles.push_back({node("node_1"), node("node_2"), node("node_3")});
      if (!table.text(i, "node_4").empty())
        layer.triangles.push_back({node("node_1"), node("node_3"), node("node_4")});
    }
  }

  Data& data_;
  const ViewItem& item_;
  Columns nodes_;
  std::unordered_map<std::string, int> index_;
  tautline::Points points_;
  std::vector<double> displacement_;
};

const char* scalar_title(Colour colour) {
  switch (colour) {
    case Colour::tension:
      return "tension [N]";
    case Colour::compression:
      return "compression [N]";
    case Colour::displacement:
      break;
  }
  return "displacement [mm]";
}

}  // namespace

void draw_chart(const ChartItem& item, const Lookup& lookup, const std::string& png_path) {
  out::Chart chart{item.title, item.x_label, item.y_label, {}, item.log_x, item.log_y, 800, 520};
  for (const auto& curve : item.curves) chart.curves.push_back(curve_of(curve, lookup));
  out::draw(chart, png_path);
}

void draw_view(const ViewItem& item, Data& data, const std::string& png_path) {
  Scene scene(data, item);
  out::View view;
  view.title = item.title;
  if (!item.plain.empty()) view.layers.push_back(scene.plain());
  view.layers.push_back(scene.coloured());
  view.scalar_title = scalar_title(item.colour);
  view.range = item.range;
  view.direction = {item.direction[0], item.direction[1], item.direction[2]};
  if (item.direction[0] == 0 && item.direction[1] == 0) view.up = {0, 1, 0};
  view.width = 800;
  view.height = 640;
  out::draw(view, png_path);
}

}  // namespace verify
