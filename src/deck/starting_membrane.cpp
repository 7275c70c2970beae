#include <deck/starting_decks.hpp>

namespace tautline::deck {

const char* const starting_membrane =
    R"deck(# A small square sail: a prestressed membrane with edge cables between four corners at different heights.
# All values in SI units. "tautline explain KEY" tells what a key means, e.g. "tautline explain groups.prestress".
title: four-point sail
units: SI

model:
  nodes:                   # name: [x, y, z]
    southwest: [0, 0, 0]
    southeast: [4, 0, 1]
    northeast: [4, 4, 0]
    northwest: [0, 4, 1]
    south: [2, 0.2, 0.5]   # edges curve inwards
    east: [3.8, 2, 0.5]
    north: [2, 3.8, 0.5]
    west: [0.2, 2, 0.5]
    centre: [2, 2, 0.5]
  elements:                # group: lists of node names; 3 for a membrane, 2 for a cable
    sail:
      - [southwest, south, centre]
      - [south, southeast, centre]
      - [southeast, east, centre]
      - [east, northeast, centre]
      - [northeast, north, centre]
      - [north, northwest, centre]
      - [northwest, west, centre]
      - [west, southwest, centre]
    edges:
      - [southwest, south]
      - [south, southeast]
      - [southeast, east]
      - [east, northeast]
      - [northeast, north]
      - [north, northwest]
      - [northwest, west]
      - [west, southwest]

materials:
  steel: {young_modulus: 1.6e11, density: 7850}

sections:
  cloth: {kind: membrane, tension_stiffness: 4.0e5, poisson_ratio: 0.3, mass_per_area: 0.9}
  rope:  {kind: cable, material: steel, diameter: 0.010}

groups:
  sail:    {section: cloth, prestress: 1000}   # N/m
  edges:   {section: rope, tension: 8000}      # N
  corners: {nodes: [southwest, southeast, northeast, northwest]}

supports:
  - {name: corners, on: [corners], fix: pinned}

loads:
  - {name: weight, acceleration: [0, 0, -9.81]}

steps:
  - kind: mesh
    subdivisions: 4        # parts of each facet side and of the cables along it
  - kind: equilibrium
  - kind: modal
    modes: 4
)deck";

}  // namespace tautline::deck
