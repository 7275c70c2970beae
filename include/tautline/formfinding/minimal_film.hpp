#pragma once
/// @file
/// Soap films of triangles with the same stress in all directions, edged and crossed by cables: tents.

#include <array>
#include <functional>
#include <string>
#include <tautline/formfinding/minimal_film_options.hpp>
#include <tautline/formfinding/net.hpp>
#include <vector>

namespace tautline::formfinding {

/// The film, with cables as the branches of `net`.
struct Film {
  Net net;  ///< its nodes are the start: the triangles there must have areas
  std::vector<std::array<int, 3>> triangles;
  VecX surface_stress;       ///< of every triangle [N/m], positive
  VecX cable_tension;        ///< of every branch [N]; NaN: it has a force density
  VecX cable_force_density;  ///< of every branch [N/m]; used where the tension is NaN; may be empty
};

struct FilmResult {
  bool converged = false;
  std::string reason;  ///< one sentence with both sides of the inequality
  Points nodes;        ///< [m]
  VecX cable_tension;  ///< [N]
  double area = 0;     ///< of all triangles [m^2]
  /// If converged, of the side opposite to each corner of every triangle [N/m]: with the smallest changes of
  /// stress that balance the nodes along the film, too.
  Points side_force_density;
  double out_of_balance = 0;  ///< [N]
  int iterations = 0;
  std::vector<double>
      residual;  ///< largest force out of balance before the first and after each iteration [N]
};

/// @brief Shape in equilibrium: the side opposite to a corner of a triangle pulls with the natural force
/// density stress/2 cot(corner); each iteration solves a linear net with those of the shape before.
///
/// With one stress and no cables the shape is a minimal surface. At nodes that no cable meets only the force
/// along the normal counts and moves them: along the film a mesh of constant stress is indifferent, and they
/// stay. Where that does not converge, a start is looked for in which nodes have followed the edges, and
/// nodes of edges of constant tension may keep their places along these, too; side_force_density balances
/// what is left there. Source: Pinkall & Polthier (1993), Experiment. Math. 2; Pauletti & Pimenta (2008),
/// Eng. Struct. 30.
/// @throws ModelError if the film makes no sense, or a triangle of the start has no area
FilmResult find_minimal_film(const Film& film, const MinimalFilmOptions& options = {},
                             const std::function<void(int, double)>& progress = {});

}  // namespace tautline::formfinding
