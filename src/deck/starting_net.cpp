#include <deck/starting_decks.hpp>

namespace tautline::deck {

const char* const starting_net =
    R"deck(# A saddle of crossed cables: form-finding for equal tensions, then its own weight and snow.
# All values in SI units. "tautline explain KEY" tells what a key means, e.g. "tautline explain groups.tension".
title: cable net saddle
units: SI

parameters:
  tension: 5000            # N, in every cable

model:
  nodes:                   # name: [x, y, z]; the heights of inner nodes are found by form-finding
    n10: [-2, -4, -0.75]
    n20: [0, -4, -1]
    n30: [2, -4, -0.75]
    n01: [-4, -2, 0.75]
    n11: [-2, -2, 0]
    n21: [0, -2, 0]
    n31: [2, -2, 0]
    n41: [4, -2, 0.75]
    n02: [-4, 0, 1]
    n12: [-2, 0, 0]
    n22: [0, 0, 0]
    n32: [2, 0, 0]
    n42: [4, 0, 1]
    n03: [-4, 2, 0.75]
    n13: [-2, 2, 0]
    n23: [0, 2, 0]
    n33: [2, 2, 0]
    n43: [4, 2, 0.75]
    n14: [-2, 4, -0.75]
    n24: [0, 4, -1]
    n34: [2, 4, -0.75]
  elements:                # group: pairs of node names
    along:
      [[n01, n11], [n11, n21], [n21, n31], [n31, n41],
       [n02, n12], [n12, n22], [n22, n32], [n32, n42],
       [n03, n13], [n13, n23], [n23, n33], [n33, n43]]
    across:
      [[n10, n11], [n11, n12], [n12, n13], [n13, n14],
       [n20, n21], [n21, n22], [n22, n23], [n23, n24],
       [n30, n31], [n31, n32], [n32, n33], [n33, n34]]

materials:
  steel: {young_modulus: 1.6e11, density: 7850}

sections:
  rope: {kind: cable, material: steel, diameter: 0.012}

groups:
  along:  {section: rope, tension: "${tension}"}
  across: {section: rope, tension: "${tension}"}
  edge:   {nodes: [n10, n20, n30, n01, n41, n02, n42, n03, n43, n14, n24, n34]}
  inner:  {nodes: [n11, n21, n31, n12, n22, n32, n13, n23, n33]}

supports:
  - {name: edge, on: [edge], fix: pinned}

loads:
  - {name: weight, acceleration: [0, 0, -9.81]}
  - {name: snow, on: [inner], force: [0, 0, -300]}   # N on each node

steps:
  - kind: form_finding
  - kind: equilibrium
    name: weight and snow
  - kind: modal
    modes: 4
)deck";

}  // namespace tautline::deck
