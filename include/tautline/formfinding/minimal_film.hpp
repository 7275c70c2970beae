#pragma once
/// @file
/// Films of given stress, edged and crossed by cables: tents. With the same stress in all directions they are
/// soap films.

#include <functional>
#include <string>
#include <tautline/formfinding/film_facet.hpp>
#include <tautline/formfinding/minimal_film_options.hpp>
#include <tautline/formfinding/net.hpp>
#include <vector>

namespace tautline::formfinding {

/// The film, with cables as the branches of `net`.
struct Film {
  Net net;  ///< its nodes are the start: the facets there must have areas
  std::vector<FilmFacet> facets;
  VecX cable_tension = {};        ///< of every branch [N]; NaN: it has a force density
  VecX cable_force_density = {};  ///< of every branch [N/m]; used where the tension is NaN; may be empty
};

struct FilmResult {
  bool converged = false;
  std::string reason;  ///< one sentence with both sides of the inequality
  Points nodes;        ///< [m]
  VecX cable_tension;  ///< [N]
  double area = 0;     ///< of all facets [m^2]
  /// N11, N22, N12 of each facet in element::membrane_frame [N/m], which balance the nodes in all directions.
  Points stress;
  double out_of_balance = 0;  ///< largest force at a free node, along the film, too [N]
  int iterations = 0;
  std::vector<double>
      residual;  ///< largest force out of balance before the first and after each iteration [N]
};

/// @brief Shape in equilibrium: the sides of the facets pull with natural force densities; each iteration
/// solves a linear net with those of the shape before.
///
/// With one stress and no cables the shape is a minimal surface. Along the film a mesh of given stress is
/// indifferent, so at nodes that no cable meets only the force along the normal counts; along it they follow
/// the edges as in the net of the drawn mesh's force densities. What is left along the film is settled at the
/// end, see settle_film. Source: Pinkall & Polthier (1993), Experiment. Math. 2; Pauletti & Pimenta (2008),
/// Eng. Struct. 30.
/// @throws ModelError if the film makes no sense, or a facet of the start has no area
FilmResult find_minimal_film(const Film& film, const MinimalFilmOptions& options = {},
                             const std::function<void(int, double)>& progress = {});

}  // namespace tautline::formfinding
