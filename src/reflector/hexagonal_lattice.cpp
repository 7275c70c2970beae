#include <algorithm>
#include <reflector/hexagonal_lattice.hpp>
#include <set>

namespace tautline::reflector {

std::vector<std::array<int, 3>> HexagonalLattice::facets() const {
  std::vector<std::array<int, 3>> facets;
  for (int k = 0; k < rings_; ++k) {
    for (int sector = 0; sector < 6; ++sector) {
      // The t-th node of ring k lies between the t-th and the (t + 1)-th of ring k + 1.
      for (int t = 0; t <= k; ++t) {
        const int inner = node(k, sector * k + t);
        const int outer = sector * (k + 1) + t;
        facets.push_back({inner, node(k + 1, outer), node(k + 1, outer + 1)});
        if (t < k) facets.push_back({inner, node(k + 1, outer + 1), node(k, sector * k + t + 1)});
      }
    }
  }
  return facets;
}

std::vector<std::array<int, 2>> HexagonalLattice::sides() const {
  std::set<std::array<int, 2>> sides;
  for (const auto& facet : facets()) {
    for (int i = 0; i < 3; ++i) {
      const auto [low, high] = std::minmax(facet[i], facet[(i + 1) % 3]);
      if (low < n_free()) sides.insert({low, high});
    }
  }
  return {sides.begin(), sides.end()};
}

}  // namespace tautline::reflector
