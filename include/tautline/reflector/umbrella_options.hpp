#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include <tautline/reflector/dish_options.hpp>

namespace tautline::reflector {

/// What the cords of a net make between two spokes (Belov 2021, Fig. 3.18).
enum class NetPattern {
  triangles,         ///< isosceles triangles
  belts,             ///< cords along the spokes and belts of tangential cords
  rectangles,        ///< belts, and columns of cords parallel to the bisector of two spokes
  right_triangles,   ///< rectangles with a diagonal each
  coarse_triangles,  ///< isosceles triangles of twice the side; rear only
};

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
  NetPattern front_pattern = NetPattern::triangles;
  std::optional<NetPattern> rear_pattern;  ///< not given: as in front
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

/// Whether a net of the pattern has the group of cords `front_<part>` or `rear_<part>`.
inline bool has_cords(const UmbrellaOptions& options, NetPattern pattern, std::string_view part) {
  if (part == "net" || part == "peripheral" || part == "end_peripheral") return true;
  if (pattern == NetPattern::triangles) {
    if (part == "rings") return options.separate_rings;
    if (part == "end_cords") return options.end_cords;
    return part != "columns";
  }
  if (part == "rings" || part == "end_cords") return true;
  if (part == "connectors") return pattern != NetPattern::belts;
  const bool columns = pattern == NetPattern::rectangles || pattern == NetPattern::right_triangles;
  return part == "columns" && columns;
}

}  // namespace tautline::reflector
