// Published shells: MacNeal & Harder (1985), Belytschko et al. (1985), small displacements; the hemisphere of
// Sze, Liu & Lo (2004), large ones.
#include <gtest/gtest.h>

#include <cmath>
#include <tautline/element/shell.hpp>

#include "shell_model.hpp"

namespace tautline::element {

namespace {

using namespace testing_shell;

const double pi = std::acos(-1.);

/// Quarter of the barrel vault of Scordelis & Lo under its weight; deflection of the middle of the free edge.
template <int N>
double scordelis_lo(int n) {
  const double R = 25, half = 25, angle = 40 * pi / 180;
  auto roof = grid<N>(
      n, n,
      [&](double r, double s) { return Vec3(half * r, R * std::sin(angle * s), R * std::cos(angle * s)); },
      {4.32e8, 0, 0.25, 0, 5. / 6, 0});
  roof.support([&](const Vec3& x) { return near(x[0], half); }, {1, 2, 3});
  mirror(roof, 0, [](const Vec3& x) { return near(x[0], 0); });
  mirror(roof, 1, [](const Vec3& x) { return near(x[1], 0); });
  VecX load = VecX::Zero(roof.n_dofs());
  for (int e = 0; e < static_cast<int>(roof.elements.size()); ++e)
    for (const int i : roof.elements[e]) load[6 * i + 2] -= 90 * shell_area<N>(corners(roof, e)) / N;
  return -linear_solution(roof, load)[6 * (n + 1) * n + 2];
}

/// Quarter of the hemisphere with a hole of 18 degrees; node 0 on the x axis, node n on the y axis.
template <int N>
ShellModel<N> hemisphere(int n) {
  const double R = 10, latitude = 72 * pi / 180;
  const auto map = [&](double r, double s) -> Vec3 {
    const double a = r * pi / 2, b = s * latitude;
    return R * Vec3(std::cos(b) * std::cos(a), std::cos(b) * std::sin(a), std::sin(b));
  };
  auto model = grid<N>(n, n, map, {6.825e7, 0.3, 0.04, 0, 5. / 6, 0});
  mirror(model, 1, [](const Vec3& x) { return near(x[1], 0); });
  mirror(model, 0, [](const Vec3& x) { return near(x[0], 0); });
  model.supported.push_back(2);
  return model;
}

/// Inward on the x axis, outward on the y axis; the quarter carries half of the force.
template <int N>
VecX pinch(const ShellModel<N>& model, int n, double P) {
  return model.load(0, 0, -P / 2) + model.load(n, 1, P / 2);
}

/// Eighth of a cylinder with end diaphragms, pinched by two unit forces; deflection under one.
template <int N>
double pinched_cylinder(int n) {
  const double R = 300, half = 300;
  auto cylinder = grid<N>(
      n, n,
      [&](double r, double s) { return Vec3(half * r, R * std::sin(pi / 2 * s), R * std::cos(pi / 2 * s)); },
      {3e6, 0.3, 3, 0, 5. / 6, 0});
  cylinder.support([&](const Vec3& x) { return near(x[0], half); }, {1, 2, 3});
  mirror(cylinder, 0, [](const Vec3& x) { return near(x[0], 0); });
  mirror(cylinder, 1, [](const Vec3& x) { return near(x[1], 0); });
  mirror(cylinder, 2, [](const Vec3& x) { return near(x[2], 0); });
  return -linear_solution(cylinder, cylinder.load(0, 2, -.25))[2];
}

}  // namespace

// MacNeal & Harder (1985), Belytschko et al. (1985). Triangles of constant membrane strain converge from
// below with the square of the element's size, so their limit is extrapolated from two meshes.

TEST(ShellLinear, QuadrilateralsMeetScordelisAndLo) {
  EXPECT_NEAR(scordelis_lo<4>(16) / 0.3024, 1, 0.005);
}

TEST(ShellLinear, TrianglesConvergeToScordelisAndLo) {
  const double coarse = scordelis_lo<3>(12), fine = scordelis_lo<3>(24);
  EXPECT_LT(coarse, fine);
  EXPECT_NEAR((4 * fine - coarse) / 3 / 0.3024, 1, 0.01);
}

TEST(ShellLinear, QuadrilateralsMeetThePinchedHemisphere) {
  auto model = hemisphere<4>(16);
  // published to two digits
  EXPECT_NEAR(-linear_solution(model, pinch(model, 16, 2.))[0] / 0.0940, 1, 0.01);
}

TEST(ShellLinear, TrianglesMeetThePinchedHemisphere) {
  auto model = hemisphere<3>(24);
  EXPECT_NEAR(-linear_solution(model, pinch(model, 24, 2.))[0] / 0.0940, 1, 0.02);
}

TEST(ShellLinear, QuadrilateralsMeetThePinchedCylinder) {
  EXPECT_NEAR(pinched_cylinder<4>(32) / 1.82488e-5, 1, 0.015);
}

TEST(ShellLinear, TrianglesApproachThePinchedCylinder) {
  const double coarse = pinched_cylinder<3>(16), fine = pinched_cylinder<3>(32);
  EXPECT_NEAR(fine / 1.82488e-5, 1, 0.035);
  EXPECT_LT(std::abs(fine / 1.82488e-5 - 1), std::abs(coarse / 1.82488e-5 - 1) / 3);
}

TEST(ShellLarge, SzePinchedHemisphere) {
  auto model = hemisphere<4>(16);
  ShellState state = model.at_rest();
  for (int i = 1; i <= 2; ++i) equilibrate(model, pinch(model, 16, 40. * i), state);
  // finer meshes give 2.318 and 3.230: the published values are those of one mesh of 16 x 16, too
  EXPECT_NEAR(state.u[16][1] / 2.321, 1, 0.015);
  EXPECT_NEAR(-state.u[0][0] / 3.261, 1, 0.015);
}

}  // namespace tautline::element
