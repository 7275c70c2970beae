#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <reflector/rim_net.hpp>
#include <tautline/core/error.hpp>
#include <tautline/reflector/surface_error.hpp>

namespace tautline::reflector {
namespace {

/// Hexagon of equilateral facets (projected side `s`), nodes at height(x, y).
SurfaceSample hexagon(int rings, double s, const std::function<double(double, double)>& height) {
  SurfaceSample sample;
  std::map<std::array<int, 2>, int> number;
  for (int i = -rings; i <= rings; ++i) {
    for (int j = -rings; j <= rings; ++j) {
      if (std::abs(i + j) > rings) continue;
      const double x = s * (i + 0.5 * j), y = s * std::sqrt(0.75) * j;
      number[{i, j}] = static_cast<int>(sample.positions.size());
      sample.surface_nodes.push_back(number[{i, j}]);
      sample.positions.emplace_back(x, y, height(x, y));
    }
  }
  const auto add = [&](std::array<int, 2> a, std::array<int, 2> b, std::array<int, 2> c) {
    if (number.count(a) && number.count(b) && number.count(c))
      sample.triangles.push_back({number[a], number[b], number[c]});
  };
  for (int i = -rings; i <= rings; ++i) {
    for (int j = -rings; j <= rings; ++j) {
      add({i, j}, {i + 1, j}, {i, j + 1});
      add({i + 1, j}, {i + 1, j + 1}, {i, j + 1});
    }
  }
  sample.net_nodes = sample.surface_nodes;
  return sample;
}

/// Every facet cut into n^2 flat ones by equally spaced points on its sides.
SurfaceSample subdivided(const Points& nodes, const model::Model& model, int n) {
  SurfaceSample sample;
  std::map<std::array<long, 3>, int> number;
  const auto add = [&](const Vec3& point) {
    const std::array<long, 3> key{std::lround(point.x() * 1e8), std::lround(point.y() * 1e8),
                                  std::lround(point.z() * 1e8)};
    const auto [place, is_new] = number.try_emplace(key, static_cast<int>(sample.positions.size()));
    if (is_new) {
      sample.positions.push_back(point);
      sample.surface_nodes.push_back(place->second);
    }
    return place->second;
  };
  for (const auto& membrane : model.membranes) {
    const int a = membrane.nodes[0], b = membrane.nodes[1], c = membrane.nodes[2];
    const auto at = [&](int i, int j) {
      return add((nodes[a] * (n - i - j) + nodes[b] * i + nodes[c] * j) / n);
    };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        sample.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
        if (i + j + 1 < n) sample.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
  }
  return sample;
}

std::function<double(double, double)> on(const Paraboloid& surface) {
  return [&surface](double x, double y) { return surface.height(x, y); };
}

TEST(SurfaceError, OfFlatFacetsHasTheClosedForm) {
  // Nodes on z = r^2/4f, equilateral facets of projected side s: the error is s^2 (l1 l2 + l2 l3 + l3 l1) /
  // 4f, its mean s^2/16f, its rms about the mean s^2/(16 sqrt(15) f). A degree-4 rule is exact; what remains
  // is rounding.
  const double f = 6, s = 0.75;
  const Paraboloid dish(12, f, -6);
  const SurfaceError error = measure_surface(dish, hexagon(8, s, on(dish)));
  EXPECT_NEAR(error.rms_area_weighted, 0.0161374306 * s * s / f, 1e-10 * s * s);
  EXPECT_NEAR(error.rms_area_weighted_direct, s * s / (4 * std::sqrt(15.0) * f), 1e-10 * s * s);
  EXPECT_NEAR(error.rms_nodes, 0, 1e-15);
  EXPECT_NEAR(error.rms, 0, 1e-15);
}

TEST(SurfaceError, OfANetWithoutClothIsTakenAlongItsCords) {
  // A straight side of projected length s with its ends on z = r^2/4f: the error is (s^2/4 - x^2)/4f, its
  // mean s^2/24f, its rms about the mean sqrt(4/45) s^2/16f. A degree-5 rule is exact.
  const double f = 6, s = 0.75;
  const Paraboloid dish(12, f, -6);
  SurfaceSample net = hexagon(8, s, on(dish));
  for (const auto& [a, b, c] : net.triangles)
    for (const auto& side : {std::array{a, b}, {b, c}, {c, a}}) net.lines.push_back(side);
  net.triangles.clear();
  const SurfaceError error = measure_surface(dish, net);
  EXPECT_NEAR(error.rms_area_weighted, std::sqrt(4.0 / 45) * s * s / (16 * f), 1e-10 * s * s);
  EXPECT_NEAR(error.rms_area_weighted_direct, std::sqrt(8.0 / 15) * s * s / (16 * f), 1e-10 * s * s);
  EXPECT_NEAR(error.rms, 0, 1e-15);
}

TEST(SurfaceError, OfCordsStopsAtTheCircle) {
  // What lies outside the circle has no weight, even where the cords that cross the circle end.
  const Paraboloid dish(12, 6, -6);
  SurfaceSample net = hexagon(8, 0.7, on(dish));
  for (const auto& [a, b, c] : net.triangles) net.lines.push_back({a, b});
  net.triangles.clear();
  net.radius = 2;
  const double inside = measure_surface(dish, net).rms_area_weighted_direct;
  for (Vec3& p : net.positions)
    if (std::hypot(p.x(), p.y()) > 2.8) p.z() += 1;  // farther than cords of 0.7 m that cross the circle
  EXPECT_NEAR(measure_surface(dish, net).rms_area_weighted_direct, inside, 1e-14);
}

TEST(SurfaceError, NodesOnTheCircleAreInside) {
  // Within two rings of a hexagonal lattice: the centre, 6 neighbours, 6 corners at 1.4 m, 6 between them
  // at 1.21 m.
  const Paraboloid dish(12, 8, 1.125);
  SurfaceSample net = hexagon(8, 0.7, on(dish));
  net.radius = 1.4;
  EXPECT_EQ(measure_surface(dish, net).samples, 19);
  net.radius = 1.4 * (1 - 1e-8);
  EXPECT_EQ(measure_surface(dish, net).samples, 13);
}

TEST(SurfaceError, UniformShiftIsAllMeanShift) {
  const Paraboloid dish(12, 8, 1.125);
  const double shift = 0.0037;
  const SurfaceError error =
      measure_surface(dish, hexagon(8, 0.7, [&](double x, double y) { return dish.height(x, y) + shift; }));
  EXPECT_NEAR(error.mean_shift, shift, 1e-15);
  EXPECT_NEAR(error.rms_direct, shift, 1e-15);
  EXPECT_NEAR(error.rms, 0, 1e-15);
  EXPECT_EQ(error.samples, 217);
  EXPECT_NEAR(deviation(dish, {1, 2, dish.height(1, 2) - 0.5}), -0.5, 1e-15);
}

/// Facets far smaller than the motions, so that faceting (s^2/16 sqrt(15) f) is below the tolerances.
SurfaceSample fine_exact(const Paraboloid& surface) {
  return hexagon(50, 0.11, on(surface));
}

TEST(SurfaceError, BestFitUndoesRigidMotionAndRefocusing) {
  const Mat3 turn = Eigen::AngleAxisd(0.004, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  for (const double clearance : {1.125, -6.0}) {
    const double f = 8.03;
    SurfaceSample sample = fine_exact(Paraboloid(12, f, clearance));
    for (Vec3& point : sample.positions) point = turn * point + Vec3(0.01, -0.02, 0.03);
    const SurfaceError error = measure_surface(Paraboloid(12, 8, clearance), sample);
    const double faceting = 0.0161374306 * 0.11 * 0.11 / 8;
    EXPECT_GT(error.rms_area_weighted, 0.005);
    EXPECT_LT(error.rms_best_fit, 1.5 * faceting);  // facets are a little larger where the dish is steep
    EXPECT_NEAR(error.best_fit_focal_length, f, 1e-3 * 0.03);
  }
}

TEST(SurfaceError, BestFitIsNeverWorseThanTheAxialShift) {
  const Paraboloid dish(12, 8, 1.125);
  const SurfaceError error =
      measure_surface(dish, hexagon(8, 0.7, [&](double x, double y) {
                        return dish.height(x, y) + 0.002 * std::sin(3 * x) * std::cos(2 * y);
                      }));
  EXPECT_LT(error.rms_best_fit, error.rms_area_weighted);
  EXPECT_GT(error.rms_best_fit, 0.5 * error.rms_area_weighted);
}

/// A dish of the aperture's size with a deviation of low order, of `amplitude` at the rim.
SurfaceSample rough(const Paraboloid& dish, double amplitude) {
  const double r = dish.aperture() / 2;
  return hexagon(8, dish.aperture() / 17, [&](double x, double y) {
    const double u = x / r, v = y / r;
    return dish.height(x, y) + amplitude * (u * u * u + 0.5 * v * v - 0.7 * u * v + 0.2 * std::sin(5 * u));
  });
}

/// References by an independent least squares: Levenberg and Marquardt's method in Python with derivatives by
/// differences, rotations about the vertex, the focal length itself, and Radon's rule of seven points (degree
/// 5), which differs from the rule of degree 4 here by some 1e-5.
TEST(SurfaceError, BestFitOfRoughDishesIsThatOfAnIndependentLeastSquares) {
  struct {
    double aperture, focal_length, clearance, part, rms, found;
  } cases[] = {{12, 8, 1.125, 0.02, 0.006784954723, 7.255650491},
               {12, 8, 1.125, 0.1, 0.0331345692, 4.808327155},
               {12, 6, -6, 0.02, 0.01307238775, 5.650715739},
               {12, 6, -6, 0.1, 0.03850364387, 4.137797445},
               {120, 48, 10, 0.02, 0.07220032624, 45.19215842},
               {120, 48, 10, 0.1, 0.3530175286, 34.7440848},
               {0.012, 0.008, 0.001125, 0.1, 3.31345692e-05, 0.004808327155}};
  for (const auto& c : cases) {
    const Paraboloid dish(c.aperture, c.focal_length, c.clearance);
    const SurfaceError error = measure_surface(dish, rough(dish, c.part * c.aperture / 2));
    EXPECT_NEAR(error.rms_best_fit, c.rms, 1e-4 * c.rms) << c.aperture << " m, " << c.part;
    EXPECT_NEAR(error.best_fit_focal_length, c.found, 1e-4 * c.found);
    EXPECT_TRUE(error.best_fit_converged);
  }
}

TEST(SurfaceError, BestFitOfADishTurnedAndMovedFarIsThatOfTheDishItself) {
  // Turned by half a radian and moved by metres; reference as above.
  const Paraboloid dish(12, 8, 1.125);
  SurfaceSample sample = rough(dish, 0.1);
  const Vec3 turn(0.3, -0.5, 0.2);
  for (Vec3& point : sample.positions)
    point = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * point + Vec3(1.5, -2, 0.8);
  const SurfaceError error = measure_surface(dish, sample);
  // Seen along a line that is turned by so much, the surface has more than one best place, within 1 %.
  EXPECT_NEAR(error.rms_best_fit, 0.006844112198, 1e-2 * 0.006844112198);
  EXPECT_NEAR(error.best_fit_focal_length, 7.359538008, 1e-3 * 7.36);
  // Facets alone, far from where they belong.
  for (const double clearance : {1.125, -6.0, 20.0}) {
    const Paraboloid wanted(12, 8, clearance);
    SurfaceSample exact = hexagon(24, 0.23, on(Paraboloid(12, 9, clearance)));
    for (Vec3& point : exact.positions)
      point = Eigen::AngleAxisd(0.6, Vec3(1, 2, 3).normalized()) * point + Vec3(-2, 1, 3);
    const SurfaceError far = measure_surface(wanted, exact);
    EXPECT_LT(far.rms_best_fit, 5e-4) << "0.1 mm of facets, seen along a line that is turned";
    EXPECT_NEAR(far.best_fit_focal_length, 9, 0.01);
    EXPECT_TRUE(far.best_fit_converged);
  }
}

TEST(SurfaceError, BestFitIsNeverAboveTheOthersByArea) {
  for (int seed = 1; seed <= 20; ++seed) {
    const auto draw = [&](int i) { return std::sin(12.9898 * seed + 78.233 * i); };
    const Paraboloid dish(12, 6 + 4 * std::abs(draw(0)), seed % 3 == 0 ? -6 : 3 * std::abs(draw(1)));
    SurfaceSample sample = hexagon(5, 1.1, [&](double x, double y) { return dish.height(x, y); });
    int i = 2;
    for (Vec3& point : sample.positions) {
      point += std::pow(10, draw(7) - 1.5) * Vec3(draw(i), draw(i + 1), draw(i + 2));
      i += 3;
    }
    const SurfaceError error = measure_surface(dish, sample);
    EXPECT_LE(error.rms_best_fit, error.rms_area_weighted * (1 + 1e-12)) << seed;
    EXPECT_LE(error.rms_best_fit, error.rms_area_weighted_direct * (1 + 1e-12)) << seed;
    EXPECT_TRUE(error.best_fit_converged) << seed;
  }
}

TEST(SurfaceError, HalfPathErrorOfAnAxialWaveIsSmallerTowardsTheRim) {
  // delta = e_z / (1 + (r/2f)^2). With e_z = (1 + (r/2f)^2)(c + a x) the half path error is c + a x: over a
  // hexagon of circumradius R its rms about the mean is a R sqrt(5/24) (second moment of a regular hexagon).
  const double f = 6, a = 1e-3, R = 5;
  const Paraboloid dish(12, f, -6);
  const int rings = 80;
  const SurfaceError error =
      measure_surface(dish, hexagon(rings, R / rings, [&](double x, double y) {
                        const double r_squared = x * x + y * y;
                        return r_squared / (4 * f) + (1 + r_squared / (4 * f * f)) * (0.02 + a * x);
                      }));
  // The measure weighs by the area of the dish, not of its projection: sqrt(1 + (r/2f)^2) favours the rim by
  // up to 8 %.
  EXPECT_NEAR(error.rms_half_path, a * R * std::sqrt(5.0 / 24), 0.03 * a * R * std::sqrt(5.0 / 24));
  EXPECT_GT(error.rms_area_weighted, 1.05 * error.rms_half_path);
}

TEST(SurfaceError, HalfPathErrorIsHalfTheChangeOfThePath) {
  // The ray from the aperture plane down the axis to a point and on to the focus: moving the point along the
  // axis by e changes the length by -e (1 + cos) with cos = (f - z)/(f + z) on the surface. A shift of the
  // whole offset dish along the parent's axis checks the frame too.
  const Paraboloid dish(12, 8, 1.125);
  SurfaceSample sample = hexagon(40, 0.13, on(dish));
  const double e = 0.02;  // large against the faceting, s^2/(16 sqrt(15) f) = 0.03 mm
  double mean = 0, square = 0;
  for (Vec3& point : sample.positions) {
    const Vec3 parent = dish.to_parent(point);
    const double half_path = e * (1 + (8 - parent.z()) / (8 + parent.z())) / 2;
    mean += half_path / sample.positions.size();
    square += half_path * half_path / sample.positions.size();
    point += e * dish.axis();
  }
  // Nodes here, areas there: they differ by the edge nodes, of the order of one ring in forty.
  EXPECT_NEAR(measure_surface(dish, sample).rms_half_path, std::sqrt(square - mean * mean),
              0.05 * std::sqrt(square - mean * mean));
}

TEST(SurfaceError, AreaMeasuresDoNotDependOnTheMeshAtTheCircle) {
  const Paraboloid dish(12, 8, -6);
  const auto wave = [&](double x, double y) { return dish.height(x, y) + 1e-2 * x; };
  for (const int rings : {12, 60}) {
    SurfaceSample sample = hexagon(rings, 6.0 / rings, wave);
    sample.radius = 5;
    // Exact: mean 0 by symmetry, and over the disc of radius R, weighted by sqrt(1 + (r/2f)^2) with f = 8,
    // the mean square of x is int r^3 w dr / (2 int r w dr).
    double above = 0, below = 0;
    for (double r = 0.0005; r < 5; r += 0.001) {
      const double w = std::sqrt(1 + r * r / 256);
      above += r * r * r * w;
      below += 2 * r * w;
    }
    const double exact = 1e-2 * std::sqrt(above / below);
    EXPECT_NEAR(measure_surface(dish, sample).rms_area_weighted, exact, 1e-3 * exact);
  }
}

TEST(SurfaceError, OfTheFormFoundRimNetIsTheFacetingOfIndependentWork) {
  // Nodal rms of flat facets inside r = 5 m, from an independent program on its own form-found nodes: 0.966
  // and 0.847 mm for facets cut into 4^2 and 8^2.
  const model::Model model = make_perimeter_truss(rim_options());
  const auto net = front_net(model);
  const Paraboloid surface = make_paraboloid(rim_options());
  const auto form = find_tensions(net, VecX::Constant(net.branches.size(), 10), &surface, {});
  ASSERT_TRUE(form.converged);
  double area_weighted = 0;
  for (const auto& [n, expected] : {std::pair{4, 0.966e-3}, {8, 0.847e-3}}) {
    SurfaceSample sample = subdivided(form.nodes, model, n);
    sample.radius = 5;
    const SurfaceError error = measure_surface(surface, sample);
    EXPECT_NEAR(error.rms, expected, 0.005e-3) << n;
    if (area_weighted > 0) {
      EXPECT_NEAR(error.rms_area_weighted, area_weighted, 1e-3 * area_weighted);
    }
    area_weighted = error.rms_area_weighted;
  }
}

TEST(SurfaceError, GainLossIsThatOfRuze) {
  // A surface whose nodal rms is lambda/50, /30, /20: -(4 pi / n)^2 10/ln(10) dB = -0.2743, -0.762, -1.715.
  const Paraboloid dish(12, 6, -6);
  const double frequency = 10e9, wavelength = 299792458 / frequency;
  for (const auto& [part, loss, digits] :
       {std::array{50.0, -0.2743, 5e-5}, {30.0, -0.762, 5e-4}, {20.0, -1.715, 5e-4}}) {
    SurfaceSample sample = hexagon(3, 1, on(dish));
    for (std::size_t i = 0; i + 1 < sample.positions.size(); i += 2) {
      sample.positions[i].z() += wavelength / part;
      sample.positions[i + 1].z() -= wavelength / part;
    }
    sample.positions.back().z() = 0;
    sample.surface_nodes.pop_back();  // an even number, so that the mean is zero
    sample.frequency = frequency;
    EXPECT_NEAR(measure_surface(dish, sample).gain_loss_db, loss, digits);
  }
}

TEST(SurfaceError, NothingInsideTheRadiusIsAnError) {
  const Paraboloid dish(12, 6, -6);
  SurfaceSample sample = hexagon(2, 1, on(dish));
  for (Vec3& point : sample.positions) point.x() += 4;
  sample.radius = 0.5;
  EXPECT_THROW(measure_surface(dish, sample), ModelError);
}

}  // namespace
}  // namespace tautline::reflector
