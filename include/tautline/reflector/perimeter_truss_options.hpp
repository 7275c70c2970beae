#pragma once
#include <limits>

namespace tautline::reflector {

/// Parameters of the perimeter-truss (rim) reflector; NaN where a default depends on other values.
struct PerimeterTrussOptions {
  double aperture = 0;                                          ///< D [m]
  double focal_length = 0;                                      ///< F [m]
  double clearance = std::numeric_limits<double>::quiet_NaN();  ///< X_A [m]; NaN: axisymmetric dish
  int rings = 10;  ///< rings of the triangular net; the rim has 6 rings nodes
  double gap = 0;  ///< extra distance between front and rear net [m]
  /// z of the front rim's plane [m]; NaN: the highest point of the surface over the rim, so that every tie
  /// pulls
  double rim_height = std::numeric_limits<double>::quiet_NaN();
  int struts = 0;           ///< evenly spread; divides 6 rings; 0: one for each second rim node
  double held_strut = 180;  ///< azimuth of the strut in selection `held_strut` [degree]
  bool diagonals = true;    ///< crossed cords in every bay between struts
  /// surface error inside this radius [m]; NaN: all the cloth
  double evaluation_radius = std::numeric_limits<double>::quiet_NaN();
  double frequency = 0;  ///< for the gain loss [Hz]; 0: none
};

}  // namespace tautline::reflector
