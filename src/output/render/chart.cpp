#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <vtkAxis.h>
#include <vtkBrush.h>
#include <vtkChartXY.h>
#include <vtkContextActor.h>
#include <vtkContextScene.h>
#include <vtkDoubleArray.h>
#include <vtkPen.h>
#include <vtkPlotPoints.h>
#include <vtkRenderer.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>

#include "output/render/colours.hpp"
#include "output/render/draw.hpp"
#include "output/render/offscreen.hpp"
#include "output/render/overlay.hpp"
#include "output/render/ticks.hpp"

namespace tautline::output::render {

namespace {

constexpr double scale = supersampling;

struct Axis {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  bool logarithmic = false;
  bool whole = true;  ///< only whole numbers seen
};

bool shown(double value, bool logarithmic) {
  return std::isfinite(value) && (!logarithmic || value > 0);
}

/// The points of a curve that can be drawn.
Curve drawable(const Chart& chart, const Curve& curve) {
  if (curve.x.size() != curve.y.size()) throw std::runtime_error("a curve needs as many x as y");
  Curve result{curve.label, {}, {}, curve.markers, curve.line};
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    if (!shown(curve.x[i], chart.log_x) || !shown(curve.y[i], chart.log_y)) continue;
    result.x.push_back(curve.x[i]);
    result.y.push_back(curve.y[i]);
  }
  return result;
}

void widen(Axis& axis, const std::vector<double>& values) {
  for (const double value : values) {
    axis.low = std::min(axis.low, value);
    axis.high = std::max(axis.high, value);
    axis.whole = axis.whole && value == std::round(value);
  }
}

/// Room on both sides of the data; never an empty range.
void pad(Axis& axis, double fraction) {
  if (axis.low > axis.high) axis.low = axis.high = 1;
  if (axis.logarithmic) {
    const double factor = std::max(std::pow(axis.high / axis.low, fraction), 1.15);
    axis.low /= factor;
    axis.high *= factor;
    return;
  }
  const double size = std::max(std::abs(axis.low), std::abs(axis.high));
  const double span = std::max(axis.high - axis.low, size > 0 ? 1e-6 * size : 1.0);
  const bool from_zero = axis.low >= 0 && axis.low < 0.3 * axis.high && fraction > 0.05;
  axis.low = from_zero ? 0 : axis.low - fraction * span;
  axis.high += fraction * span;
}

void set_axis(vtkAxis* target, const Axis& axis, bool horizontal) {
  target->SetTitle("");  // drawn apart, since VTK puts it over the labels
  target->SetLogScale(axis.logarithmic);
  target->SetBehavior(vtkAxis::FIXED);
  target->SetUnscaledRange(axis.low, axis.high);
  const Ticks ticks = axis.logarithmic ? logarithmic_ticks(axis.low, axis.high)
                                       : linear_ticks(axis.low, axis.high, horizontal ? 10 : 7, axis.whole);
  vtkNew<vtkDoubleArray> positions;
  vtkNew<vtkStringArray> labels;
  for (std::size_t i = 0; i < ticks.values.size(); ++i) {
    positions->InsertNextValue(axis.logarithmic ? std::log10(ticks.values[i]) : ticks.values[i]);
    labels->InsertNextValue(ticks.labels[i]);
  }
  target->SetCustomTickPositions(positions, labels);
  target->GetLabelProperties()->SetFontSize(static_cast<int>(18 * scale));
  target->GetLabelProperties()->SetColor(0.13, 0.14, 0.16);
  target->SetLabelOffset(static_cast<float>(9 * scale));
  target->SetTickLength(static_cast<float>(6 * scale));
  target->GetPen()->SetWidth(static_cast<float>(1.4 * scale));
  target->GetPen()->SetColor(90, 92, 98);
  target->GetGridPen()->SetWidth(static_cast<float>(1.0 * scale));
  target->GetGridPen()->SetColor(226, 228, 232);
}

void add_curve(vtkChartXY* target, const Curve& curve, std::size_t index) {
  if (curve.x.empty()) return;
  vtkNew<vtkTable> table;
  vtkNew<vtkDoubleArray> x, y;
  x->SetName("x");
  y->SetName(("  " + curve.label).c_str());
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    x->InsertNextValue(curve.x[i]);
    y->InsertNextValue(curve.y[i]);
  }
  table->AddColumn(x);
  table->AddColumn(y);
  static constexpr int markers[] = {vtkPlotPoints::CIRCLE, vtkPlotPoints::SQUARE, vtkPlotPoints::DIAMOND,
                                    vtkPlotPoints::PLUS, vtkPlotPoints::CROSS};
  auto* plot = vtkPlotPoints::SafeDownCast(target->AddPlot(curve.line ? vtkChart::LINE : vtkChart::POINTS));
  plot->SetInputData(table, 0, 1);
  const auto colour = curve_colour(index);
  plot->SetColor(colour[0], colour[1], colour[2], 255);
  plot->SetWidth(static_cast<float>(2.4 * scale));
  plot->SetMarkerStyle(curve.markers ? markers[index % std::size(markers)]
                                     : static_cast<int>(vtkPlotPoints::NONE));
  plot->SetMarkerSize(static_cast<float>(9 * scale));
}

/// Below the title, where no curve can be. @return its height
double add_legend(vtkRenderer* renderer, const Chart& chart, double left, double top) {
  std::vector<LegendEntry> entries;
  for (std::size_t i = 0; i < chart.curves.size(); ++i) {
    const auto colour = curve_colour(i);
    entries.push_back({chart.curves[i].label, {colour[0] / 255.0, colour[1] / 255.0, colour[2] / 255.0}});
  }
  return entries.size() < 2 ? 0 : render::add_legend(renderer, entries, left, chart.width - 25, top);
}

}  // namespace

void draw(const Chart& chart, const std::string& png_path) {
  std::vector<Curve> curves;
  Axis x, y;
  x.logarithmic = chart.log_x;
  y.logarithmic = chart.log_y;
  for (const auto& curve : chart.curves) {
    curves.push_back(drawable(chart, curve));
    widen(x, curves.back().x);
    widen(y, curves.back().y);
  }
  const bool empty = x.low > x.high;
  pad(x, 0.03);
  pad(y, 0.07);

  Offscreen target(chart.width, chart.height);
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(1, 1, 1);
  target.window()->AddRenderer(renderer);
  const double left = 46, bottom = 44, titles = titles_height(chart.title, "");
  const double band = titles + add_legend(renderer, chart, left, chart.height - titles + 6);
  add_titles(renderer, chart.title, "", chart.width, chart.height);
  add_text(renderer, chart.x_label, 0.5 * (left + chart.width), 12,
           {.size = 20, .horizontal = Align::centre, .max_width = chart.width - 2 * left});
  add_text(
      renderer, chart.y_label, 36, 0.5 * (bottom + chart.height - band),
      {.size = 20, .horizontal = Align::centre, .rotation = 90, .max_width = chart.height - band - bottom});
  if (empty)
    add_text(renderer, "nothing to show", 0.5 * chart.width, 0.5 * chart.height,
             {.horizontal = Align::centre});
  vtkNew<vtkChartXY> plot_area;
  plot_area->SetAutoSize(false);
  plot_area->SetSize(vtkRectf(static_cast<float>(scale * left), static_cast<float>(scale * bottom),
                              static_cast<float>(scale * (chart.width - left - 25)),
                              static_cast<float>(scale * (chart.height - band - bottom))));
  set_axis(plot_area->GetAxis(vtkAxis::BOTTOM), x, true);
  set_axis(plot_area->GetAxis(vtkAxis::LEFT), y, false);
  for (std::size_t i = 0; i < curves.size(); ++i) add_curve(plot_area, curves[i], i);
  plot_area->SetShowLegend(false);
  vtkNew<vtkContextActor> actor;
  actor->GetScene()->AddItem(plot_area);
  renderer->AddActor(actor);
  target.write(png_path);
}

}  // namespace tautline::output::render
