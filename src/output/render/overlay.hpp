#pragma once
/// @file
/// What lies over a picture: texts, colour bar, axes and scale. Positions and sizes in pixels of the final
/// picture, origin at the lower left.

#include <array>
#include <string>
#include <vector>

#include <vtkLookupTable.h>
#include <vtkRenderer.h>

#include <tautline/core/types.hpp>

namespace tautline::output::render {

enum class Align { left, centre, right };

struct TextStyle {
  int size = 18;
  bool bold = false;
  Align horizontal = Align::left;
  Align vertical = Align::left;  ///< left: bottom; right: top
  double rotation = 0;           ///< degrees
  double max_width = 0;          ///< the size shrinks until the text is no longer; 0: no limit
  std::array<double, 3> colour{0.13, 0.14, 0.16};
};

/// The renderer's window must be set.
void add_text(vtkRenderer* renderer, const std::string& text, double x, double y, const TextStyle& style);

/// Title and subtitle at the upper left.
void add_titles(vtkRenderer* renderer, const std::string& title, const std::string& subtitle, int width,
                int height);
/// Height that they take.
double titles_height(const std::string& title, const std::string& subtitle);

struct LegendEntry {
  std::string label;
  std::array<double, 3> colour;
};

/// Labels beside lines of their colours, in rows between `left` and `right` below `top`. @return their height
double add_legend(vtkRenderer* renderer, const std::vector<LegendEntry>& entries, double left, double right,
                  double top);

/// Vertical colour bar at the right edge of a picture of `width`, from `bottom` to `top`.
void add_colour_bar(vtkRenderer* renderer, vtkLookupTable* table, const std::string& title, int width,
                    double bottom, double top);
/// Width to keep free for it.
double colour_bar_width();

/// The global axes as seen in the picture; columns of `screen_axes` are screen right and screen up in global
/// axes.
void add_axes(vtkRenderer* renderer, const Mat<3, 2>& screen_axes);

/// A line of round length beside the axes.
void add_scale(vtkRenderer* renderer, double metres_per_pixel, int width);

}  // namespace tautline::output::render
