#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <reflector/y_umbrella_layout.hpp>
#include <tautline/core/error.hpp>

namespace tautline::reflector {

YUmbrellaLayout::YUmbrellaLayout(const YUmbrellaOptions& options)
    : options_(options),
      surface_(make_paraboloid(options)),
      half_sector_(std::numbers::pi / options.spokes),
      tip_radius_(std::isnan(options.tip_radius) ? options.aperture / 2 : options.tip_radius) {
  for (int s = 0; s < options.spokes; ++s)
    for (int k = 0; k <= options.rings; ++k)
      for (const double place : {0.0, 0.5}) {
        const Vec3 node = tangential(s, k, place);
        if (node.z() > 0) continue;
        throw ModelError(fmt::format(
            "front and rear net touch or cross: at x = {:.4g} m, y = {:.4g} m the surface is {:.4g} m "
            "above the plane of the spokes; give a larger surface_height ({:.4g} m)",
            node.x(), node.y(), node.z(), options.surface_height));
      }
}

double YUmbrellaLayout::azimuth(int s, double i) const {
  return 2 * half_sector_ * (s + i / options_.parts);
}

double YUmbrellaLayout::radius_of(int k) const {
  return options_.hub_radius + (options_.ring_radius - options_.hub_radius) * k / (options_.rings + 1);
}

int YUmbrellaLayout::parts_of(int k) const {
  return std::max(1, static_cast<int>(std::lround(options_.parts * radius_of(k) / options_.ring_radius)));
}

Vec3 YUmbrellaLayout::in_plane(int s, double radius) const {
  return {radius * std::cos(azimuth(s, 0)), radius * std::sin(azimuth(s, 0)), 0};
}

Vec3 YUmbrellaLayout::tangential(int s, int k, double place) const {
  const double radius = radius_of(k);
  const Vec3 p = (1 - place) * in_plane(s, radius) + place * in_plane(s + 1, radius);
  return {p.x(), p.y(), surface_.height(p.x(), p.y())};
}

double YUmbrellaLayout::ring_radius(int i) const {
  const double at_spoke = options_.ring_radius, cosine = std::cos(half_sector_);
  const double middle = at_spoke * (cosine - 2 * options_.ring_sag * std::sin(half_sector_));
  const double amplitude = (1 / middle - 1 / at_spoke) / (1 - cosine);
  const double angle = half_sector_ * (2.0 * i / options_.parts - 1);
  return 1 / (1 / middle - amplitude * (1 - std::cos(angle)));
}

Vec3 YUmbrellaLayout::on_surface(int s, int i, double radius) const {
  const double x = radius * std::cos(azimuth(s, i)), y = radius * std::sin(azimuth(s, i));
  return {x, y, surface_.height(x, y)};
}

Vec3 YUmbrellaLayout::rear_chord(int s, int i, double radius) const {
  const Vec3 a = on_surface(s, 0, radius), b = on_surface(s + 1, 0, radius);
  // Where the chord meets the vertical plane at place i.
  const double angle = half_sector_ * (2.0 * i / options_.parts - 1);
  const double place = (1 + std::tan(angle) / std::tan(half_sector_)) / 2;
  const Vec3 p = (1 - place) * a + place * b;
  return {p.x(), p.y(), -p.z()};
}

Vec3 YUmbrellaLayout::sagging(int s, int i, double radius, double sag, const Vec3& towards) const {
  const Vec3 chord = rear_chord(s, i, radius);
  const double place = double(i) / options_.parts, span = 2 * radius * std::sin(half_sector_);
  return chord + 4 * place * (1 - place) * sag * span * (towards - chord).normalized();
}

YUmbrellaLayout::Braced YUmbrellaLayout::braced(int s, int i) const {
  Braced b;
  b.ring = on_surface(s, i, ring_radius(i));
  b.outer = on_surface(s, i, tip_radius_);
  b.rear_ring = sagging(s, i, options_.ring_radius, options_.rear_ring_sag, b.outer);
  b.rear_outer = sagging(s, i, tip_radius_, options_.rear_outer_sag, b.ring);
  // All four lie in one vertical plane; the X crosses there.
  const Vec3 first = b.rear_outer - b.ring, second = b.rear_ring - b.outer;
  const Vec3 normal = first.cross(second);
  b.crossing = b.ring + (b.outer - b.ring).cross(second).dot(normal) / normal.squaredNorm() * first;
  return b;
}

}  // namespace tautline::reflector
