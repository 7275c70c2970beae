#pragma once
/// @file
/// Tensions, force densities and stiffnesses of elastic nets and films in a given shape.

#include <formfinding/net_system.hpp>
#include <tautline/formfinding/elastic_net.hpp>

namespace tautline::formfinding {

/// @throws ModelError unless sizes, stiffnesses and lengths make sense
void check(const ElasticNet& net);

/// Whether the branch has neither a tension nor a force density of its own.
bool is_elastic(const ElasticNet& net, int branch);

/// Tension of a branch of this length, and its derivative by the length.
struct BranchForce {
  double tension = 0;    ///< [N]
  double stiffness = 0;  ///< dT/dL [N/m]
  bool slack = false;
};
BranchForce branch_force(const ElasticNet& net, int branch, double length);

/// Force on every node: loads, cables and films [N], and the largest tension.
struct NetForces {
  Coordinates force;
  VecX tension;
  double scale = 0;  ///< largest tension, film force or load [N]
};
NetForces net_forces(const ElasticNet& net, const Coordinates& nodes);

/// Sum of the stiffnesses that meet at each node, an upper bound of its own [N/m].
VecX nodal_stiffness(const ElasticNet& net, const Coordinates& nodes);

}  // namespace tautline::formfinding
