#pragma once
/// @file
/// Tensions, force densities and stiffnesses of elastic nets and films in a given shape.

#include <formfinding/net_system.hpp>
#include <tautline/formfinding/elastic_net.hpp>

namespace tautline::formfinding {

/// @throws ModelError unless sizes, stiffnesses and lengths make sense
void check(const ElasticNet& net);

/// Tension of a branch of this length, and its derivative by the length.
struct BranchForce {
  double tension = 0;    ///< [N]
  double stiffness = 0;  ///< dT/dL [N/m]
  bool slack = false;
};
BranchForce branch_force(const ElasticNet& net, int branch, double length);

/// cot of the angles at the three corners of a triangle.
Vec3 cotangents(const Vec3& a, const Vec3& b, const Vec3& c);

/// Force on every node: loads, cables and films [N], and the largest tension.
struct NetForces {
  Coordinates force;
  VecX tension;
  double scale = 0;  ///< largest tension, film force or load [N]
};
NetForces net_forces(const ElasticNet& net, const Coordinates& nodes);

/// @brief Where the nodes of films count as out of balance.
///
/// Moving an inner node along the film, or an edge node along its edge cable of constant tension, changes
/// areas and lengths only as much as the mesh deviates from the smooth film: equilibrium there is rounding of
/// the mesh, or none at all. The place along film and edge is the mesh's choice.
struct FilmDirections {
  Coordinates normal;   ///< of the film at nodes that only triangles meet; zero elsewhere
  Coordinates tangent;  ///< of the edge at nodes between two cables of one constant tension; zero elsewhere
};
FilmDirections film_directions(const ElasticNet& net, const Coordinates& nodes);

/// Keeps of the force on each free node the component along its normal, or across its tangent.
void keep_what_counts(const FilmDirections& directions, const std::vector<int>& free_nodes,
                      Coordinates& force);

/// Sum of the stiffnesses that meet at each node, an upper bound of its own [N/m].
VecX nodal_stiffness(const ElasticNet& net, const Coordinates& nodes);

}  // namespace tautline::formfinding
