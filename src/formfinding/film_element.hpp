#pragma once
/// @file
/// A facet of a film as the membrane element of the analysis.

#include <formfinding/sparse_factor.hpp>
#include <string>
#include <tautline/element/membrane.hpp>
#include <tautline/formfinding/film_facet.hpp>
#include <tautline/formfinding/net.hpp>

namespace tautline::formfinding {

template <int N>
Mat<3, N> corners(const FilmFacet& facet, const Coordinates& nodes) {
  Mat<3, N> x;
  for (int k = 0; k < N; ++k) x.col(k) = nodes.row(facet.nodes[k]).transpose();
  return x;
}

/// `visit` with the corners of the facet, a matrix of three or four columns.
template <class Visit>
auto with_corners(const FilmFacet& facet, const Coordinates& nodes, const Visit& visit) {
  return facet.nodes.size() == 3 ? visit(corners<3>(facet, nodes)) : visit(corners<4>(facet, nodes));
}

/// Resultants asked for, in element::membrane_frame of the present shape [N/m].
Vec3 target_stress(const FilmFacet& facet, const Coordinates& nodes);

/// Normal of the facet at its corner `k` times twice the area of the triangle of its two sides there.
Vec3 corner_normal(const FilmFacet& facet, const Coordinates& nodes, int k);

/// Area of one facet [m^2].
double area(const FilmFacet& facet, const Coordinates& nodes);

/// Adds what stresses of the facets [N/m] pull their nodes with.
void add_film_forces(const std::vector<FilmFacet>& facets, const Points& stress, const Coordinates& nodes,
                     Coordinates& force);

/// Stress asked for of every facet, see target_stress.
Points target_stresses(const std::vector<FilmFacet>& facets, const Coordinates& nodes);

/// What to add to a reason where single points hold the film, which no soap film can bear; or nothing.
std::string held_points(const Net& net, const std::vector<FilmFacet>& facets);

/// A sentence on facets that lie the other way round to a neighbour than in the net's own shape; empty if
/// there is none.
std::string turned_over(const Net& drawn, const std::vector<FilmFacet>& facets, const Coordinates& found);

}  // namespace tautline::formfinding
