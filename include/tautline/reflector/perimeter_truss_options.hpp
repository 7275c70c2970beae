#pragma once
#include <limits>
#include <tautline/reflector/dish_options.hpp>

namespace tautline::reflector {

/// Parameters of the perimeter-truss (rim) reflector; NaN where a default depends on other values.
struct PerimeterTrussOptions : DishOptions {
  int rings = 10;  ///< rings of the triangular net; the rim has 6 rings nodes
  /// z of the front rim's plane [m]; NaN: the highest point of the surface over the rim, so that every tie
  /// pulls
  double rim_height = std::numeric_limits<double>::quiet_NaN();
  int struts = 0;           ///< evenly spread; divides 6 rings; 0: one for each second rim node
  double held_strut = 180;  ///< azimuth of the strut in selection `held_strut` [degree]
  bool diagonals = true;    ///< crossed cords in every bay between struts
};

}  // namespace tautline::reflector
