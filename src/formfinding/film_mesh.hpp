#pragma once
/// @file
/// Where the nodes of a film lie along it, which its stress leaves open.

#include <formfinding/film_sides.hpp>
#include <tautline/formfinding/elastic_net.hpp>

namespace tautline::formfinding {

/// Branches of a net, then every side of its film once; and the force densities that they have as drawn.
struct FilmNet {
  /// @pre `of` passed check() and outlives this object
  explicit FilmNet(const ElasticNet& of);

  Eigen::Index n_cables() const { return static_cast<Eigen::Index>(elastic.net.branches.size()); }
  /// Tension of the cables over their length, and natural force densities of the film [N/m].
  VecX force_density(const Coordinates& nodes) const;

  const ElasticNet& elastic;
  FilmSides sides;
  Net net;
  std::vector<std::vector<int>> cables_at;  ///< each node
  VecX drawn;                               ///< force densities of the drawn shape [N/m]
};

/// @brief Directions in which the film's own forces do not decide where a node lies.
///
/// Moving an inner node along the film, or an edge node along its edge cable of constant tension, changes
/// areas and lengths only as much as the mesh deviates from the smooth film: equilibrium there is rounding of
/// the mesh, or none at all. Along these directions the nodes obey force densities of the drawn shape, inner
/// ones those of film and cables, edge nodes those of the cables: so they follow the edges, and keep their
/// order as far as can be.
class FilmMesh {
 public:
  FilmMesh(const FilmNet& net, const std::vector<int>& free_nodes, const Coordinates& nodes);

  /// Replaces forces on the free nodes along the open directions by those of the drawn force densities.
  void take_drawn_forces(const Coordinates& nodes, Coordinates& force) const;
  /// Replaces rows of `values` along the open directions by those of `other`.
  void take(const Coordinates& other, Coordinates& values) const;

 private:
  const FilmNet& net_;
  const std::vector<int>& free_nodes_;
  std::vector<Mat3> open_;  ///< projection on the open directions, of each free node
};

}  // namespace tautline::formfinding
