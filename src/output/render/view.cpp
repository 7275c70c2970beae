#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkLight.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>

#include "output/render/colours.hpp"
#include "output/render/draw.hpp"
#include "output/render/offscreen.hpp"
#include "output/render/overlay.hpp"

namespace tautline::output::render {

namespace {

using Range = std::array<double, 2>;

/// Screen axes of a view and how far the drawn points reach along them.
struct Frame {
  Mat3 axes;  ///< columns: screen right, screen up, towards the camera
  Vec3 low, high;
};

void widen(Range& range, const std::vector<double>& values) {
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    range[0] = std::min(range[0], value);
    range[1] = std::max(range[1], value);
  }
}

Range colour_range(const View& view) {
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  if (view.range) {
    range = *view.range;
  } else {
    for (const auto& layer : view.layers) {
      widen(range, layer.cell_scalars);
      widen(range, layer.point_scalars);
    }
    if (range[0] > range[1]) range = {0, 1};
    if (view.diverging) {
      const double largest = std::max(std::abs(range[0]), std::abs(range[1]));
      range = {-largest, largest};
    }
  }
  const double least = 1e-9 * std::max(std::abs(range[0]), std::abs(range[1]));
  if (range[1] - range[0] <= least) {
    const double half = range[0] == 0 ? 1.0 : 0.05 * std::abs(range[0]);
    range = {range[0] - half, range[1] + half};
  }
  return range;
}

Frame frame_of(const View& view) {
  const Vec3 towards = view.direction.normalized();
  Vec3 right = view.up.cross(towards);
  if (right.norm() < 1e-6) right = Vec3::UnitY().cross(towards);
  if (right.norm() < 1e-6) right = Vec3::UnitX().cross(towards);
  right.normalize();
  Frame frame;
  frame.axes << right, towards.cross(right), towards;
  frame.low.setConstant(std::numeric_limits<double>::infinity());
  frame.high = -frame.low;
  for (const auto& layer : view.layers) {
    for (const auto& point : layer.points) {
      const Vec3 seen = frame.axes.transpose() * point;
      frame.low = frame.low.cwiseMin(seen);
      frame.high = frame.high.cwiseMax(seen);
    }
  }
  if (!(frame.high - frame.low).allFinite()) throw std::runtime_error("there is nothing to draw");
  return frame;
}

/// Where the data go, in pixels of the picture, and its size: flat or slender data do not need all of it.
struct Layout {
  double left, right, bottom, top;
  double metres_per_pixel;
  int width, height;
};

Layout lay_out(const View& view, const Frame& frame) {
  const double band = titles_height(view.title, view.subtitle) + 10;
  const double beside = view.scalar_title.empty() ? 30 : colour_bar_width() + 20;
  Layout layout{30, view.width - beside, 95, view.height - band, 0, view.width, view.height};
  const Vec3 extent = frame.high - frame.low;
  const double wide = extent[0] / (layout.right - layout.left),
               high = extent[1] / (layout.top - layout.bottom);
  layout.metres_per_pixel = std::max({wide, high, 1e-9});
  const auto shrunk = [](double needed, int given) {
    return static_cast<int>(std::clamp(needed, 0.6 * given, 1.0 * given));
  };
  layout.height = shrunk(layout.bottom + extent[1] / layout.metres_per_pixel + band, view.height);
  layout.width = shrunk(layout.left + extent[0] / layout.metres_per_pixel + beside, view.width);
  layout.right = layout.width - beside;
  layout.top = layout.height - band;
  return layout;
}

/// Parallel projection with the data centred in their room.
void place_camera(vtkRenderer* renderer, const Frame& frame, const Layout& layout) {
  const Vec3 extent = frame.high - frame.low, centre = 0.5 * (frame.low + frame.high);
  const Vec3 shift(0.5 * (layout.left + layout.right - layout.width),
                   0.5 * (layout.bottom + layout.top - layout.height), 0);
  const Vec3 focus = frame.axes * (centre - layout.metres_per_pixel * shift);
  const Vec3 eye = focus + frame.axes.col(2) * (extent.norm() + 1.0);
  auto* camera = renderer->GetActiveCamera();
  camera->ParallelProjectionOn();
  camera->SetFocalPoint(focus[0], focus[1], focus[2]);
  camera->SetPosition(eye[0], eye[1], eye[2]);
  camera->SetViewUp(frame.axes(0, 1), frame.axes(1, 1), frame.axes(2, 1));
  camera->SetParallelScale(0.5 * layout.height * layout.metres_per_pixel);
}

vtkSmartPointer<vtkPoints> vtk_points(const Points& points) {
  auto result = vtkSmartPointer<vtkPoints>::New();
  result->SetNumberOfPoints(static_cast<vtkIdType>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    result->SetPoint(static_cast<vtkIdType>(i), points[i].data());
  return result;
}

template <std::size_t N>
vtkSmartPointer<vtkCellArray> vtk_cells(const std::vector<std::array<int, N>>& cells) {
  auto result = vtkSmartPointer<vtkCellArray>::New();
  result->AllocateEstimate(static_cast<vtkIdType>(cells.size()), N);
  for (const auto& cell : cells) {
    result->InsertNextCell(N);
    for (const int node : cell) result->InsertCellPoint(node);
  }
  return result;
}

vtkSmartPointer<vtkDoubleArray> vtk_scalars(const std::vector<double>& values, std::size_t first,
                                            std::size_t count) {
  auto result = vtkSmartPointer<vtkDoubleArray>::New();
  result->SetNumberOfValues(static_cast<vtkIdType>(count));
  std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(first), count, result->GetPointer(0));
  return result;
}

/// Length of the sides of the triangles on the screen, roughly: the square root of the mean area.
double mean_side(const ViewLayer& layer) {
  double area = 0;
  for (const auto& t : layer.triangles) {
    const Vec3 &a = layer.points[static_cast<std::size_t>(t[0])],
               &b = layer.points[static_cast<std::size_t>(t[1])],
               &c = layer.points[static_cast<std::size_t>(t[2])];
    area += 0.5 * (b - a).cross(c - a).norm();
  }
  return std::sqrt(2 * area / static_cast<double>(layer.triangles.size()));
}

/// @param even hardly any shade, so that colours are read against the bar
void set_looks(vtkActor* actor, const ViewLayer& layer, bool surface, bool even, double metres_per_pixel) {
  auto* property = actor->GetProperty();
  property->SetColor(layer.colour[0], layer.colour[1], layer.colour[2]);
  property->SetOpacity(layer.opacity);
  property->SetLineWidth(static_cast<float>(layer.line_width * supersampling));
  if (!surface) {
    property->LightingOff();  // colours of lines are read against the bar
    return;
  }
  property->SetInterpolationToFlat();
  property->SetAmbient(even ? 0.9 : 0.45);
  property->SetDiffuse(even ? 0.1 : 0.58);
  if (mean_side(layer) > 28 * metres_per_pixel) {
    property->EdgeVisibilityOn();
    property->SetEdgeColor(0.62, 0.64, 0.67);
    property->SetLineWidth(1.0F * supersampling);
  }
}

/// The lines or the triangles of a layer.
///
/// Lines are moved towards the camera, more so in later layers: they lie before the surfaces and the lines of
/// the layers below. The parallel projection does not show the shift.
void add_cells(vtkRenderer* renderer, const View& view, std::size_t index, bool surface,
               vtkLookupTable* table, const Frame& frame, double metres_per_pixel) {
  const ViewLayer& layer = view.layers[index];
  const std::size_t first = surface ? layer.lines.size() : 0;
  const std::size_t count = surface ? layer.triangles.size() : layer.lines.size();
  if (count == 0) return;
  vtkNew<vtkPolyData> data;
  data->SetPoints(vtk_points(layer.points));
  if (surface)
    data->SetPolys(vtk_cells(layer.triangles));
  else
    data->SetLines(vtk_cells(layer.lines));
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  mapper->SetLookupTable(table);
  mapper->UseLookupTableScalarRangeOn();
  mapper->SetScalarVisibility(!layer.cell_scalars.empty() || !layer.point_scalars.empty());
  if (!layer.cell_scalars.empty()) {
    data->GetCellData()->SetScalars(vtk_scalars(layer.cell_scalars, first, count));
    mapper->SetScalarModeToUseCellData();
  } else if (!layer.point_scalars.empty()) {
    data->GetPointData()->SetScalars(vtk_scalars(layer.point_scalars, 0, layer.points.size()));
    mapper->SetScalarModeToUsePointData();
    mapper->InterpolateScalarsBeforeMappingOn();
  }
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  set_looks(actor, layer, surface, view.diverging, metres_per_pixel);
  if (!surface) {
    const double depth = 1e-3 * (frame.high - frame.low).norm();
    const Vec3 shift = depth * (1 + 0.5 * static_cast<double>(index)) * frame.axes.col(2);
    actor->SetPosition(shift[0], shift[1], shift[2]);
  }
  renderer->AddActor(actor);
}

void check(const View& view) {
  for (const auto& layer : view.layers) {
    const std::size_t cells = layer.lines.size() + layer.triangles.size();
    if (!layer.cell_scalars.empty() && layer.cell_scalars.size() != cells)
      throw std::runtime_error("a layer of the view needs one cell scalar for each cell");
    if (!layer.point_scalars.empty() && layer.point_scalars.size() != layer.points.size())
      throw std::runtime_error("a layer of the view needs one point scalar for each point");
  }
}

/// A lamp above the camera's left shoulder, so that facets differ in shade.
void add_light(vtkRenderer* renderer) {
  vtkNew<vtkLight> light;
  light->SetLightTypeToCameraLight();
  light->SetPosition(-0.35, 0.6, 1.0);
  light->SetFocalPoint(0, 0, 0);
  renderer->AutomaticLightCreationOff();
  renderer->AddLight(light);
}

}  // namespace

void draw(const View& view, const std::string& png_path) {
  check(view);
  const Frame frame = frame_of(view);
  const Layout layout = lay_out(view, frame);
  Offscreen target(layout.width, layout.height);
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(1, 1, 1);
  target.window()->AddRenderer(renderer);
  const auto table = colour_table(view.diverging, colour_range(view));
  place_camera(renderer, frame, layout);
  add_light(renderer);
  for (std::size_t i = 0; i < view.layers.size(); ++i)
    for (const bool surface : {true, false})
      add_cells(renderer, view, i, surface, table, frame, layout.metres_per_pixel);
  add_titles(renderer, view.title, view.subtitle, layout.width, layout.height);
  if (!view.scalar_title.empty())
    add_colour_bar(renderer, table, view.scalar_title, layout.width, layout.bottom, layout.top - 20);
  add_axes(renderer, frame.axes.leftCols<2>());
  add_scale(renderer, layout.metres_per_pixel, layout.width);
  renderer->ResetCameraClippingRange();
  target.write(png_path);
}

}  // namespace tautline::output::render
