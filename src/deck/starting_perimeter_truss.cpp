#include <deck/starting_decks.hpp>

namespace tautline::deck {

const char* const starting_perimeter_truss =
    R"deck(# A perimeter-truss mesh reflector: two nets joined by ties, between two rims that struts hold apart.
# All values in SI units. "tautline explain KEY" tells what a key means, e.g. "tautline explain reflector.gap".
title: perimeter-truss reflector
units: SI

parameters:                # ${name} stands for the value; --set parameters.name=value changes it
  subdivisions: 2          # parts of each facet side

reflector:
  kind: perimeter-truss
  aperture: 6.0            # m
  focal_length: 4.0        # m
  clearance: 0.6           # m, parent axis to the near edge; without it the dish is axisymmetric
  rings: 6                 # rings of triangles; the rim has 6 x rings = 36 nodes
  gap: 0.02                # m, extra distance between the nets
  struts: 18               # a divisor of 6 x rings
  held_strut: 180          # degree, azimuth of the strut that is held
  evaluation_radius: 2.5   # m, the surface error is taken inside
  frequency: 12.0e9        # Hz, for the gain loss; 0: none

materials:
  carbon: {young_modulus: 1.5e11, poisson_ratio: 0.3, density: 1600}

sections:
  rim:   {kind: tube, material: carbon, diameter: 0.03, thickness: 0.001}
  strut: {kind: tube, material: carbon, diameter: 0.02, thickness: 0.001}
  cord:  {kind: cable, axial_stiffness: 30000, mass_per_length: 0.001}
  cloth: {kind: membrane, tension_stiffness: 130, poisson_ratio: 0.3, mass_per_area: 0.010}

groups:                    # every group of the reflector with its section
  front_net:  {section: cord, tension: 10}    # N
  rear_net:   {section: cord, tension: 10}
  ties:       {section: cord}                 # form-finding finds their tension
  diagonals:  {section: cord, tension: 20}
  front_rim:  {section: rim}
  rear_rim:   {section: rim}
  struts:     {section: strut}
  cloth:      {section: cloth, prestress: 2}  # N/m

supports:
  - {name: held strut, on: [held_strut], fix: all}

steps:                     # each step goes on from the state the one before left
  - kind: form_finding     # shape of the net from its tensions
  - kind: mesh
    subdivisions: "${subdivisions}"
  - kind: equilibrium
    stages:                # first the frame is held, then only one strut
      - {name: frame held, hold: [front_rim, rear_rim, struts]}
      - {name: one strut held}
  - kind: tuning           # shortens ties until the surface is as good as it gets
  - kind: modal
    modes: 6

output: {fields: true, tables: true, pictures: true, report: true}
)deck";

}  // namespace tautline::deck
