#pragma once
/// @file
/// PNG pictures without a display: three-dimensional views and charts. Drawn by a plugin that holds VTK's
/// renderer and is loaded on first use.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <tautline/output/fields.hpp>

namespace tautline::output {

/// A coloured layer of a view: lines or triangles of a grid, coloured by a scalar or one plain colour.
struct ViewLayer {
  Points points;  ///< positions to draw [m]
  std::vector<std::array<int, 2>> lines;
  std::vector<std::array<int, 3>> triangles;
  std::vector<double> cell_scalars;   ///< for each cell (lines, then triangles), NaN is grey; or empty
  std::vector<double> point_scalars;  ///< for each point, NaN is grey; or empty
  Vec3 colour{0.35, 0.35, 0.38};      ///< where no scalars are given
  double line_width = 1.5;            ///< pixels
  double opacity = 1.0;
};

struct View {
  std::string title;
  std::string subtitle;  ///< a line of figures below the title
  std::vector<ViewLayer> layers;
  std::string scalar_title;  ///< of the colour bar, with unit, e.g. "deviation [mm]"; empty: no bar
  std::optional<std::array<double, 2>> range;  ///< of the colours; default: of all scalars
  bool diverging = false;  ///< blue-white-red about zero (symmetric range) instead of a sequential map
  Vec3 direction{-0.55, -1.0, 0.45};  ///< from the centre towards the camera
  Vec3 up{0, 0, 1};
  int width = 1400, height = 1000;  ///< pixels at most: flat or slender gives less high or less wide
};

struct Curve {
  std::string label;
  std::vector<double> x, y;
  bool markers = true;
  bool line = true;  ///< between the points
};

struct Chart {
  std::string title, x_label, y_label;
  std::vector<Curve> curves;
  bool log_x = false, log_y = false;
  int width = 1000, height = 700;
};

/// @throws LibraryError if the renderer cannot be loaded or the file cannot be written, with the remedy
void draw(const View& view, const std::string& png_path);
void draw(const Chart& chart, const std::string& png_path);

}  // namespace tautline::output
