#include "random.hpp"

#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>

namespace tautline::metamorphic {

namespace {

/// FNV-1a over the name, from the seed on.
std::uint64_t mixed(std::uint64_t seed, std::string_view name) {
  std::uint64_t hash = 1469598103934665603ULL ^ (seed * 0x9E3779B97F4A7C15ULL);
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return hash;
}

}  // namespace

Random::Random(std::uint64_t seed, std::string_view name) : engine_(mixed(seed, name)) {}

double Random::between(double low, double high) {
  return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1.0p-53;
}

double Random::magnitude(double low, double high) {
  return std::exp(between(std::log(low), std::log(high)));
}

int Random::whole(int low, int high) {
  return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
}

Vec3 Random::direction() {
  const double z = between(-1, 1), angle = between(0, 2 * std::numbers::pi), r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

Mat3 Random::rotation() {
  // Shoemake (1992): a unit quaternion evenly over the sphere of four dimensions
  const double u = between(0, 1), a = between(0, 2 * std::numbers::pi), b = between(0, 2 * std::numbers::pi);
  const double s = std::sqrt(1 - u), c = std::sqrt(u);
  return Eigen::Quaterniond(c * std::cos(b), s * std::sin(a), s * std::cos(a), c * std::sin(b))
      .toRotationMatrix();
}

std::vector<int> Random::order(int n) {
  std::vector<int> list(static_cast<std::size_t>(n));
  std::iota(list.begin(), list.end(), 0);
  for (int i = n - 1; i > 0; --i)
    std::swap(list[static_cast<std::size_t>(i)], list[static_cast<std::size_t>(whole(0, i))]);
  return list;
}

}  // namespace tautline::metamorphic
