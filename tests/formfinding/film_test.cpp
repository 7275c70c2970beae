/// Films of given stress on meshes of every kind: triangles with diagonals one way, alternating and at
/// random, quadrilaterals; inner nodes displaced at random.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <formfinding/elastic_nets.hpp>
#include <formfinding/film_element.hpp>
#include <formfinding/net_system.hpp>
#include <random>
#include <tautline/element/membrane.hpp>
#include <tautline/formfinding/dynamic_relaxation.hpp>
#include <tautline/formfinding/minimal_film.hpp>

namespace tautline::formfinding {
namespace {

enum class Cells { one_way, alternating, random, quadrilaterals };

/// Facets of an n x n grid of nodes numbered row by row.
std::vector<FilmFacet> cells(int n, Cells kind, const std::array<double, 2>& stress, std::mt19937& random) {
  std::vector<FilmFacet> facets;
  const auto at = [&](int i, int j) { return j * (n + 1) + i; };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
      const bool other =
          kind == Cells::alternating ? (i + j) % 2 == 1 : kind == Cells::random && random() % 2 == 1;
      if (kind == Cells::quadrilaterals) {
        facets.push_back({{a, b, c, d}, stress});
      } else if (other) {
        facets.push_back({{a, b, d}, stress});
        facets.push_back({{b, c, d}, stress});
      } else {
        facets.push_back({{a, b, c}, stress});
        facets.push_back({{a, c, d}, stress});
      }
    }
  return facets;
}

/// A film over the square |x|, |y| <= 1 at the heights of `surface`, inner nodes displaced in plan by up to a
/// quarter of a cell.
template <class Height>
Film over_square(int n, Cells kind, const std::array<double, 2>& stress, unsigned seed,
                 const Height& height) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(-0.25, 0.25);
  Film film;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const bool edge = i % n == 0 || j % n == 0;
      const double x = -1 + 2 * (i + (edge ? 0 : part(random))) / n,
                   y = -1 + 2 * (j + (edge ? 0 : part(random))) / n;
      film.net.nodes.emplace_back(x, y, height(x, y));
      film.net.fixed.push_back(edge);
    }
  film.facets = cells(n, kind, stress, random);
  return film;
}

/// A tent of 10 m x 8 m between two low and two high corners, ropes of 30 kN around 2000 N/m.
Film tent(int n, Cells kind, unsigned seed) {
  Film film = over_square(n, kind, {2000, 2000}, seed, [](double x, double y) { return 1.5 - 1.5 * x * y; });
  for (Vec3& node : film.net.nodes) node = Vec3(5 * node.x(), 4 * node.y(), node.z());
  const auto at = [&](int i, int j) { return j * (n + 1) + i; };
  std::fill(film.net.fixed.begin(), film.net.fixed.end(), false);
  for (const int corner : {at(0, 0), at(n, 0), at(0, n), at(n, n)}) film.net.fixed[corner] = true;
  for (int k = 0; k < n; ++k)
    for (const auto& side : {std::array{at(k, 0), at(k + 1, 0)}, std::array{at(k, n), at(k + 1, n)},
                             std::array{at(0, k), at(0, k + 1)}, std::array{at(n, k), at(n, k + 1)}})
      film.net.branches.push_back(side);
  film.cable_tension = VecX::Constant(static_cast<Eigen::Index>(film.net.branches.size()), 30000);
  return film;
}

double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

/// Largest force at a free node: what crosses half of the opposite side pulls the corner of a triangle.
double out_of_balance(const Film& film, const Points& nodes, const Points& stress, double tension) {
  Points force(nodes.size(), Vec3::Zero());
  for (const auto& [i, j] : film.net.branches) {
    const Vec3 pull = tension * (nodes[j] - nodes[i]).normalized();
    force[i] += pull;
    force[j] -= pull;
  }
  for (std::size_t f = 0; f < film.facets.size(); ++f) {
    const auto& n = film.facets[f].nodes;
    Mat3 x;
    x << nodes[n[0]], nodes[n[1]], nodes[n[2]];
    const Mat<3, 2> axes = element::membrane_frame<3>(x).leftCols<2>();
    const Mat<2> tensor = (Mat<2>() << stress[f][0], stress[f][2], stress[f][2], stress[f][1]).finished();
    const Vec3 normal = (x.col(1) - x.col(0)).cross(x.col(2) - x.col(0)).normalized();
    for (int k = 0; k < 3; ++k)
      force[n[k]] +=
          0.5 * axes * tensor * axes.transpose() * (x.col((k + 2) % 3) - x.col((k + 1) % 3)).cross(normal);
  }
  double most = 0;
  for (std::size_t i = 0; i < force.size(); ++i)
    if (!film.net.fixed[i]) most = std::max(most, force[i].norm());
  return most;
}

class EveryMesh : public ::testing::TestWithParam<Cells> {};
INSTANTIATE_TEST_SUITE_P(Cells, EveryMesh,
                         ::testing::Values(Cells::one_way, Cells::alternating, Cells::random,
                                           Cells::quadrilaterals));

TEST_P(EveryMesh, CarriesWhatIsAskedForAndRests) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const Film film = tent(8, GetParam(), seed);
    const FilmResult result = find_minimal_film(film);
    ASSERT_TRUE(result.converged) << result.reason;
    EXPECT_LE(largest(film_unevenness(film.facets, result.stress, result.nodes)), 0.03);
    // A quadrilateral is given one stress: the mean of what its points carry.
    const bool triangles = GetParam() != Cells::quadrilaterals;
    EXPECT_LE(result.out_of_balance, (triangles ? 1e-8 : 1e-4) * 30000);
    EXPECT_EQ(result.cable_tension, film.cable_tension);
    if (triangles) {
      EXPECT_LE(out_of_balance(film, result.nodes, result.stress, 30000), 1e-8 * 30000);
    }
  }
}

TEST_P(EveryMesh, RelaxesToTheSameFilm) {
  const Film film = tent(6, GetParam(), 4);
  const FilmResult found = find_minimal_film(film);
  ElasticNet net{film.net, {}, {}, film.cable_tension, film.facets};
  const RelaxationResult relaxed = relax(net);
  ASSERT_TRUE(relaxed.converged) << relaxed.reason;
  EXPECT_LE(largest(film_unevenness(film.facets, relaxed.stress, relaxed.nodes)), 0.03);
  for (std::size_t i = 0; i < film.net.nodes.size(); ++i)
    EXPECT_LE((relaxed.nodes[i] - found.nodes[i]).norm(), 1e-5) << i;  // of meshes of 1.3 m
}

double root_mean_square(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// Mean over several meshes of what `measure` finds on one.
template <class Measure>
double mean_of_meshes(const Measure& measure) {
  double sum = 0;
  for (const unsigned seed : {1U, 2U, 3U, 4U}) sum += measure(seed) / 4;
  return sum;
}

double unevenness_of_tent(int n, Cells kind) {
  return mean_of_meshes([&](unsigned seed) {
    const Film film = tent(n, kind, seed);
    const FilmResult result = find_minimal_film(film);
    EXPECT_TRUE(result.converged) << result.reason;
    return root_mean_square(film_unevenness(film.facets, result.stress, result.nodes));
  });
}

TEST_P(EveryMesh, UnevennessFallsWithTheSquareOfTheMesh) {
  EXPECT_NEAR(std::log2(unevenness_of_tent(6, GetParam()) / unevenness_of_tent(12, GetParam())), 2, 0.3);
}

/// Distance along z from Scherk's surface z = log(cos y / cos x), scaled to the square, of a film on its
/// edge.
double scherk_error(int n, Cells kind) {
  const double a = 0.7;
  const auto scherk = [&](double x, double y) { return std::log(std::cos(a * y) / std::cos(a * x)) / a; };
  return mean_of_meshes([&](unsigned seed) {
    const FilmResult result = find_minimal_film(over_square(n, kind, {1, 1}, seed, scherk));
    EXPECT_TRUE(result.converged) << result.reason;
    std::vector<double> error;
    for (const Vec3& p : result.nodes) error.push_back(p.z() - scherk(p.x(), p.y()));
    return root_mean_square(error);
  });
}

TEST_P(EveryMesh, ScherkSurfaceIsApproachedWithTheSquareOfTheSide) {
  // Meshes of random cells are not similar to each other, so the order is one of the mean only.
  const double coarse = scherk_error(16, GetParam()), fine = scherk_error(32, GetParam());
  EXPECT_LE(fine, 1e-3);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.4);
}

/// @brief Largest error of the rise of a shallow film with the stresses 3 along x and 1 along y: s1 z,xx + s2
/// z,yy = 0 has the solution rise (x^2 - 3 y^2), up to the square of the slope.
double shallow_error(int n, Cells kind, double rise) {
  const auto saddle = [&](double x, double y) { return rise * (x * x - 3 * y * y); };
  const FilmResult result = find_minimal_film(over_square(n, kind, {3, 1}, 5, saddle));
  EXPECT_TRUE(result.converged) << result.reason;
  double most = 0;
  for (const Vec3& p : result.nodes) most = std::max(most, std::abs(p.z() - saddle(p.x(), p.y())));
  return most / rise;
}

TEST_P(EveryMesh, UnequalStressesAreThoseAlongAndAcrossTheOrientation) {
  // The mesh leaves about half of the square of its side, 2/12.
  EXPECT_LE(shallow_error(12, GetParam(), 0.01), 0.02);
}

TEST_P(EveryMesh, ARotatedFilmIsTheSame) {
  const auto saddle = [](double x, double y) { return 0.1 * (x * x - 3 * y * y); };
  const Film film = over_square(6, GetParam(), {3, 2}, 6, saddle);
  Film turned = film;
  const Mat3 R = Eigen::AngleAxisd(1.1, Vec3(1, -2, 3).normalized()).toRotationMatrix();
  for (Vec3& node : turned.net.nodes) node = R * node + Vec3(3, -1, 2);
  for (auto& facet : turned.facets) facet.orientation = R * facet.orientation;
  const FilmResult a = find_minimal_film(film), b = find_minimal_film(turned);
  ASSERT_TRUE(a.converged && b.converged) << a.reason << b.reason;
  for (std::size_t i = 0; i < film.net.nodes.size(); ++i)
    EXPECT_LE((R * a.nodes[i] + Vec3(3, -1, 2) - b.nodes[i]).norm(), 1e-6);
  for (std::size_t f = 0; f < film.facets.size(); ++f) EXPECT_LE((a.stress[f] - b.stress[f]).norm(), 1e-5);
}

TEST(Film, APointThatHoldsItIsNamed) {
  // No catenoid leads from a ring to a point: the neck closes.
  Film film = over_square(8, Cells::alternating, {1, 1}, 1, [](double, double) { return 0.0; });
  film.net.nodes[40] = Vec3(0, 0, 1.5);
  film.net.fixed[40] = true;
  MinimalFilmOptions options;
  options.max_iterations = 100;
  const FilmResult result = find_minimal_film(film, options);
  const bool even =
      result.converged && largest(film_unevenness(film.facets, result.stress, result.nodes)) < 0.03;
  EXPECT_FALSE(even);
  if (!result.converged) {
    EXPECT_NE(result.reason.find("single point, (0, 0, 1.5)"), std::string::npos) << result.reason;
  }
}

/// Three cells in a row: the middle one of quadrilaterals, or the two triangles of it, pulled over its
/// neighbour.
TEST(Film, SidesAtWhichFacetsHaveTurnedOverAreCounted) {
  Net drawn;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 2; ++j) drawn.nodes.emplace_back(i, j, 0);
  std::vector<FilmFacet> quadrilaterals, triangles;
  for (int i = 0; i < 3; ++i) {
    const int a = 2 * i, b = a + 2, c = a + 3, d = a + 1;
    quadrilaterals.push_back({{a, b, c, d}, {1, 1}});
    triangles.push_back({{a, b, c}, {1, 1}});
    triangles.push_back({{a, c, d}, {1, 1}});
  }
  Points found = drawn.nodes;
  for (const auto* facets : {&quadrilaterals, &triangles})
    EXPECT_EQ(turned_over(drawn, *facets, to_coordinates(found)), "");
  found[4].x() = found[5].x() = 0.5;  // the middle cell from x = 1 back to 0.5
  for (const auto* facets : {&quadrilaterals, &triangles}) {
    const auto text = turned_over(drawn, *facets, to_coordinates(found));
    EXPECT_NE(text.find("turned over at 2 sides"), std::string::npos) << text;
  }
  // A quadrilateral is what its whole area says, though one of its triangles is upright still.
  found = drawn.nodes;
  found[2] = Vec3(-1, 1.5, 0);
  const Vec3 upright = (found[3] - found[0]).cross(found[1] - found[0]),
             whole = (found[3] - found[0]).cross(found[1] - found[2]);
  ASSERT_GT(upright.z(), 0);
  ASSERT_LT(whole.z(), 0);
  EXPECT_NE(turned_over(drawn, quadrilaterals, to_coordinates(found)).find("turned over at 1 side"),
            std::string::npos);
}

TEST(Film, FacetsOfEitherOrientationAreOneFilm) {
  Film film = tent(6, Cells::random, 3), mixed = film;
  for (std::size_t f = 0; f < mixed.facets.size(); f += 3) {
    const auto& n = mixed.facets[f].nodes;
    mixed.facets[f].nodes = model::FacetNodes(n[0], n[2], n[1]);
  }
  const FilmResult a = find_minimal_film(film), b = find_minimal_film(mixed);
  ASSERT_TRUE(b.converged) << b.reason;
  for (std::size_t i = 0; i < film.net.nodes.size(); ++i) EXPECT_LE((a.nodes[i] - b.nodes[i]).norm(), 1e-6);
}

TEST(Film, NodesFollowEdgesThatMoveFartherThanAMesh) {
  // Ropes of 10 kN are arcs of 5 m: the middles of the edges move by more than a metre, cells are 0.5 m.
  const Film film = [] {
    Film f = tent(16, Cells::random, 7);
    f.cable_tension.setConstant(15000);
    return f;
  }();
  const FilmResult found = find_minimal_film(film);
  EXPECT_TRUE(found.converged) << found.reason;
  EXPECT_LE(largest(film_unevenness(film.facets, found.stress, found.nodes)), 0.03);
  const RelaxationResult relaxed = relax({film.net, {}, {}, film.cable_tension, film.facets});
  EXPECT_TRUE(relaxed.converged) << relaxed.reason;
}

}  // namespace
}  // namespace tautline::formfinding
