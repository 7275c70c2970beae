#pragma once
#include <limits>
#include <tautline/reflector/dish_options.hpp>

namespace tautline::reflector {

/// Parameters of the reflectors whose two triangular nets hang on a circle.
struct TriangularNetOptions : DishOptions {
  int rings = 10;  ///< rings of the triangular net; 6 rings nodes are on the circle
  /// z of the front circle's plane [m]; NaN: the highest point of the surface over it, so that every tie
  /// pulls
  double rim_height = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace tautline::reflector
