#pragma once
#include <tautline/reflector/triangular_net_options.hpp>

namespace tautline::reflector {

/// Parameters of the reflector whose nets hang on struts that cords hold inside one rim.
struct TensegrityRimOptions : TriangularNetOptions {
  double rim_offset = 0;         ///< the rim's radius less that of the strut ends [m]
  double middle_link = 1. / 3.;  ///< length of a strut's middle link over that of the strut [-]
  double cord_reach = 1;         ///< a cord goes to the rim node so many struts further, in halves [-]
  bool knee_cords = true;        ///< cords also from where the links of a strut meet
  double held_strut = 180;       ///< azimuth of the strut in selection `held_strut` [degree]
};

}  // namespace tautline::reflector
