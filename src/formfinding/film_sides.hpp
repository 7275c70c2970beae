#pragma once
/// @file
/// The sides of a film's triangles as branches, and what the film pulls with along them.

#include <array>
#include <formfinding/net_system.hpp>
#include <vector>

namespace tautline::formfinding {

using Triangles = std::vector<std::array<int, 3>>;

/// Every side of the triangles once.
struct FilmSides {
  std::vector<std::array<int, 2>> nodes;
  std::vector<std::array<int, 3>> of_triangle;  ///< side opposite to each corner
};
FilmSides find_sides(const Triangles& triangles);

/// @brief Natural force densities of films, stress/2 cot(opposite corner) of the triangles at each side
/// [N/m].
///
/// Source: Pinkall & Polthier (1993), Experiment. Math. 2.
VecX natural_force_density(const FilmSides& sides, const Triangles& triangles, const VecX& surface_stress,
                           const Coordinates& nodes);

/// Area of one triangle [m^2].
double area(const std::array<int, 3>& corners, const Coordinates& nodes);

/// @throws ModelError naming a triangle that has no area
void check_areas(const Triangles& triangles, const Coordinates& nodes);

/// @brief balanced_sides for a net of cables and films in the shape found.
/// @param[in] tension  of the branches [N]
Points balance_film(const Net& net, const VecX& tension, const Triangles& triangles,
                    const VecX& surface_stress, const Points& nodes);

/// @brief Force density of the side opposite to each corner of every triangle [N/m], with which the nodes are
/// in equilibrium in all directions, as near to the natural ones as can be.
///
/// A film of one stress is in equilibrium on its triangles only across itself; what is left along it is taken
/// by the smallest change of the stresses, in the sense of least squares.
/// @param[in] system  whose branches pull with `force_density` and whose free nodes are to be in equilibrium
/// @param[in] state   the shape, with all force densities, those of the film included
Points balanced_sides(const NetSystem& system, const NetState& state, const Triangles& triangles,
                      const VecX& surface_stress);

}  // namespace tautline::formfinding
