// A parametric reflector of any size, found, meshed, released and tuned.
#include "structures.hpp"

#include "deck.hpp"

namespace tautline::metamorphic {

Json reflector(Random& random) {
  const double aperture = random.magnitude(2, 20), focus = aperture * random.between(0.5, 0.9);
  const double net = random.between(5, 15), height = aperture / 240;
  Builder b;
  b.deck.erase("model");
  const int rings = random.whole(2, 3);
  Json dish{{"kind", "perimeter-truss"}, {"aperture", aperture},
            {"focal_length", focus},     {"rings", rings},
            {"gap", 0.02 * aperture},    {"struts", random.one_of(std::vector<int>{3, 6, 6 * rings})}};
  if (random.chance(0.5)) dish["clearance"] = aperture * random.between(0.05, 0.2);
  b.deck["reflector"] = dish;
  b.deck["materials"]["carbon"] = {{"young_modulus", 2e11}, {"poisson_ratio", 0.3}, {"density", 1600.0}};
  b.section("rim",
            {{"kind", "rectangle"}, {"material", "carbon"}, {"width", height}, {"height", 2 * height}});
  b.section("strut", {{"kind", "round"}, {"material", "carbon"}, {"diameter", height}});
  b.section("cord", {{"kind", "cable"}, {"axial_stiffness", 3e4}, {"mass_per_length", 0.0}});
  b.section(
      "mesh",
      {{"kind", "membrane"}, {"tension_stiffness", 130.0}, {"poisson_ratio", 0.3}, {"mass_per_area", 0.01}});
  b.deck["groups"] = {{"front_net", {{"section", "cord"}, {"tension", net}}},
                      {"rear_net", {{"section", "cord"}, {"tension", net}}},
                      {"ties", {{"section", "cord"}}},
                      {"diagonals", {{"section", "cord"}, {"tension", 3 * net}}},
                      {"front_rim", {{"section", "rim"}}},
                      {"rear_rim", {{"section", "rim"}}},
                      {"struts", {{"section", "strut"}}},
                      {"cloth", {{"section", "mesh"}, {"prestress", 2.0}}}};
  b.support("held_strut", "all");
  b.step({{"kind", "form_finding"}, {"initial_force_density", 10 * net / aperture}});
  b.step({{"kind", "mesh"}, {"subdivisions", random.whole(1, 2)}});
  b.step({{"kind", "equilibrium"}, {"name", "released"}});
  const bool rule = random.chance(0.5);
  Json tuning{{"kind", "tuning"}, {"max_passes", 3}, {"method", rule ? "rule" : "sensitivity"}};
  b.step(tuning);
  b.step({{"kind", "modal"}, {"modes", 2}});
  return b.deck;
}

}  // namespace tautline::metamorphic
