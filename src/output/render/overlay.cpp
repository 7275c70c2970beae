#include "output/render/overlay.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <vtkActor2D.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty2D.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>

#include "output/render/offscreen.hpp"
#include "output/render/ticks.hpp"

namespace tautline::output::render {

namespace {

constexpr double margin = 28;
constexpr double scale = supersampling;

void add_flat(vtkRenderer* renderer, vtkPolyData* shapes, double line_width,
              const std::array<double, 3>& colour) {
  vtkNew<vtkPolyDataMapper2D> mapper;
  mapper->SetInputData(shapes);
  vtkNew<vtkActor2D> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(colour[0], colour[1], colour[2]);
  actor->GetProperty()->SetLineWidth(static_cast<float>(line_width * scale));
  renderer->AddActor2D(actor);
}

void add_line(vtkRenderer* renderer, const std::vector<Vec<2>>& path, double width,
              const std::array<double, 3>& colour) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell(static_cast<vtkIdType>(path.size()));
  for (const auto& point : path)
    cells->InsertCellPoint(points->InsertNextPoint(scale * point[0], scale * point[1], 0));
  vtkNew<vtkPolyData> shapes;
  shapes->SetPoints(points);
  shapes->SetLines(cells);
  add_flat(renderer, shapes, width, colour);
}

/// The colours of the table as a stack of rectangles.
void add_gradient(vtkRenderer* renderer, vtkLookupTable* table, double left, double right, double bottom,
                  double top) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetNumberOfComponents(3);
  const int n = static_cast<int>(table->GetNumberOfTableValues());
  for (int i = 0; i <= n; ++i) {
    const double y = bottom + (top - bottom) * i / n;
    points->InsertNextPoint(scale * left, scale * y, 0);
    points->InsertNextPoint(scale * right, scale * y, 0);
    if (i == n) break;
    const vtkIdType corners[] = {2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2};
    cells->InsertNextCell(4, corners);
    double rgba[4];
    table->GetTableValue(i, rgba);
    colours->InsertNextTuple3(255 * rgba[0], 255 * rgba[1], 255 * rgba[2]);
  }
  vtkNew<vtkPolyData> shapes;
  shapes->SetPoints(points);
  shapes->SetPolys(cells);
  shapes->GetCellData()->SetScalars(colours);
  add_flat(renderer, shapes, 1, {0, 0, 0});
}

double text_length(vtkRenderer* renderer, const std::string& text, int size) {
  vtkNew<vtkTextActor> actor;
  actor->SetInput(text.c_str());
  actor->GetTextProperty()->SetFontFamilyToArial();
  actor->GetTextProperty()->SetFontSize(static_cast<int>(size * scale));
  double box[4];
  actor->GetBoundingBox(renderer, box);
  return (box[1] - box[0]) / scale;
}

}  // namespace

void add_text(vtkRenderer* renderer, const std::string& text, double x, double y, const TextStyle& style) {
  if (text.empty()) return;
  vtkNew<vtkTextActor> actor;
  actor->SetInput(text.c_str());
  actor->SetPosition(scale * x, scale * y);
  actor->SetOrientation(style.rotation);
  auto* property = actor->GetTextProperty();
  property->SetFontFamilyToArial();
  property->SetBold(style.bold);
  property->SetColor(style.colour[0], style.colour[1], style.colour[2]);
  property->SetJustification(static_cast<int>(style.horizontal));
  property->SetVerticalJustification(static_cast<int>(style.vertical));
  for (int size = style.size; size >= 9; --size) {
    property->SetFontSize(static_cast<int>(size * scale));
    double box[4];
    actor->GetBoundingBox(renderer, box);
    const double length = std::max(box[1] - box[0], style.rotation != 0 ? box[3] - box[2] : 0.0);
    if (style.max_width <= 0 || length <= scale * style.max_width) break;
  }
  renderer->AddActor2D(actor);
}

void add_titles(vtkRenderer* renderer, const std::string& title, const std::string& subtitle, int width,
                int height) {
  const double room = width - 2 * margin;
  add_text(renderer, title, margin, height - 20,
           {.size = 30, .bold = true, .vertical = Align::right, .max_width = room});
  add_text(renderer, subtitle, margin, height + 8 - titles_height(title, ""),
           {.size = 21, .vertical = Align::right, .max_width = room, .colour = {0.35, 0.37, 0.4}});
}

double titles_height(const std::string& title, const std::string& subtitle) {
  return 28 + (title.empty() ? 0 : 42) + (subtitle.empty() ? 0 : 32);
}

double add_legend(vtkRenderer* renderer, const std::vector<LegendEntry>& entries, double left, double right,
                  double top) {
  constexpr double row = 30, line = 34, gap = 10, between = 34;
  constexpr int size = 18;
  double x = left, y = top - 0.5 * row;
  for (const auto& [label, colour] : entries) {
    const double length = line + gap + text_length(renderer, label, size);
    if (x > left && x + length > right) {
      x = left;
      y -= row;
    }
    add_line(renderer, {{x, y}, {x + line, y}}, 4, colour);
    add_text(renderer, label, x + line + gap, y,
             {.size = size, .vertical = Align::centre, .max_width = right - x - line - gap});
    x += length + between;
  }
  return entries.empty() ? 0 : top - y + 0.5 * row;
}

double colour_bar_width() {
  return 165;
}

void add_colour_bar(vtkRenderer* renderer, vtkLookupTable* table, const std::string& title, int width,
                    double bottom, double top) {
  const double left = width - 140, right = left + 24;
  add_gradient(renderer, table, left, right, bottom, top);
  const std::array<double, 3> ink{0.3, 0.3, 0.32};
  add_line(renderer, {{left, bottom}, {right, bottom}, {right, top}, {left, top}, {left, bottom}}, 1, ink);
  const double low = table->GetTableRange()[0], high = table->GetTableRange()[1];
  const Ticks ticks = linear_ticks(low, high, 7);
  for (std::size_t i = 0; i < ticks.values.size(); ++i) {
    const double y = bottom + (top - bottom) * (ticks.values[i] - low) / (high - low);
    add_line(renderer, {{right, y}, {right + 6, y}}, 1.2, ink);
    add_text(renderer, ticks.labels[i], right + 11, y, {.size = 19, .vertical = Align::centre});
  }
  add_text(renderer, title, left - 12, 0.5 * (bottom + top),
           {.size = 20, .horizontal = Align::centre, .rotation = 90, .max_width = top - bottom + 60});
}

void add_axes(vtkRenderer* renderer, const Mat<3, 2>& screen_axes) {
  static constexpr const char* names[] = {"x", "y", "z"};
  const Vec<2> origin(margin + 46, margin + 40);
  for (int axis = 0; axis < 3; ++axis) {
    const Vec<2> arm = screen_axes.row(axis).transpose();
    if (arm.norm() < 0.2) continue;
    const std::array<double, 3> ink{0.45, 0.46, 0.5};
    add_line(renderer, {origin, origin + 40 * arm}, 2, ink);
    const Vec<2> place = origin + 40 * arm + 11 * arm.normalized();
    add_text(
        renderer, names[axis], place[0], place[1],
        {.size = 17, .horizontal = Align::centre, .vertical = Align::centre, .colour = {0.3, 0.31, 0.34}});
  }
}

void add_scale(vtkRenderer* renderer, double metres_per_pixel, int width) {
  const double wanted = 0.16 * width * metres_per_pixel;
  const double power = std::pow(10.0, std::floor(std::log10(wanted)));
  const double length = (wanted >= 5 * power ? 5 : wanted >= 2 * power ? 2 : 1) * power;
  const double x = margin + 130, y = margin + 14, end = x + length / metres_per_pixel;
  const std::array<double, 3> ink{0.3, 0.31, 0.34};
  add_line(renderer, {{x, y + 7}, {x, y}, {end, y}, {end, y + 7}}, 2, ink);
  const std::string text = length < 1 ? fmt::format("{:g} mm", 1000 * length) : fmt::format("{:g} m", length);
  add_text(renderer, text, 0.5 * (x + end), y + 8, {.size = 18, .horizontal = Align::centre, .colour = ink});
}

}  // namespace tautline::output::render
