#include <array>

#include <tautline/element/pressure.hpp>

#include "detail/quadrilateral.hpp"
#include "detail/rotation.hpp"

namespace tautline::element {

namespace {

/// Tangent of skew blocks from levers, d force_i = sum of lever_ij x dx_j; symmetrised.
template <int N>
void fill_tangent(const std::array<Mat<3, N>, N>& lever, Mat<3 * N>& K) {
  for (int i = 0; i < N; ++i) {
    K.template block<3, 3>(3 * i, 3 * i).setZero();
    for (int j = i + 1; j < N; ++j) {
      const Mat3 block = detail::skew((lever[i].col(j) - lever[j].col(i)) / 2);
      K.template block<3, 3>(3 * i, 3 * j) = block;
      K.template block<3, 3>(3 * j, 3 * i) = block.transpose();
    }
  }
}

/// A third of pressure times area vector on every node.
PressureResponse<3> on_facet(double pressure, const Mat<3, 3>& x_cur, Want want) {
  const Vec3 share = pressure / 6 * (x_cur.col(1) - x_cur.col(0)).cross(x_cur.col(2) - x_cur.col(0));
  PressureResponse<3> response;
  response.force << share, share, share;
  if (want == Want::force) return response;
  Mat<3, 3> lever;  // side opposite each node
  lever << x_cur.col(2) - x_cur.col(1), x_cur.col(0) - x_cur.col(2), x_cur.col(1) - x_cur.col(0);
  lever *= pressure / 6;
  fill_tangent<3>({lever, lever, lever}, response.tangent);
  return response;
}

/// By 2 x 2 Gauss points, exact: the area vector of the bilinear surface is linear in xi and eta.
PressureResponse<4> on_facet(double pressure, const Mat<3, 4>& x_cur, Want want) {
  const Mat<3, 4> x = x_cur.colwise() - x_cur.col(0);
  PressureResponse<4> response;
  response.force.setZero();
  std::array<Mat<3, 4>, 4> lever;
  lever.fill(Mat<3, 4>::Zero());
  for (const auto& [xi, eta] : detail::gauss_points) {
    const Vec<4> shape = detail::bilinear(xi, eta);
    const Mat<2, 4> d = detail::bilinear_derivatives(xi, eta);
    const Mat<3, 2> g = x * d.transpose();  // tangents of the coordinate lines
    const Vec3 traction = pressure * g.col(0).cross(g.col(1));
    for (int i = 0; i < 4; ++i) response.force.segment<3>(3 * i) += shape[i] * traction;
    if (want == Want::force) continue;
    const Mat<3, 4> of_traction = pressure * (g.col(0) * d.row(1) - g.col(1) * d.row(0));
    for (int i = 0; i < 4; ++i) lever[i] += shape[i] * of_traction;
  }
  if (want == Want::tangent) fill_tangent<4>(lever, response.tangent);
  return response;
}

}  // namespace

template <int N>
PressureResponse<N> evaluate_pressure(double pressure, const Mat<3, N>& x_cur, Want want) {
  return on_facet(pressure, x_cur, want);
}

template PressureResponse<3> evaluate_pressure<3>(double, const Mat<3, 3>&, Want);
template PressureResponse<4> evaluate_pressure<4>(double, const Mat<3, 4>&, Want);

}  // namespace tautline::element
