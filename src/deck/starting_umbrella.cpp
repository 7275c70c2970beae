#include <deck/starting_decks.hpp>

namespace tautline::deck {

const char* const starting_umbrella =
    R"deck(# An umbrella mesh reflector: spokes from a hub, each ending in a fork that holds two nets joined by ties.
# All values in SI units. "tautline explain KEY" tells what a key means, e.g. "tautline explain reflector.spokes".
title: umbrella reflector
units: SI

parameters:                # ${name} stands for the value; --set parameters.name=value changes it
  subdivisions: 2          # parts of each facet side

reflector:
  kind: umbrella
  aperture: 6.0            # m
  focal_length: 3.0        # m
  clearance: 1.0           # m, parent axis to the near edge; without it the dish is axisymmetric
  surface_height: 0.08     # m, over the plane of the spokes, which mirrors front and rear net
  spokes: 6
  rings: 6                 # ring k of the net has k parts between two spokes
  hub_radius: 0.2          # m, where spokes and nets are attached
  joint_radius: 1.5        # m, where the root link ends
  apex_radius: 2.9         # m, where the fork begins
  fork_length: 1.5         # m, from there to the tips on the surface
  evaluation_radius: 3.0   # m, the surface error is taken inside
  frequency: 12.0e9        # Hz, for the gain loss; 0: none

materials:
  carbon: {young_modulus: 1.5e11, poisson_ratio: 0.3, density: 1600}
  cord:   {young_modulus: 1.0e10, density: 1440}

sections:
  link:   {kind: tube, material: carbon, diameter: 0.06, thickness: 0.001}
  fork:   {kind: tube, material: carbon, diameter: 0.04, thickness: 0.001}
  thin:   {kind: cable, material: cord, diameter: 0.0007}
  thick:  {kind: cable, material: cord, diameter: 0.002}
  cloth:  {kind: membrane, tension_stiffness: 130, poisson_ratio: 0.3, mass_per_area: 0.024}
  hub:    {kind: mass, mass: 1.0}    # kg at the root of each spoke

groups:                    # every group of the reflector with its section
  front_net:               {section: thin, tension: 5}             # N, found by form-finding
  front_connectors:        {section: thin, force_density: 60}      # N/m, kept by form-finding
  front_end_connectors:    {section: thin, force_density: 30}
  front_peripheral:        {section: thick, force_density: 125}
  front_end_peripheral:    {section: thick, force_density: 115}
  front_crossing_a_inner:  {section: thin, force_density: 50}
  front_crossing_a_outer:  {section: thin, force_density: 15}
  front_crossing_b_inner:  {section: thin, force_density: 30}
  front_crossing_b_outer:  {section: thin, force_density: 35}
  rear_net:                {section: thin, tension: 5}             # mirror of the front
  rear_connectors:         {section: thin, force_density: 60}
  rear_end_connectors:     {section: thin, force_density: 30}
  rear_peripheral:         {section: thick, force_density: 125}
  rear_end_peripheral:     {section: thick, force_density: 115}
  rear_crossing_a_inner:   {section: thin, force_density: 50}
  rear_crossing_a_outer:   {section: thin, force_density: 15}
  rear_crossing_b_inner:   {section: thin, force_density: 30}
  rear_crossing_b_outer:   {section: thin, force_density: 35}
  ties:                    {section: thin}                         # form-finding finds their tension
  fork_cords:              {section: thick, tension: 20}           # tip to tip
  apex_cords:              {section: thick, tension: 30}           # spoke to spoke
  joint_cords:             {section: thick, tension: 30}
  root_links:              {section: link}
  intermediate_links:      {section: link}
  front_links:             {section: fork}
  rear_links:              {section: fork}
  cloth:                   {section: cloth, prestress: 1}          # N/m
  hub:                     {section: hub}

supports:
  - {name: hub, on: [hub_nodes], fix: all}

steps:                     # each step goes on from the state the one before left
  - kind: form_finding     # shape of the nets from their tensions
  - kind: mesh
    subdivisions: "${subdivisions}"
    group_subdivisions: {root_links: 4, intermediate_links: 4, front_links: 4, rear_links: 4}
  - kind: equilibrium
    stages:                # first the spokes are held, then only the hub
      - {name: spokes held, hold: [root_links, intermediate_links, front_links, rear_links]}
      - {name: hub held}
  - kind: tuning           # shortens ties until the surface is as good as it gets
  - kind: modal
    modes: 6

output: {fields: true, tables: true, pictures: true, report: true}
)deck";

}  // namespace tautline::deck
