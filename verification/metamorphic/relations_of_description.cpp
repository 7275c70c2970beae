/// @file
/// The same structure, told otherwise: in another place, other units, another order.

#include "relation.hpp"
#include "structures.hpp"
#include "transformations.hpp"

namespace tautline::metamorphic {

namespace {

std::optional<Trial> rigid_motion(const Json& deck, Random& random) {
  const double size = size_of(deck);
  const Motion motion{random.rotation(), Vec3(3 * size * random.direction())};
  return pair(
      deck, moved(deck, motion), [motion](const Outcome& o) { return moved(o, motion); }, usual_tolerance);
}

/// About a plane of any direction, or one of the coordinate planes.
std::optional<Trial> mirror_image(const Json& deck, Random& random) {
  const Vec3 normal = random.chance(0.5) ? Vec3(Vec3::Unit(random.whole(0, 2))) : random.direction();
  const Motion motion{Mat3::Identity() - 2 * normal * normal.transpose(),
                      Vec3(size_of(deck) * random.direction())};
  return pair(
      deck, moved(deck, motion), [motion](const Outcome& o) { return moved(o, motion); }, usual_tolerance);
}

std::optional<Trial> permutation(const Json& deck, Random& random) {
  return pair(deck, shuffled(deck, random), unchanged, usual_tolerance);
}

/// Millimetres, millinewtons and grams, or the other way, or any other units; seconds follow.
std::optional<Trial> units(const Json& deck, Random& random) {
  std::vector<Units> choices{
      {1e3, 1e3, 1e3},
      {1e-3, 1e-3, 1e-3},
      {random.magnitude(0.01, 100), random.magnitude(0.01, 100), random.magnitude(0.01, 100)}};
  const Units u = random.one_of(choices);
  return pair(
      deck, in_units(deck, u), [u](const Outcome& o) { return in_units(o, u); }, usual_tolerance);
}

std::optional<Trial> reversed_elements(const Json& deck, Random& random) {
  return pair(deck, reversed(deck, random), unchanged, usual_tolerance);
}

}  // namespace

std::vector<Relation> relations_of_description() {
  const std::string exact = "1e-6 of the largest: only rounding differs";
  return {
      {"rigid_motion",
       "The structure, its supports and its loads turned and shifted: every result is turned.", exact,
       any_structure, rigid_motion},
      {"mirror_image",
       "The structure mirrored about any plane: forces and displacements are mirrored, moments as axial "
       "vectors.",
       exact, any_structure, mirror_image},
      {"permutation", "Nodes, elements, groups, supports and loads in another order: nothing changes.", exact,
       any_structure, permutation},
      {"units", "m, N, kg written as mm, mN, g or any other units: numbers change by powers of the units.",
       exact, any_structure_or_reflector, units},
      {"reversed_elements",
       "Elements with their nodes the other way round: nothing changes but signs that belong to local axes.",
       exact, any_structure, reversed_elements},
  };
}

}  // namespace tautline::metamorphic
