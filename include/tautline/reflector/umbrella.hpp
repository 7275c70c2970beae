#pragma once
/// @file
/// Parametric umbrella reflector: spokes with forks, nets, ties, cords and cloth as a model::Model whose
/// nodes wait for form-finding. Theory: docs/theory/umbrella.md

#include <tautline/model/model.hpp>
#include <tautline/reflector/paraboloid.hpp>
#include <tautline/reflector/umbrella_options.hpp>

namespace tautline::reflector {

/// @brief Nodes, elements, groups (without sections) and selections.
///
/// Cable groups, each for the front and the rear (`front_...`, `rear_...`), of triangles: net (without its
/// rings, group rings, if they are separate), connectors and end_connectors (last ring to peripheral cord),
/// peripheral and end_peripheral (the parts at the tips), crossing_a_inner and crossing_a_outer (last ring to
/// tip), crossing_b_inner and crossing_b_outer (last node on a spoke line to the peripheral cord), end_cords
/// if asked for. Cords a and b cross in a node. Further cable groups: ties, fork_cords (tip to tip),
/// apex_cords and joint_cords (spoke to spoke). Beams: root_links, intermediate_links, front_links,
/// rear_links (from the apex to the tips). Masses: hub, one at each root. Membranes: cloth.
///
/// Selections: spoke_<k> (its beams; k = 0 at +x, counter-clockwise), hub_nodes (roots of the spokes and the
/// nets' nodes on the hub), front_net_nodes, rear_net_nodes (free nodes), tips.
///
/// Other patterns: net (along the spokes, diagonals), rings, columns, connectors, peripheral, end_peripheral,
/// end_cords; see has_cords.
///
/// Front nodes come first: on the spoke lines from the hub outwards, spoke by spoke; then sector by sector
/// ring by ring and its two crossing nodes; then peripheral nodes, nodes on the hub, tips. Each has a node of
/// the rear net under it. Where both nets have one pattern, cable k of a front group and of its rear group
/// are each other's mirror; ties run from front to rear. Front nodes start on the surface in equal divisions.
/// Cloth facets turn their normals to +z.
/// @throws ModelError with the reason where the parameters make no umbrella.
model::Model make_umbrella(const UmbrellaOptions& options);

}  // namespace tautline::reflector
