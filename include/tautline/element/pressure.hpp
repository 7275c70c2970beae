#pragma once
/// @file
/// Pressure that follows a facet: it stays normal to it and acts on its current area. Theory:
/// docs/theory/loads.md

#include <tautline/core/types.hpp>
#include <tautline/element/want.hpp>

namespace tautline::element {

template <int N>
struct PressureResponse {
  Vec<3 * N> force;    ///< on the nodes, along the facet's normal for positive pressure [N]
  Mat<3 * N> tangent;  ///< d force / du, symmetrised [N/m]; left untouched unless wanted
};

/// @brief Nodal forces of a pressure on a facet of N = 3 or 4 nodes, integral of N_i p (x,1 x x,2).
///
/// Normal by the right-hand rule of the node order. The sum over a closed or a held boundary is the gradient
/// of pressure times enclosed volume; the skew parts of the tangents of neighbours cancel.
/// @param[in] x_cur  current coordinates, column = node [m]
template <int N>
PressureResponse<N> evaluate_pressure(double pressure, const Mat<3, N>& x_cur, Want want);

}  // namespace tautline::element
