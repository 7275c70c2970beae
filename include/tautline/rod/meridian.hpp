#pragma once
/// @file
/// The meridian Y = F(X) of the surface wanted. Theory: docs/theory/rod.md

#include <functional>
#include <string>
#include <vector>

#include <tautline/rod/rod_options.hpp>

namespace tautline::rod {

/// F, F' and F'' at one X.
struct Jet {
  double value = 0, slope = 0, curvature = 0;  ///< [m], [-], [1/m]
};

/// A curve over X. A value: copies share what they were made of.
class Meridian {
 public:
  using Function = std::function<Jet(double)>;

  /// Any F with its derivatives. `breaks`: where F'' jumps, rising.
  explicit Meridian(Function f, std::vector<double> breaks = {});
  /// Y = coefficient X^2.
  static Meridian parabola(double coefficient);
  /// Y as a formula of X. @throws ModelError if it cannot be read
  static Meridian expression(const std::string& text);
  /// Cubics through the points, monotone between them (Hyman 1983), straight beyond them.
  /// @throws ModelError unless two or more points with rising x are given
  static Meridian table(std::vector<double> x, std::vector<double> y);
  /// @throws ModelError as table
  static Meridian make(const MeridianOptions& options);

  Jet at(double x) const { return f_(x); }
  /// Angle of the tangent to X [rad].
  double angle(double x) const;
  /// Length of the curve from x1 to x2, negative backwards [m].
  double arc_length(double x1, double x2) const;
  /// The X at which `length` has been gone along the curve from x1 [m].
  double advance(double x1, double length) const;
  /// X of the point of the curve nearest to a point near it [m].
  double foot(double x, double y) const;
  /// Distance of a point near the curve from it, positive above (towards +Y) [m].
  double distance(double x, double y) const;

 private:
  Function f_;
  std::vector<double> breaks_;
};

}  // namespace tautline::rod
