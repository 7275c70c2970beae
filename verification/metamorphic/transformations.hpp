#pragma once
/// @file
/// Changes of a deck whose effect on every number is known.

#include "outcome.hpp"
#include "random.hpp"

namespace tautline::metamorphic {

/// x -> turn x + shift; with a determinant of -1 a mirror image.
struct Motion {
  Mat3 turn = Mat3::Identity();
  Vec3 shift = Vec3::Zero();
};

/// Numbers of the new units for one of the old.
struct Units {
  double length = 1, force = 1, mass = 1;
  double time() const;
  /// Factor of a unit such as "N/m^2".
  double factor(const std::string& unit) const;
};

/// The whole deck turned, mirrored, shifted: structure, supports, loads.
Json moved(const Json& deck, const Motion& motion);
Outcome moved(const Outcome& outcome, const Motion& motion);

/// The same deck with numbers in other units.
Json in_units(const Json& deck, const Units& units);
Outcome in_units(const Outcome& outcome, const Units& units);

/// Nodes, elements, groups, supports and loads in another order.
Json shuffled(const Json& deck, Random& random);

/// Some elements the other way round; `pressed` facets stay, as their order says where pressure pushes.
Json reversed(const Json& deck, Random& random);

/// The nodes of one element the other way round.
Json reversed_nodes(const Json& element);

}  // namespace tautline::metamorphic
