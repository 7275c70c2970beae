#pragma once
/// @file
/// Parametric umbrella with Y-shaped spokes and rigid shaping beams at the periphery as a model::Model.
/// Theory: docs/theory/large_reflectors.md

#include <tautline/model/model.hpp>
#include <tautline/reflector/paraboloid.hpp>
#include <tautline/reflector/y_umbrella_options.hpp>

namespace tautline::reflector {

/// @brief Nodes, elements, groups (without sections) and selections.
///
/// Cable groups: front_radials, front_tangentials, front_ring, front_outer and the same of the rear; ties
/// (along z, front to rear, of radials and tangentials), front_braces (from a beam's ends to the crossing of
/// its X, the inner end first) and rear_braces (from the crossing to rear outer cord and rear ring),
/// middle_ties (from a beam's middle to the crossing), tip_cords (front to rear tip), fork_cords (spoke to
/// spoke); where the beams go on beyond the outer cord, front_edge joins their ends. Beams: stems, branches
/// (from fork to power ring), ends (from there to the tips), shaping_beams, and extensions beyond the outer
/// cord. No cloth.
///
/// Selections: spoke_<k> (its beams), hub_nodes, tips, front_net_nodes (nodes of the front net that no spoke
/// holds), rear_net_nodes, front_surface (the cords and beams that are the reflecting surface). All of them
/// begin at spoke 0 towards +x and go counter-clockwise.
/// @throws ModelError with the reason where the parameters make no umbrella.
model::Model make_y_umbrella(const YUmbrellaOptions& options);

}  // namespace tautline::reflector
