#pragma once
#include <vector>

#include <tautline/reflector/dish_options.hpp>

namespace tautline::reflector {

/// Parameters of the umbrella reflector: spokes from a hub, each ending in a fork that holds two nets.
struct UmbrellaOptions : DishOptions {
  int spokes = 6;           ///< evenly spread, the first towards +x
  int rings = 9;            ///< rings of the net between hub and peripheral cord
  double hub_radius = 0;    ///< where spokes and nets are attached [m]
  double joint_radius = 0;  ///< where root link and intermediate link meet [m]
  double apex_radius = 0;   ///< where the intermediate link branches into the fork [m]
  /// Length of each of the two links of a fork [m]; or, if this is 0, `tip_radius`.
  double fork_length = 0;
  /// Radius of the tips, one for all or one for each spoke [m]; empty with a fork_length.
  std::vector<double> tip_radius;
  /// Before form-finding: sag of the peripheral cord between two spokes over its span [-].
  double cord_sag = 0.09;
  /// Before form-finding: sag of the last ring between two spokes over its span; that of the others grows
  /// evenly from the hub [-]. NaN: cord_sag
  double ring_sag = std::numeric_limits<double>::quiet_NaN();
  /// Before form-finding: radius of the last ring on a spoke over that of the tip [-].
  double last_ring = 0.93;
  bool separate_rings = false;  ///< the rings are a group of their own, to have another tension
  bool end_cords = false;       ///< a cord from the last node on each spoke line to the spoke's tip
  bool paired_ties =
      false;  ///< two ties round the spoke instead of one through it, at each node over a spoke
};

}  // namespace tautline::reflector
