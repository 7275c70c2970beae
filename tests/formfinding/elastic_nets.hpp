#pragma once
/// Elastic nets shared by the tests of this folder.

#include <formfinding/nets.hpp>
#include <tautline/formfinding/elastic_net.hpp>
#include <tautline/formfinding/film_facet.hpp>

namespace tautline::formfinding {

/// Supports at x = -2 and 2, load 6 N down, EA = 1000 N: cut so that the node hangs at z = -1.5 m, where both
/// cables are 2.5 m long and carry 6 x 2.5 / (2 x 1.5) = 5 N. Starts elsewhere.
inline ElasticNet elastic_pair() {
  ElasticNet net;
  net.net = star({{-2, 0, 0}, {2, 0, 0}});
  net.net.nodes[0] = Vec3(0.3, 0.1, -1);
  net.net.load = {{0, 0, -6}, Vec3::Zero(), Vec3::Zero()};
  net.axial_stiffness = VecX::Constant(2, 1000);
  net.unstressed_length = VecX::Constant(2, 2.5 / 1.005);
  return net;
}

/// Square patch of n x n cells between z = 0 and 1 at its corners, saddle-shaped, corners fixed.
inline void add_grid(int n, Net& net, std::vector<std::array<int, 3>>& triangles) {
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const double x = 2.0 * i / n - 1, y = 2.0 * j / n - 1;
      net.nodes.push_back(Vec3(x, y, 0.5 * x * y));
      net.fixed.push_back((i == 0 || i == n) && (j == 0 || j == n));
    }
  }
  const auto at = [n](int i, int j) { return i * (n + 1) + j; };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
    net.branches.push_back({at(i, 0), at(i + 1, 0)});
    net.branches.push_back({at(i, n), at(i + 1, n)});
    net.branches.push_back({at(0, i), at(0, i + 1)});
    net.branches.push_back({at(n, i), at(n, i + 1)});
  }
}

/// The same as a film with one stress in all directions [N/m].
inline std::vector<FilmFacet> add_film_grid(int n, Net& net, double stress) {
  std::vector<std::array<int, 3>> triangles;
  add_grid(n, net, triangles);
  return isotropic_film(triangles, VecX::Constant(static_cast<Eigen::Index>(triangles.size()), stress));
}

}  // namespace tautline::formfinding
