#pragma once
/// @file
/// Facets of films, whose stresses are given: their forces, and how even a stress is.

#include <array>
#include <tautline/core/types.hpp>
#include <tautline/model/facet.hpp>
#include <vector>

namespace tautline::formfinding {

/// A triangle or quadrilateral of a film. Its stress is that of the present shape (Cauchy), whatever it was
/// drawn like.
struct FilmFacet {
  model::FacetNodes nodes;
  std::array<double, 2> stress{0, 0};  ///< along axis 1 and across it, positive [N/m]
  Vec3 orientation = Vec3::UnitX();    ///< axis 1 is its projection; of no meaning for equal stresses
  double largest_stress() const { return stress[0] > stress[1] ? stress[0] : stress[1]; }
};

/// Triangles with the same stress in all directions [N/m].
std::vector<FilmFacet> isotropic_film(const std::vector<std::array<int, 3>>& triangles, const VecX& stress);

/// @brief What stresses of the facets pull their nodes with [N].
/// @param[in] stress  N11, N22, N12 of each facet in element::membrane_frame [N/m]
Points film_forces(const std::vector<FilmFacet>& facets, const Points& stress, const Points& nodes);

/// @brief Deviation of each facet's stress from the one asked for, over the larger of the two asked for [-].
///
/// The norm of the tensor's deviation: no principal value is off by more.
std::vector<double> film_unevenness(const std::vector<FilmFacet>& facets, const Points& stress,
                                    const Points& nodes);

}  // namespace tautline::formfinding
