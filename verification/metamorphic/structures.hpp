#pragma once
/// @file
/// Random small structures, one function for each family. All have an equilibrium that is stable, and loads
/// that move them by a part of their size.

#include "deck.hpp"
#include "random.hpp"

namespace tautline::metamorphic {

Json cable_net(Random& random);  ///< prestressed cables between fixed nodes, found or drawn
Json tent(Random& random);       ///< membranes of triangles and quadrilaterals, with or without edge cables
Json frame(Random& random);      ///< beams in space of all sections, releases, offsets
Json shell(Random& random);      ///< a flat or curved patch of triangles or quadrilaterals
Json mast(Random& random);       ///< beams, guys, membranes, springs, masses, rigid links
Json truss(Random& random);      ///< a steep dome of bars
Json reflector(Random& random);  ///< a parametric one, tuned
Json pressed_column(Random& random);  ///< straight, of beams or a lattice of bars, to buckle under "press"
Json pressed_arch(Random& random);    ///< of beams, to lose its stability under "press" at its upper nodes
Json any_structure(Random& random);   ///< one of the families that are described by nodes and elements
Json any_structure_or_reflector(Random& random);

}  // namespace tautline::metamorphic
