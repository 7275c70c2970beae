#pragma once
/// Nets and surfaces shared by the tests of this folder.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <string>
#include <tautline/core/error.hpp>
#include <tautline/formfinding/net.hpp>
#include <vector>

namespace tautline::formfinding {

/// z = r^2 / 4f
class Dish : public Surface {
 public:
  explicit Dish(double f) : f_(f) {}
  double height(double x, double y) const { return (x * x + y * y) / (4 * f_); }
  Vec3 height_and_slope(double x, double y) const override {
    return {height(x, y), x / (2 * f_), y / (2 * f_)};
  }

 private:
  double f_;
};

/// Regular triangular net of side `s` inside a hexagon of `rings` rings, its edge fixed on the dish, the rest
/// at the origin.
inline Net triangular_net(int rings, double s, const Dish& dish) {
  Net net;
  const int width = 2 * rings + 1;
  std::vector<int> index(width * width, -1);
  const auto ring_of = [](int i, int j) { return std::max({std::abs(i), std::abs(j), std::abs(i + j)}); };
  const auto at = [&](int i, int j) -> int& { return index[(i + rings) * width + j + rings]; };
  for (int i = -rings; i <= rings; ++i) {
    for (int j = -rings; j <= rings; ++j) {
      if (ring_of(i, j) > rings) continue;
      const double x = s * (i + 0.5 * j), y = s * std::sqrt(0.75) * j;
      at(i, j) = static_cast<int>(net.nodes.size());
      net.fixed.push_back(ring_of(i, j) == rings);
      net.nodes.push_back(net.fixed.back() ? Vec3(x, y, dish.height(x, y)) : Vec3::Zero());
    }
  }
  constexpr std::array<std::array<int, 2>, 3> steps{{{0, 1}, {1, -1}, {1, 0}}};
  for (int i = -rings; i <= rings; ++i) {
    for (int j = -rings; j <= rings; ++j) {
      if (ring_of(i, j) > rings) continue;
      for (const auto& [di, dj] : steps) {
        if (ring_of(i + di, j + dj) > rings) continue;
        const int a = at(i, j), b = at(i + di, j + dj);
        if (!(net.fixed[a] && net.fixed[b])) net.branches.push_back({a, b});
      }
    }
  }
  return net;
}

/// One free node, number 0, held by branches to the given points.
inline Net star(const Points& supports) {
  Net net;
  net.nodes = {Vec3::Zero()};
  net.fixed = {false};
  for (const Vec3& support : supports) {
    net.branches.push_back({0, static_cast<int>(net.nodes.size())});
    net.nodes.push_back(support);
    net.fixed.push_back(true);
  }
  return net;
}

/// `n` branches in a row between two fixed points, nodes in order.
inline Net chain(int n, const Vec3& from, const Vec3& to) {
  Net net;
  for (int i = 0; i <= n; ++i) {
    net.nodes.push_back(from + (to - from) * (double(i) / n));
    net.fixed.push_back(i == 0 || i == n);
    if (i > 0) net.branches.push_back({i - 1, i});
  }
  return net;
}

inline std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const ModelError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace tautline::formfinding
