#pragma once
/// @file
/// Random numbers that are the same on every machine: the engine of the standard, distributions of our own.

#include <cstdint>
#include <random>
#include <string_view>
#include <vector>

#include <tautline/core/types.hpp>

namespace tautline::metamorphic {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  /// Another stream for every pair of a seed and a name.
  Random(std::uint64_t seed, std::string_view name);

  /// Evenly between two numbers.
  double between(double low, double high);
  /// Evenly between the logarithms of two positive numbers.
  double magnitude(double low, double high);
  /// low, low + 1, ..., high
  int whole(int low, int high);
  bool chance(double probability) { return between(0, 1) < probability; }
  /// Evenly over the unit sphere.
  Vec3 direction();
  /// Evenly over all rotations.
  Mat3 rotation();
  /// 0, 1, ..., n - 1 in random order
  std::vector<int> order(int n);
  template <class T>
  const T& one_of(const std::vector<T>& list) {
    return list[static_cast<std::size_t>(whole(0, static_cast<int>(list.size()) - 1))];
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace tautline::metamorphic
