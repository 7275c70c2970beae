#pragma once
#include <limits>

namespace tautline::reflector {

/// What every reflector of nets and ties has: its surface, and how that is measured.
struct DishOptions {
  double aperture = 0;                                          ///< D [m]
  double focal_length = 0;                                      ///< F [m]
  double clearance = std::numeric_limits<double>::quiet_NaN();  ///< X_A [m]; NaN: axisymmetric dish
  double surface_height = 0;  ///< the surface is raised so far above its own frame's origin [m]
  double gap = 0;             ///< the rear net is the front net mirrored, z -> -z - gap [m]
  /// surface error inside this radius [m]; NaN: all the cloth
  double evaluation_radius = std::numeric_limits<double>::quiet_NaN();
  double frequency = 0;  ///< for the gain loss [Hz]; 0: none
};

}  // namespace tautline::reflector
