#pragma once
/// @file
/// Bodies: parts of a structure that nothing joins but the ground, and their rigid motions. Theory:
/// docs/theory/free_structures.md

#include <vector>

#include <tautline/core/types.hpp>
#include <tautline/model/model.hpp>

namespace tautline::assembly {

class System;

/// Nodes of each body, in the model's order: joined by elements, links, cyclic symmetry or constraints.
std::vector<std::vector<int>> bodies_of(const model::Model& model);

/// Velocity field of a rigid motion: translation and rotation about a centre.
struct RigidMotion {
  Vec3 centre = Vec3::Zero(), translation = Vec3::Zero(), rotation = Vec3::Zero();

  Vec3 at(const Vec3& place) const { return translation + rotation.cross(place - centre); }
};

/// The six unit motions of a body about a centre: three translations, three rotations.
std::vector<RigidMotion> unit_motions(const Vec3& centre);

/// Increments of all unknowns that move the nodes of a body in such a way, held unknowns, too.
std::vector<double> unknowns_of(const System& system, const std::vector<int>& nodes,
                                const RigidMotion& motion);

/// @brief Bases of the rigid motions of each body that supports, links and constraints let happen, as
/// increments of all unknowns.
///
/// Found from geometry: of the six motions of a body those combinations that the unknowns can follow. Of a
/// body without supports all six; of a line of hinged bars five, since turning about the line moves nothing.
std::vector<std::vector<double>> rigid_motions(const System& system);

}  // namespace tautline::assembly
