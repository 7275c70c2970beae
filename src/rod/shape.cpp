#include <tautline/rod/shape.hpp>

namespace tautline::rod {

VecX RodShape::axial_force() const {
  VecX n = reaction;
  for (int k = static_cast<int>(n.size()) - 2; k >= 0; --k) n[k] += n[k + 1];
  return n;
}

}  // namespace tautline::rod
