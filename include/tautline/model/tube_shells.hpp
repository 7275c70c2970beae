#pragma once
/// @file
/// Thin round tubes as shells in place of beams.

#include <string>
#include <vector>

#include <tautline/model/model.hpp>

namespace tautline::model {

struct TubeShellOptions {
  std::vector<std::string> groups;  ///< of beams with section tube or tapered_tube; none: nothing changes
  int around = 24;                  ///< shell elements round each tube
  int along = 24;                   ///< and along each beam
};

/// @brief The same structure with the beams of some groups as tubes of four-node shells.
///
/// A tube begins and ends with a rigid ring about the beam's end node: joints stay what they were, points
/// with rotations. Nodes stand on a circle that gives the polygon the second moment of area of the round
/// tube, a little outside the mean one; its area is then greater by 0.2 % with 24 elements round. Fewer than
/// 20 would meet at edges (see find_directors). Loads and
/// supports of the end nodes stay; groups keep their names, selections their members.
/// @throws ModelError for other sections, walls that taper, line loads on these groups, counts that are too
/// small, or a structure that starts moved
Model tubes_as_shells(const Model& structure, const TubeShellOptions& options);

}  // namespace tautline::model
