#pragma once
/// @file
/// A film as branches between the nodes of its facets.

#include <array>
#include <formfinding/film_element.hpp>
#include <formfinding/net_system.hpp>
#include <vector>

namespace tautline::formfinding {

/// Every pair of nodes of a facet once: the sides, and of quadrilaterals the diagonals.
struct FilmSides {
  std::vector<std::array<int, 2>> nodes;
  std::vector<std::array<int, 6>> of_facet;  ///< of the corners 01, 02, 12 and 03, 13, 23
};
FilmSides find_sides(const std::vector<FilmFacet>& facets);

/// @brief Force densities with which the sides pull as the films do [N/m]: of a triangle with one stress,
/// stress/2 cot(opposite corner).
///
/// The gradients g of the shape functions give q_ij = -sum over the points of area g_i . N g_j.
/// Source: Pinkall & Polthier (1993), Experiment. Math. 2.
VecX natural_force_density(const FilmSides& sides, const std::vector<FilmFacet>& facets,
                           const Coordinates& nodes);

/// @throws ModelError naming a facet that has no area
void check_areas(const Net& net, const std::vector<FilmFacet>& facets);

}  // namespace tautline::formfinding
