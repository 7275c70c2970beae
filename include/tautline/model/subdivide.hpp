#pragma once
/// @file
/// From the structure as described to its finite-element mesh.

#include <map>
#include <string>

#include <tautline/model/model.hpp>
#include <tautline/model/tube_shells.hpp>

namespace tautline::model {

enum class FacetPattern {
  structured,  ///< s x s similar triangles
  mapped       ///< three mapped quadrilateral patches around the centroid, each cell split in two triangles
};

struct SubdivideOptions {
  int subdivisions = 1;  ///< parts of each facet side, of the cables on it, of slack cables and of the beams
  FacetPattern pattern = FacetPattern::structured;
  std::map<std::string, int> group_subdivisions;  ///< override for a cable or beam group
  TubeShellOptions tubes;  ///< replaced before all else; their shells are not split further
};

/// @brief Splits facets, the cables and beams along their sides, all other beams, and cables off facets that
/// are longer than their chords or have no facets or beams beside them; parts share nodes.
///
/// Other cables stay whole. The unstressed length of a cable is shared out equally.
/// An initial motion is carried along: linear between the corners of facets, cubic along beams, as their ends
/// turn. Selections and supports follow their elements; a support on explicit nodes stays on those nodes.
/// `mapped` needs an even number of subdivisions. @throws ModelError for subdivisions < 1 or conflicting
/// overrides.
Model subdivide(const Model& structure, const SubdivideOptions& options);

}  // namespace tautline::model
