#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <reflector/best_fit.hpp>
#include <tautline/core/error.hpp>
#include <tautline/reflector/surface_error.hpp>

namespace tautline::reflector {

namespace {

constexpr double speed_of_light = 299792458;  // [m/s]
constexpr double edge_size = 0.005;  // facets across the circle are split down to this part of its radius

using Triangle = std::array<Vec3, 3>;

/// Limit on the distance from the z axis; infinite if none was asked for. Nodes exactly on the circle are
/// inside.
double limit(double radius) {
  return radius > 0 ? radius * (1 + 1e-12) : std::numeric_limits<double>::infinity();
}

double distance_from_axis(const Vec3& point) {
  return std::hypot(point.x(), point.y());
}

/// Appends the points of a symmetric quadrature rule, exact to degree 4 (Strang & Fix 1973; Cowper 1973),
/// that lie inside.
void add_points(const Triangle& t, double radius, std::vector<WeightedPoint>& points) {
  static constexpr struct {
    double corner, other, weight;
  } orbits[] = {{0.816847572980458513, 0.091576213509770743, 0.109951743655321868},
                {0.108103018168070227, 0.445948490915964886, 0.223381589678011466}};
  const double area = (t[1] - t[0]).cross(t[2] - t[0]).norm() / 2;
  for (const auto& orbit : orbits) {
    for (int i = 0; i < 3; ++i) {
      const Vec3 point = orbit.corner * t[i] + orbit.other * (t[(i + 1) % 3] + t[(i + 2) % 3]);
      if (distance_from_axis(point) <= radius) points.push_back({point, orbit.weight * area});
    }
  }
}

void add_triangle(const Triangle& t, double radius, std::vector<WeightedPoint>& points) {
  const Vec3 centroid = (t[0] + t[1] + t[2]) / 3;
  double size = 0;
  for (const Vec3& corner : t) size = std::max(size, distance_from_axis(corner - centroid));
  const bool may_cross = std::abs(distance_from_axis(centroid) - radius) < size;
  if (!may_cross || size < edge_size * radius) return add_points(t, radius, points);
  const Triangle middle{(t[0] + t[1]) / 2, (t[1] + t[2]) / 2, (t[2] + t[0]) / 2};
  add_triangle(middle, radius, points);
  for (int i = 0; i < 3; ++i) add_triangle({t[i], middle[i], middle[(i + 2) % 3]}, radius, points);
}

/// Appends Gauss's rule of three points, exact to degree 5, of each part of a line that crosses the circle.
void add_line(const Vec3& a, const Vec3& b, double radius, std::vector<WeightedPoint>& points) {
  const double inner = std::min(distance_from_axis(a), distance_from_axis(b));
  const double outer = std::max(distance_from_axis(a), distance_from_axis(b)), length = (b - a).norm();
  if (inner <= radius && outer > radius && length > edge_size * radius) {
    const Vec3 middle = (a + b) / 2;
    add_line(a, middle, radius, points);
    return add_line(middle, b, radius, points);
  }
  const double wing = std::sqrt(0.15);
  for (const auto& [place, weight] :
       {std::pair{0.5 - wing, 5. / 18}, {0.5, 8. / 18}, {0.5 + wing, 5. / 18}}) {
    const Vec3 point = a + place * (b - a);
    if (distance_from_axis(point) <= radius) points.push_back({point, weight * length});
  }
}

std::vector<WeightedPoint> quadrature(const SurfaceSample& sample) {
  std::vector<WeightedPoint> points;
  for (const auto& [a, b] : sample.lines)
    add_line(sample.positions[a], sample.positions[b], limit(sample.radius), points);
  for (const auto& [a, b, c] : sample.triangles)
    add_triangle({sample.positions[a], sample.positions[b], sample.positions[c]}, limit(sample.radius),
                 points);
  return points;
}

/// Those of `nodes` that lie inside the radius, each with weight one.
std::vector<WeightedPoint> nodes_inside(const SurfaceSample& sample, const std::vector<int>& nodes) {
  std::vector<WeightedPoint> points;
  for (const int node : nodes)
    if (distance_from_axis(sample.positions[node]) <= limit(sample.radius))
      points.push_back({sample.positions[node], 1.0});
  return points;
}

struct Moments {
  double mean = 0, rms = 0, rms_about_mean = 0;
};

Moments moments(const std::vector<WeightedPoint>& points, const std::function<double(const Vec3&)>& error) {
  Moments m;
  if (points.empty()) return m;
  std::vector<double> errors;
  double weights = 0;
  for (const auto& [point, weight] : points) {
    errors.push_back(error(point));
    weights += weight;
    m.mean += weight * errors.back();
  }
  m.mean /= weights;
  for (std::size_t i = 0; i < points.size(); ++i) {
    m.rms += points[i].weight * errors[i] * errors[i] / weights;
    m.rms_about_mean += points[i].weight * (errors[i] - m.mean) * (errors[i] - m.mean) / weights;
  }
  m.rms = std::sqrt(m.rms);
  m.rms_about_mean = std::sqrt(m.rms_about_mean);
  return m;
}

/// Half the change of the path from the aperture plane over the surface to the focus [m].
double half_path_error(const Paraboloid& surface, const Vec3& point) {
  const Vec3 p = surface.to_parent(point);
  const double f = surface.focal_length(), r_squared = p.x() * p.x() + p.y() * p.y();
  return (p.z() - r_squared / (4 * f)) / (1 + r_squared / (4 * f * f));
}

/// Ruze's loss, eq. (3.3) [dB].
double gain_loss(double rms, double frequency) {
  if (!(frequency > 0)) return 0;
  const double phase = 4 * std::numbers::pi * rms * frequency / speed_of_light;
  return -10 * phase * phase / std::numbers::ln10;
}

}  // namespace

double deviation(const Paraboloid& surface, const Vec3& point) {
  return point.z() - surface.height(point.x(), point.y());
}

SurfaceError measure_surface(const Paraboloid& surface, const SurfaceSample& sample) {
  const auto along_z = [&](const Vec3& point) { return deviation(surface, point); };
  const auto nodes = nodes_inside(sample, sample.surface_nodes);
  const auto area = quadrature(sample);
  if (nodes.empty() || area.empty())
    throw ModelError(sample.radius > 0
                         ? fmt::format("no cloth or net lies within {} m of the axis", sample.radius)
                         : std::string("there is no cloth or net to measure"));
  SurfaceError e;
  e.radius = sample.radius > 0 ? sample.radius : 0;
  e.samples = static_cast<int>(nodes.size());
  e.frequency = sample.frequency;

  const Moments over_nodes = moments(nodes, along_z);
  e.rms = over_nodes.rms_about_mean;
  e.mean_shift = over_nodes.mean;
  e.rms_direct = over_nodes.rms;
  e.rms_nodes = moments(nodes_inside(sample, sample.net_nodes), along_z).rms_about_mean;
  const Moments over_area = moments(area, along_z);
  e.rms_area_weighted = over_area.rms_about_mean;
  e.rms_area_weighted_direct = over_area.rms;
  e.rms_half_path = moments(area, [&](const Vec3& p) { return half_path_error(surface, p); }).rms_about_mean;

  const BestFit fit = fit_paraboloid(surface, area);
  e.rms_best_fit = fit.rms;
  e.best_fit_focal_length = fit.focal_length;
  e.best_fit_converged = fit.converged;
  e.gain_loss_db = gain_loss(e.rms, e.frequency);
  e.gain_loss_half_path_db = gain_loss(e.rms_half_path, e.frequency);
  return e;
}

}  // namespace tautline::reflector
