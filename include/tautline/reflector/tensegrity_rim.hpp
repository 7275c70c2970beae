#pragma once
/// @file
/// Parametric reflector with one rim and struts of three links: nets, ties, struts, cords and cloth as a
/// model::Model whose nodes wait for form-finding. Theory: docs/theory/large_reflectors.md

#include <tautline/model/model.hpp>
#include <tautline/reflector/paraboloid.hpp>
#include <tautline/reflector/tensegrity_rim_options.hpp>

namespace tautline::reflector {

/// @brief Nodes, elements, groups (without sections) and selections.
///
/// A strut stands at every node of the nets' circle, from the front net to its mirror, and is joined to the
/// rim by cords alone: from each of its ends and, with knee_cords, from each end of its middle link to two
/// nodes of the rim.
///
/// Element groups: front_net, rear_net, ties, end_cords, knee_cords (cables); rim, end_links, middle_links
/// (beams); cloth (membranes). Selections: strut_<k> (its beams: front, middle, rear link; k = 0 at +x,
/// counter-clockwise), held_strut, front_net_nodes, rear_net_nodes (free nodes of the nets), front_rim_nodes,
/// rear_rim_nodes (ends of the struts), knees (front and rear ends of the middle links), rim_nodes. Nodes:
/// front net and rear net as in make_perimeter_truss, front knees, rear knees, rim, each from +x
/// counter-clockwise. Cords of strut k go two and two, front before rear, to the rim node before it and to
/// that behind.
/// @throws ModelError with the reason where the parameters make no dish.
model::Model make_tensegrity_rim(const TensegrityRimOptions& options);

}  // namespace tautline::reflector
