#include <deck/reflector_names.hpp>

namespace tautline::deck {

namespace {

ReflectorNames names_of(const reflector::TensegrityRimOptions& options) {
  ReflectorNames names;
  for (const char* cables : {"front_net", "rear_net", "ties", "end_cords", "knee_cords"})
    names.groups[cables] = Member::cable;
  for (const char* beams : {"rim", "end_links", "middle_links"}) names.groups[beams] = Member::beam;
  names.groups["cloth"] = Member::membrane;
  if (!options.knee_cords) names.optional_groups = {"knee_cords"};
  names.selections = {"held_strut",     "front_net_nodes", "rear_net_nodes", "front_rim_nodes",
                      "rear_rim_nodes", "knees",           "rim_nodes"};
  names.numbered = "strut_";
  names.n_numbered = 6 * options.rings;
  return names;
}

ReflectorNames names_of(const reflector::YUmbrellaOptions& options) {
  ReflectorNames names;
  for (const std::string side : {"front_", "rear_"})
    for (const char* cables : {"radials", "tangentials", "ring", "outer", "braces"})
      names.groups[side + cables] = Member::cable;
  for (const char* cables : {"ties", "middle_ties", "tip_cords", "fork_cords", "front_edge"})
    names.groups[cables] = Member::cable;
  for (const char* beams : {"stems", "branches", "ends", "shaping_beams", "extensions"})
    names.groups[beams] = Member::beam;
  if (!(options.tip_radius < options.aperture / 2)) names.optional_groups = {"front_edge", "extensions"};
  names.selections = {"hub_nodes", "tips", "front_net_nodes", "rear_net_nodes", "front_surface"};
  names.numbered = "spoke_";
  names.n_numbered = options.spokes;
  return names;
}

}  // namespace

std::optional<ReflectorNames> names_of_reflector(const Deck& deck) {
  if (const auto* rim = deck.tensegrity_rim()) return names_of(*rim);
  if (const auto* umbrella = deck.y_umbrella()) return names_of(*umbrella);
  return {};
}

}  // namespace tautline::deck
