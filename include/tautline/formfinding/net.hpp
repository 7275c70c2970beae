#pragma once
/// @file
/// A cable net as stage 1 sees it: branches between nodes, some of them fixed.

#include <array>
#include <tautline/core/types.hpp>
#include <vector>

namespace tautline::formfinding {

struct Net {
  Points nodes;                              ///< coordinates; those of free nodes are a start only [m]
  std::vector<std::array<int, 2>> branches;  ///< node indices
  std::vector<bool> fixed;                   ///< one for each node
  Points load;                               ///< external nodal loads [N]; empty means none
};

/// The surface free nodes are bound to.
class Surface {
 public:
  virtual ~Surface() = default;
  /// Height z and slopes (z, dz/dx, dz/dy) at (x, y). Outside its domain it throws ModelError.
  virtual Vec3 height_and_slope(double x, double y) const = 0;
};

}  // namespace tautline::formfinding
