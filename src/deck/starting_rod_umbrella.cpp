#include <deck/starting_decks.hpp>

namespace tautline::deck {

const char* const starting_rod_umbrella =
    R"deck(# An umbrella of flexible rods without a net: cables along the parallels bend the rods to a paraboloid.
# All values in SI units. "tautline explain KEY" tells what a key means, e.g. "tautline explain rod_shaping.form".
title: rod umbrella
units: SI

reflector:                 # all of the structure: no sections, groups or supports
  kind: rod-umbrella
  rods: 24
  links: 6                 # of each rod; a cable at the end of each
  lengths: 1.0             # m; one number for all links, or a list from the root outwards
  bending_stiffness: [4000, 3600, 3000, 2400, 1600, 800]   # EI, N m2
  root_radius: 0.3         # m, of the root from the axis when it stands at the stop
  root_offset: 0.0         # m, by which it is nearer to the axis while the rod is straight
  straight_angle: 30       # degree, of the straight rods to the plane across the axis
  meridian:
    coefficient: 0.08      # 1/m: Y = coefficient X^2; or points: [[x, y], ...]
  cable:
    law: linear            # or bilinear, with knee_strain and second_slope
    strain_limit: 0.05     # what is stretched more is warned of

steps:
  - kind: rod_shaping      # which cables bring the nodes onto the surface
    name: design
    method: exact          # or cantilevers: the published model
    form: a                # lengths as given; b: nodes at their places, lengths found
  - kind: rod_shaping      # what cables of a workshop make of it
    name: built
    method: exact
    stiffness: [1470, 5600, 2900, 4200, 200, 19300]   # N, E F of each parallel
)deck";

}  // namespace tautline::deck
