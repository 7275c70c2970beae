#pragma once
/// @file
/// In-plane rotation of the mid-surface of a shell against its nodes. Theory: docs/theory/shell.md#drilling

#include <tautline/element/shell.hpp>

#include "rotation.hpp"
#include "shell_strains.hpp"

namespace tautline::element::detail {

/// Symmetrised second derivative of f . exp(skew(w)) v by the spin w.
inline Mat3 second_spin_derivative(const Vec3& f, const Vec3& v) {
  return (f * v.transpose() + v * f.transpose()) / 2 - f.dot(v) * Mat3::Identity();
}

/// Turns v as the shortest rotation from the unit vector `from` to the unit vector `to` would.
inline Vec3 turned(const Vec3& v, const Vec3& from, const Vec3& to) {
  const Vec3 axis = from.cross(to);
  const Vec3 across = axis.cross(v);
  return v + across + axis.cross(across) / (1 + from.dot(to));
}

/// @brief Rotation of the mid-surface about its normal at the centre, less the rotation of one node.
///
/// angle = y_r . p + y_s . q, with the tangents y_r, y_s at the centre and vectors p, q that turn with the
/// node. At rest p, q are x_s, -x_r over 2 |x_r x x_s|, tilted with the node's director: the angle is half of
/// y_1 . t_2 - y_2 . t_1 for orthonormal in-plane axes 1, 2 and the node's triad t (Fox & Simo 1992).
struct DrillingAngle {
  Vec3 p, q;
  double value;
};

/// @param[in] x       modes of the reference configuration
/// @param[in] change  their change
template <int N>
std::array<DrillingAngle, N> drilling_angles(const ShellGeometry<N>& geometry, const ShellMotion<N>& motion,
                                             const ShellModes<N>& x, const ShellModes<N>& change) {
  using Table = ShellTable<N>;
  const Vec3 xr = x.col(Table::yr), xs = x.col(Table::ys);
  const Vec3 cross = xr.cross(xs);
  const double jacobian = cross.norm();
  const Vec3 normal = cross / jacobian;
  std::array<DrillingAngle, N> angles;
  for (int i = 0; i < N; ++i) {
    const Vec3 D = geometry.director.col(i);
    const Vec3 axis = D.dot(normal) < 0 ? Vec3(-D) : D;
    const Mat3 turn = motion.rotation[i] - Mat3::Identity();
    const Vec3 p_ref = turned(xs, normal, axis) / (2 * jacobian);
    const Vec3 q_ref = -turned(xr, normal, axis) / (2 * jacobian);
    const Vec3 dp = turn * p_ref, dq = turn * q_ref;
    const Vec3 p = p_ref + dp, q = q_ref + dq;
    angles[i] = {p, q, change.col(Table::yr).dot(p) + change.col(Table::ys).dot(q) + xr.dot(dp) + xs.dot(dq)};
  }
  return angles;
}

/// Derivative of the angle of node i by displacements and spins.
template <int N>
Mat<1, 6 * N> drilling_row(const DrillingAngle& angle, int i, const ShellModes<N>& v) {
  using Table = ShellTable<N>;
  Mat<1, 6 * N> row;
  for (int j = 0; j < N; ++j) {
    row.template segment<3>(6 * j) =
        Table::weight[Table::yr][j] * angle.p + Table::weight[Table::ys][j] * angle.q;
    row.template segment<3>(6 * j + 3).setZero();
  }
  row.template segment<3>(6 * i + 3) = angle.p.cross(v.col(Table::yr)) + angle.q.cross(v.col(Table::ys));
  return row;
}

/// Adds `moment` times the symmetrised second derivative of the angle of node i.
template <int N>
void add_drilling_curvature(const DrillingAngle& angle, int i, const ShellModes<N>& v, double moment,
                            Mat<6 * N>& K) {
  using Table = ShellTable<N>;
  for (int j = 0; j < N; ++j) {
    const Mat3 block =
        moment * skew(Table::weight[Table::yr][j] * angle.p + Table::weight[Table::ys][j] * angle.q);
    K.template block<3, 3>(6 * j, 6 * i + 3) -= block;
    K.template block<3, 3>(6 * i + 3, 6 * j) += block;
  }
  K.template block<3, 3>(6 * i + 3, 6 * i + 3) +=
      moment *
      (second_spin_derivative(v.col(Table::yr), angle.p) + second_spin_derivative(v.col(Table::ys), angle.q));
}

}  // namespace tautline::element::detail
