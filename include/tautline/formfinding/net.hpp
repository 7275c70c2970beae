#pragma once
/// @file
/// A cable net as stage 1 sees it: branches between nodes, some of them fixed, some led by guides or a
/// surface.

#include <array>
#include <tautline/core/types.hpp>
#include <tautline/formfinding/guide_options.hpp>
#include <vector>

namespace tautline::formfinding {

/// A free node that slides without friction along a line or in a plane.
struct Guide {
  using Kind = GuideKind;
  int node = -1;
  Kind kind = Kind::line;
  Vec3 point = Vec3::Zero();       ///< any point of the line or plane [m]
  Vec3 direction = Vec3::UnitX();  ///< along the line, or normal to the plane; any length but zero
};

struct Net {
  Points nodes;                              ///< coordinates; those of free nodes are a start only [m]
  std::vector<std::array<int, 2>> branches;  ///< node indices
  std::vector<bool> fixed;                   ///< one for each node
  Points load;                               ///< external nodal loads [N]; empty means none
  std::vector<bool> on_surface = {};  ///< free nodes that lie on the surface, if there is one; empty: all
  std::vector<Guide> guides = {};     ///< at most one for each free node; not together with a surface
};

/// The surface free nodes are bound to: vertical ties hold them there, so that x and y follow from
/// equilibrium.
class Surface {
 public:
  virtual ~Surface() = default;
  /// Height z and slopes (z, dz/dx, dz/dy) at (x, y). Outside its domain it throws ModelError.
  virtual Vec3 height_and_slope(double x, double y) const = 0;
};

/// z = height + slope_x x + slope_y y
class PlaneSurface : public Surface {
 public:
  PlaneSurface(double height, double slope_x, double slope_y)
      : height_(height), slope_x_(slope_x), slope_y_(slope_y) {}
  Vec3 height_and_slope(double x, double y) const override {
    return {height_ + slope_x_ * x + slope_y_ * y, slope_x_, slope_y_};
  }

 private:
  double height_, slope_x_, slope_y_;
};

/// z = height + ((x - centre_x)^2 + (y - centre_y)^2) / (4 F); F may be negative.
class ParaboloidSurface : public Surface {
 public:
  /// @param[in] focal_length  F [m], not zero
  ParaboloidSurface(double height, double centre_x, double centre_y, double focal_length)
      : height_(height), x_(centre_x), y_(centre_y), focal_length_(focal_length) {}
  Vec3 height_and_slope(double x, double y) const override {
    const double u = x - x_, v = y - y_;
    return {height_ + (u * u + v * v) / (4 * focal_length_), u / (2 * focal_length_),
            v / (2 * focal_length_)};
  }

 private:
  double height_, x_, y_, focal_length_;
};

/// @brief Heights given on a rectangular grid, joined by cubic Hermite patches whose slopes are those of the
/// parabola through three neighbouring grid points.
///
/// Heights and slopes are continuous, which Newton's method needs; heights of degree two in x and y are
/// reproduced exactly.
class TableSurface : public Surface {
 public:
  /// @param[in] x, y    grid lines, at least two each, increasing [m]
  /// @param[in] height  rows = x, columns = y [m]
  /// @throws ModelError if the table makes no sense
  TableSurface(std::vector<double> x, std::vector<double> y, MatX height);
  /// @throws ModelError outside the grid
  Vec3 height_and_slope(double x, double y) const override;

 private:
  std::vector<double> x_, y_;
  MatX height_;
};

}  // namespace tautline::formfinding
