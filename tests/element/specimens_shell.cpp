#include <tautline/element/shell.hpp>

#include "specimen.hpp"

namespace tautline::element {

namespace {

/// Resultants given in one frame as components in another frame of the same plane.
Vec3 in_frame(const Vec3& N, const Mat3& from, const Mat3& to) {
  Mat<2> tensor;
  tensor << N[0], N[2], N[2], N[1];
  const Mat<2> Q = to.leftCols<2>().transpose() * from.leftCols<2>();
  const Mat<2> turned = Q * tensor * Q.transpose();
  return {turned(0, 0), turned(1, 1), turned(0, 1)};
}

/// A distorted element of a curved shell (quadrilaterals are warped), bent by rotations of order `bend`.
template <int N>
Specimen shell(const std::string& name, double bend, const Vec3& prestress, double free_strain) {
  Specimen s{name, true, MatX(3, N), {MatX(3, N), {}}, {}};
  ShellGeometry<N> whole;
  Mat<3, 4> x, u, tilt, turns;
  x << 0, 1.2, 1.4, 0.1, 0.1, 0, 0.9, 1.1, 0, 0.15, -0.1, 0.1;
  u << 0.05, -0.1, 0.2, 0.03, 0.15, -0.07, 0.1, -0.12, 0.21, 0.1, -0.1, 0.15;
  tilt << 0.1, -0.15, -0.05, 0.1, 0.05, 0.1, -0.1, -0.1, 1, 1, 1, 1;
  turns << 0.3, -0.4, 0.2, 0.5, -0.8, 0.6, 0.1, -0.3, 0.5, 0.7, -0.2, 0.4;
  s.x_ref = x.leftCols<N>();
  s.motion.u = bend * u.leftCols<N>();
  for (int i = 0; i < N; ++i) {
    whole.director.col(i) = tilt.col(i).normalized();
    s.motion.rotation.push_back(turn(bend * turns.col(i)));
  }
  whole.x_ref = s.x_ref;
  const ShellSection section{1000, 0.3, 0.2, 1, 5. / 6, 0};
  s.evaluate = [=](const Motion& m, const std::vector<int>& order, Want want) {
    ShellGeometry<N> geometry;
    geometry.x_ref = reordered<N>(whole.x_ref, order);
    geometry.director = reordered<N>(whole.director, order);
    geometry.prestress = in_frame(prestress, shell_frame<N>(whole.x_ref), shell_frame<N>(geometry.x_ref));
    geometry.free_strain = free_strain;
    ShellMotion<N> motion;
    motion.u = reordered<N>(m.u, order);
    for (int i = 0; i < N; ++i) motion.rotation[i] = m.rotation[order[i]];
    const auto response = evaluated_over_nan<ShellResponse<N>>(
        [&] { return evaluate_shell<N>(section, geometry, motion, want); });
    return answer_of(response, want);
  };
  return s;
}

}  // namespace

std::vector<Specimen> shell_specimens() {
  const Vec3 none = Vec3::Zero(), prestress(4, 7, 2.5);
  return {shell<3>("TriangularShellSlightlyBent", 0.1, none, 0),
          shell<3>("TriangularShellStronglyBent", 1, none, 0),
          shell<3>("TriangularShellPrestressedAndWarm", 0.4, prestress, 0.01),
          shell<4>("QuadrilateralShellSlightlyBent", 0.1, none, 0),
          shell<4>("QuadrilateralShellStronglyBent", 1, none, 0),
          shell<4>("QuadrilateralShellPrestressedAndWarm", 0.4, prestress, 0.01)};
}

}  // namespace tautline::element
