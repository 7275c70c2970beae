#pragma once
/// @file
/// Balance of a film along itself, which its given stress cannot have on a mesh.

#include <formfinding/net_system.hpp>
#include <string>
#include <tautline/formfinding/elastic_net.hpp>

namespace tautline::formfinding {

struct SettledFilm {
  Points nodes;               ///< [m]
  Points stress;              ///< N11, N22, N12 of each facet in element::membrane_frame of this shape [N/m]
  VecX tension;               ///< of the branches [N]
  double out_of_balance = 0;  ///< largest force at a free node [N]
  std::string fault;          ///< of facets that have turned over; "" if none has
};

/// @brief Rest of the net and a film that has in this shape the stress asked for, and is elastic besides.
///
/// Given stresses on facets are in equilibrium across the film only; along it they leave forces that fall
/// with the square of the mesh. The film takes them up as an elastic one would whose stiffness is its own
/// stress: by small changes of the stress where that is enough, and by moving where it is not. A change of
/// the stress alone that balances the nodes exactly can be arbitrarily large: a surface of triangles has
/// motions that hardly strain it, and forces that work on these need the curvature that comes with motion.
/// Theory: docs/theory/force_density.md#films
/// @param[in] tolerance  largest force out of balance over the largest tension or film force [-]
/// @pre `net` passed check()
SettledFilm settle_film(const ElasticNet& net, const Points& nodes, double tolerance);

}  // namespace tautline::formfinding
