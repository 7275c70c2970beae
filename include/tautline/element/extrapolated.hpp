#pragma once

#include <tautline/core/types.hpp>

namespace tautline::element {

/// @brief Force and tangent of an element in its present motion with stresses foretold for it.
///
/// The stresses are those of the motion before and their first-order change by the increment that led from
/// there; geometry and stiffness of the material are the present ones. Theory:
/// docs/theory/newton.md#stresses-foretold
template <int N>
struct Extrapolated {
  Vec<N> force;
  Mat<N> tangent;
};

}  // namespace tautline::element
