#include <array>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include <tautline/element/pressure.hpp>

namespace tautline::element {

namespace {

using Corners = Mat<3, 8>;

double tetrahedron(const Vec3& a, const Vec3& b, const Vec3& c) {
  return a.dot(b.cross(c)) / 6;
}

/// Box whose corners are displaced; corner x + 2 y + 4 z, facets seen counter-clockwise from outside. Four of
/// the sides are quadrilaterals that are not flat, two are cut into triangles.
struct ClosedSurface {
  Corners x;
  std::vector<std::array<int, 4>> quadrilaterals{{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}};
  std::vector<std::array<int, 3>> triangles{{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};

  ClosedSurface() {
    x << 0.1, 1.2, -0.1, 0.9, 0, 1, 0.2, 1.1,  //
        0, 0.1, 1.3, 0.9, -0.2, 0.1, 1, 1.2,   //
        0, -0.1, 0.1, 0.2, 0.8, 1.1, 1, 0.9;
  }

  /// Sum of tetrahedra from the origin. A bilinear surface halves the tetrahedron of its corners, so it
  /// counts as the mean of its two cuts into triangles.
  double volume(const Corners& at) const {
    const auto over = [&](int a, int b, int c) { return tetrahedron(at.col(a), at.col(b), at.col(c)); };
    double sum = 0;
    for (const auto& [a, b, c] : triangles) sum += over(a, b, c);
    for (const auto& [a, b, c, d] : quadrilaterals)
      sum += (over(a, b, c) + over(a, c, d) + over(a, b, d) + over(b, c, d)) / 2;
    return sum;
  }

  /// Volume with two coordinates moved. It is linear in each: differences over any step are exact.
  double volume_moved(int i, double by, int j = 0, double by_j = 0) const {
    Corners moved = x;
    moved.data()[i] += by;
    moved.data()[j] += by_j;
    return volume(moved);
  }
};

struct Pressed {
  Vec<24> force = Vec<24>::Zero();
  Mat<24> tangent = Mat<24>::Zero();

  template <std::size_t N>
  void add(double pressure, const Corners& x, const std::vector<std::array<int, N>>& facets) {
    for (const auto& facet : facets) {
      Mat<3, static_cast<int>(N)> corners;
      for (std::size_t i = 0; i < N; ++i) corners.col(i) = x.col(facet[i]);
      const auto response = evaluate_pressure<N>(pressure, corners, Want::tangent);
      for (std::size_t i = 0; i < N; ++i) {
        force.segment<3>(3 * facet[i]) += response.force.template segment<3>(3 * i);
        for (std::size_t j = 0; j < N; ++j)
          tangent.block<3, 3>(3 * facet[i], 3 * facet[j]) +=
              response.tangent.template block<3, 3>(3 * i, 3 * j);
      }
    }
  }
};

Pressed pressed(const ClosedSurface& surface, double pressure) {
  Pressed sum;
  sum.add(pressure, surface.x, surface.quadrilaterals);
  sum.add(pressure, surface.x, surface.triangles);
  return sum;
}

Mat<3, 3> triangle() {
  Mat<3, 3> x;
  x << 0.3, 1.2, 0.1, 0, 0.2, 0.9, 0.1, -0.3, 0.4;
  return x;
}

Mat<3, 4> quadrilateral() {
  Mat<3, 4> x;
  x << 0, 1.2, 1.4, 0.3, 0.1, 0.2, 1.1, 0.9, 0, 0.3, -0.1, -0.2;
  return x;
}

/// The force is quadratic in the coordinates: central differences over any step are exact.
template <int N>
Mat<3 * N> derivative_of_force(double pressure, const Mat<3, N>& x) {
  const double h = 0.25;
  Mat<3 * N> K;
  for (int i = 0; i < 3 * N; ++i) {
    Mat<3, N> forward = x, backward = x;
    forward.data()[i] += h;
    backward.data()[i] -= h;
    K.col(i) = (evaluate_pressure<N>(pressure, forward, Want::force).force -
                evaluate_pressure<N>(pressure, backward, Want::force).force) /
               (2 * h);
  }
  return K;
}

template <int N>
void expect_symmetrised_derivative(const Mat<3, N>& x) {
  const Mat<3 * N> K = derivative_of_force<N>(7, x);
  const auto response = evaluate_pressure<N>(7, x, Want::tangent);
  EXPECT_GT((K - K.transpose()).norm(), 0.1);  // a lone facet is not conservative
  EXPECT_LT(((K + K.transpose()) / 2 - response.tangent).norm(), 1e-14 * K.norm());
  EXPECT_EQ(response.tangent, response.tangent.transpose());
}

}  // namespace

TEST(Pressure, ForceIsPressureTimesTheGradientOfTheVolume) {
  const ClosedSurface surface;
  const auto sum = pressed(surface, 3);
  for (int i = 0; i < 24; ++i)
    EXPECT_NEAR(sum.force[i], 3 * (surface.volume_moved(i, 0.5) - surface.volume_moved(i, -0.5)), 1e-14);
}

TEST(Pressure, TangentOfAClosedSurfaceIsPressureTimesTheHessianOfTheVolume) {
  const ClosedSurface surface;
  const auto sum = pressed(surface, 3);
  const double h = 0.5;
  for (int i = 0; i < 24; ++i) {
    EXPECT_NEAR(sum.tangent(i, i), 0, 1e-14);
    for (int j = 0; j < i; ++j) {
      const double second = (surface.volume_moved(i, h, j, h) - surface.volume_moved(i, h, j, -h) -
                             surface.volume_moved(i, -h, j, h) + surface.volume_moved(i, -h, j, -h)) /
                            (4 * h * h);
      EXPECT_NEAR(sum.tangent(i, j), 3 * second, 1e-14);
    }
  }
}

TEST(Pressure, ClosedSurfaceIsInEquilibrium) {
  const ClosedSurface surface;
  const auto sum = pressed(surface, 3);
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  for (int i = 0; i < 8; ++i) {
    const Vec3 f = sum.force.segment<3>(3 * i);
    force += f;
    moment += Vec3(surface.x.col(i)).cross(f);
  }
  EXPECT_LT(force.norm(), 1e-14);
  EXPECT_LT(moment.norm(), 1e-14);
}

TEST(Pressure, FlatFacetSharesPressureTimesAreaAlongItsNormal) {
  Mat<3, 3> triangle;
  triangle << 0, 2, 0, 0, 0, 3, 1, 1, 1;
  const auto on_triangle = evaluate_pressure<3>(5, triangle, Want::force);
  EXPECT_LT((on_triangle.force - Vec3(0, 0, 5).replicate<3, 1>()).norm(), 1e-14);
  Mat<3, 4> rectangle;
  rectangle << 0, 2, 2, 0, 0, 0, 3, 3, 1, 1, 1, 1;
  const auto on_rectangle = evaluate_pressure<4>(5, rectangle, Want::force);
  EXPECT_LT((on_rectangle.force - Vec3(0, 0, 7.5).replicate<4, 1>()).norm(), 1e-13);
}

TEST(Pressure, TrapezoidGivesMoreToItsLongSide) {
  // sides of 3 and 1, height 2: integral of a shape function of the long side (2 * 3 + 1) 2/12
  Mat<3, 4> x;
  x << 0, 3, 2, 1, 0, 0, 2, 2, 0, 0, 0, 0;
  const auto response = evaluate_pressure<4>(6, x, Want::force);
  EXPECT_NEAR(response.force[2], 7, 1e-14);
  EXPECT_NEAR(response.force[5], 7, 1e-14);
  EXPECT_NEAR(response.force[8], 5, 1e-14);
  EXPECT_NEAR(response.force[11], 5, 1e-14);
}

TEST(Pressure, TangentIsTheSymmetrisedDerivativeOfTheForce) {
  expect_symmetrised_derivative<3>(triangle());
  expect_symmetrised_derivative<4>(quadrilateral());
}

TEST(Pressure, ReversedFacetIsPushedTheOtherWay) {
  const Mat<3, 4> x = quadrilateral(), reversed = x.rowwise().reverse();
  const auto one = evaluate_pressure<4>(2, x, Want::tangent);
  const auto other = evaluate_pressure<4>(2, reversed, Want::tangent);
  for (int i = 0; i < 4; ++i) {
    EXPECT_LT((one.force.segment<3>(3 * i) + other.force.segment<3>(9 - 3 * i)).norm(), 1e-15);
    for (int j = 0; j < 4; ++j)
      EXPECT_LT(
          (one.tangent.block<3, 3>(3 * i, 3 * j) + other.tangent.block<3, 3>(9 - 3 * i, 9 - 3 * j)).norm(),
          1e-15);
  }
}

}  // namespace tautline::element
