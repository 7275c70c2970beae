#include <gtest/gtest.h>

#include <cmath>
#include <formfinding/elastic_nets.hpp>
#include <limits>
#include <tautline/formfinding/force_density.hpp>
#include <tautline/formfinding/minimal_film.hpp>

namespace tautline::formfinding {
namespace {

/// A film between two circles of radius 1 at z = -0.5 and 0.5, from a cylinder.
Film catenoid(int around, int along) {
  Film film;
  const auto at = [&](int i, int k) { return k * around + (i + around) % around; };
  for (int k = 0; k <= along; ++k) {
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * M_PI * (i + 0.5 * (k % 2)) / around;
      film.net.nodes.push_back(Vec3(std::cos(angle), std::sin(angle), static_cast<double>(k) / along - 0.5));
      film.net.fixed.push_back(k == 0 || k == along);
    }
  }
  for (int k = 0; k < along; ++k) {
    for (int i = 0; i < around; ++i) {
      const int shift = k % 2;  // rows are turned by half a step
      film.facets.push_back({{at(i, k), at(i + 1, k), at(i + shift, k + 1)}, {2, 2}});
      film.facets.push_back({{at(i + 1 - shift, k), at(i + 1, k + 1), at(i, k + 1)}, {2, 2}});
    }
  }
  return film;
}

double neck(int around, int along) {
  const FilmResult result = find_minimal_film(catenoid(around, along));
  EXPECT_TRUE(result.converged) << result.reason;
  return result.nodes[along / 2 * around].head<2>().norm();
}

TEST(MinimalFilm, NeckOfTheCatenoid) {
  // 1 = c cosh(0.5 / c): c = 0.848338. The error falls with the square of the size of the triangles; the
  // extrapolated value leaves the fourth power.
  const double c = 0.8483379380;
  ASSERT_NEAR(c * std::cosh(0.5 / c), 1, 1e-9);
  const double coarse = neck(16, 8), fine = neck(32, 16);
  EXPECT_NEAR((coarse - c) / (fine - c), 4, 0.4);
  EXPECT_NEAR((4 * fine - coarse) / 3, c, 2e-4);
}

TEST(MinimalFilm, EdgeCableOfAFlatFilmIsAnArc) {
  // Tension T against a film of stress s: radius T / s. Of a polygon in a flat film of constant stress the
  // middles of the sides touch that circle exactly, and the sides are equal.
  Film film;
  const int n = 8;
  film.facets = add_film_grid(n, film.net, 2);
  for (Vec3& node : film.net.nodes) node.z() = 0;
  film.cable_tension = VecX::Constant(film.net.branches.size(), 6.0);
  MinimalFilmOptions options;
  options.tolerance = 1e-11;
  const FilmResult result = find_minimal_film(film, options);
  ASSERT_TRUE(result.converged) << result.reason;
  // Edge j = 0: nodes i (n + 1). The centre of its circle lies on x = 0, outside the film.
  const auto node = [&](int i) { return result.nodes[i * (n + 1)]; };
  const double side = (node(1) - node(0)).norm();
  const double half_angle = std::asin(1.0 / (std::hypot(3.0, side / 2)));  // chord of the corners: 2
  const double centre = -1 - std::hypot(3.0, side / 2) * std::cos(half_angle);
  EXPECT_NEAR(std::atan(side / 2 / 3.0) * n, half_angle, 1e-6);
  for (int i = 0; i < n; ++i) {
    EXPECT_NEAR((node(i + 1) - node(i)).norm(), side, 1e-6);
    const Vec3 middle = 0.5 * (node(i) + node(i + 1));
    EXPECT_NEAR((middle - Vec3(0, centre, 0)).norm(), 3.0, 1e-6) << i;
  }
}

/// Largest distance along z of a film on the edge of Scherk's surface z = ln(cos y / cos x), |x|, |y| <= 1,
/// from it.
double scherk_error(int n) {
  const auto scherk = [](const Vec3& p) { return std::log(std::cos(p.y()) / std::cos(p.x())); };
  Film film;
  film.facets = add_film_grid(n, film.net, 1);
  film.net.branches.clear();
  for (std::size_t i = 0; i < film.net.nodes.size(); ++i) {
    Vec3& p = film.net.nodes[i];
    film.net.fixed[i] = std::max(std::abs(p.x()), std::abs(p.y())) == 1;
    p.z() = scherk(p) + 0.05 * (1 - p.x() * p.x()) * (1 - p.y() * p.y());
  }
  const FilmResult result = find_minimal_film(film);
  EXPECT_TRUE(result.converged) << result.reason;
  double largest = 0;
  for (const Vec3& node : result.nodes) largest = std::max(largest, std::abs(node.z() - scherk(node)));
  return largest;
}

TEST(MinimalFilm, ScherkSurfaceIsApproachedWithTheSquareOfTheSide) {
  const double coarse = scherk_error(8), fine = scherk_error(16);
  EXPECT_LE(fine, 1e-3);
  EXPECT_NEAR(coarse / fine, 4, 0.6);
}

TEST(MinimalFilm, TriangleWithoutAreaIsNamed) {
  Film film;
  film.facets = add_film_grid(2, film.net, 1);
  film.cable_tension = VecX::Ones(film.net.branches.size());
  film.net.nodes.assign(film.net.nodes.size(), Vec3::Zero());
  EXPECT_EQ(error_of([&] { find_minimal_film(film); }),
            "the facet of the film between node 1, node 4, node 5 has no area at the start");
}

TEST(UniformTension, FixedPointFindsTheGeodesicOfACable) {
  // A free cable of equal tensions is straight, wherever its nodes lie along it: the derivative is singular.
  Net net = chain(5, {0, 0, 0}, {4, 2, 1});
  net.nodes[2] += Vec3(0.3, -0.4, 1);
  ForceDensityOptions options;
  options.method = TensionMethod::fixed_point;
  const ForceDensityResult result = find_tensions(net, VecX::Constant(5, 3), nullptr, options);
  ASSERT_TRUE(result.converged) << result.reason;
  const Vec3 axis = Vec3(4, 2, 1).normalized();
  for (const Vec3& node : result.nodes) EXPECT_LE((node - axis * axis.dot(node)).norm(), 1e-9);
}

TEST(UniformTension, AllMethodsFindTheSameNet) {
  const Dish dish(3);
  Net net = triangular_net(8, 0.5, dish);
  for (std::size_t i = 0; i < net.nodes.size(); ++i)  // a round edge
    if (net.fixed[i]) {
      const Vec3 p = 4 * Vec3(net.nodes[i].x(), net.nodes[i].y(), 0).normalized();
      net.nodes[i] = Vec3(p.x(), p.y(), dish.height(p.x(), p.y()));
    }
  const VecX tension = VecX::Constant(net.branches.size(), 10);
  ForceDensityOptions options;
  options.method = TensionMethod::step_of_smallest_norm;
  const ForceDensityResult expected = find_tensions(net, tension, &dish, options);
  ASSERT_TRUE(expected.converged);
  for (const auto method : {TensionMethod::position_newton, TensionMethod::fixed_point}) {
    options.method = method;
    const ForceDensityResult result = find_tensions(net, tension, &dish, options);
    ASSERT_TRUE(result.converged) << result.reason;
    EXPECT_LE((result.tension - tension).norm(), 1e-10);
    for (std::size_t i = 0; i < net.nodes.size(); ++i)
      EXPECT_LE((result.nodes[i] - expected.nodes[i]).norm(), 1e-7);
  }
}

TEST(UniformTension, LargeNetsTakeThePositionsAsUnknowns) {
  const Dish dish(6);
  const Net net = triangular_net(16, 0.4, dish);
  const ForceDensityResult result = find_tensions(net, VecX::Constant(net.branches.size(), 10), &dish, {});
  EXPECT_TRUE(result.converged) << result.reason;
  EXPECT_EQ(result.method, TensionMethod::position_newton);
  EXPECT_LE(result.iterations, 5);
  EXPECT_LE(result.inner_iterations, 40);
}

}  // namespace
}  // namespace tautline::formfinding
