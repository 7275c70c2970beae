#pragma once
#include <limits>
#include <tautline/reflector/dish_options.hpp>

namespace tautline::reflector {

/// Parameters of the umbrella whose spokes branch far inside, and whose net is cords within and rigid beams
/// at the periphery.
struct YUmbrellaOptions : DishOptions {
  int spokes = 12;         ///< evenly spread, the first towards +x
  int rings = 6;           ///< rings of tangential cords between the hub and the power ring
  int parts = 4;           ///< parts of power ring and outer cord between two spokes
  int beam_parts = 4;      ///< straight parts of a shaping beam, even: a tie holds its middle
  double hub_radius = 0;   ///< where spokes and main radial cords are attached [m]
  double fork_radius = 0;  ///< where the stem of a spoke branches [m]
  double ring_radius = 0;  ///< of the power ring on the spokes [m]
  /// Of the outer cord and the tips [m]; NaN: aperture/2. If less, beams and spokes go on to aperture/2.
  double tip_radius = std::numeric_limits<double>::quiet_NaN();
  double ring_sag = 0.03;        ///< of the power ring, inwards between two spokes, over its span in plan [-]
  double rear_ring_sag = 0.02;   ///< of the rear ring over its span, towards the beams' outer ends [-]
  double rear_outer_sag = 0.05;  ///< of the rear outer cord over its span, towards the beams' inner ends [-]
};

}  // namespace tautline::reflector
