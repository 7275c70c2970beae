#include <deck/starting_decks.hpp>

namespace tautline::deck {

const char* const starting_frame =
    R"deck(# A cantilever of beams with a load at its tip, and its natural frequencies.
# All values in SI units. "tautline explain KEY" tells what a key means, e.g. "tautline explain sections.tube".
title: cantilever
units: SI

parameters:
  load: -100               # N, at the tip

model:
  nodes:                   # name: [x, y, z]
    root: [0, 0, 0]
    middle: [1, 0, 0]
    tip: [2, 0, 0]
  elements:                # group: pairs of node names
    boom: [[root, middle], [middle, tip]]

materials:
  aluminium: {young_modulus: 7.0e10, poisson_ratio: 0.33, density: 2700}

sections:
  tube: {kind: tube, material: aluminium, diameter: 0.05, thickness: 0.002}

groups:
  boom:   {section: tube, orientation: [0, 0, 1]}   # local axis 3 lies in the plane of the beam and this vector
  clamp:  {nodes: [root]}
  loaded: {nodes: [tip]}

supports:
  - {name: clamp, on: [clamp], fix: all}

loads:
  - {name: tip load, on: [loaded], force: [0, 0, "${load}"]}

steps:
  - kind: mesh
    subdivisions: 4        # finite elements for each beam
  - kind: equilibrium
    loads: [tip load]
  - kind: modal
    modes: 6
)deck";

}  // namespace tautline::deck
