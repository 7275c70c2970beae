#pragma once
/// @file
/// Parametric perimeter-truss reflector: nets, ties, rims, struts, cords and cloth as a model::Model whose
/// nodes wait for form-finding. Theory: docs/theory/reflector.md

#include <tautline/model/model.hpp>
#include <tautline/reflector/paraboloid.hpp>
#include <tautline/reflector/perimeter_truss_options.hpp>

namespace tautline::reflector {

/// @brief Nodes, elements, groups (without sections) and selections.
///
/// Element groups: front_net, rear_net, ties, diagonals (cables); front_rim, rear_rim, struts (beams); cloth
/// (membranes). Selections: held_strut (its beam), front_net_nodes, rear_net_nodes (free nodes of the nets),
/// front_rim_nodes, rear_rim_nodes, strut_<k> (its beam; k = 0 at +x, counter-clockwise). Cable k of
/// front_net and rear_net are each other's mirror; tie k joins front node k (first) and its mirror (second);
/// struts run from front to rear. Front net nodes come first, in the order centre, ring 1, ring 2, ... each
/// from +x counter-clockwise, the rim last; the rear net follows in the same order. Nodes start at equal
/// spacing of the hexagonal lattice drawn out to circles, front ones on the surface; rear nodes are mirrored,
/// z -> -z - gap. Cloth facets turn their normals to +z. Beam frames are left to whoever knows
/// Group::orientation.
/// @throws ModelError with the reason where the parameters make no dish.
model::Model make_perimeter_truss(const PerimeterTrussOptions& options);

}  // namespace tautline::reflector
