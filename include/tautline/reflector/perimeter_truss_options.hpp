#pragma once
#include <tautline/reflector/triangular_net_options.hpp>

namespace tautline::reflector {

/// Parameters of the perimeter-truss (rim) reflector; NaN where a default depends on other values.
struct PerimeterTrussOptions : TriangularNetOptions {
  int struts = 0;           ///< evenly spread; divides 6 rings; 0: one for each second rim node
  double held_strut = 180;  ///< azimuth of the strut in selection `held_strut` [degree]
  bool diagonals = true;    ///< crossed cords in every bay between struts
};

}  // namespace tautline::reflector
