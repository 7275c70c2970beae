#include <formfinding/film_sides.hpp>

#include <algorithm>
#include <map>
#include <tautline/formfinding/node_error.hpp>

namespace tautline::formfinding {

FilmSides find_sides(const std::vector<FilmFacet>& facets) {
  FilmSides result;
  std::map<std::array<int, 2>, int> known;
  for (const auto& facet : facets) {
    std::array<int, 6> sides{};
    int side = 0;
    for (int b = 1; b < facet.nodes.size(); ++b)
      for (int a = 0; a < b; ++a) {
        const int i = facet.nodes[a], j = facet.nodes[b];
        const auto [it, added] =
            known.try_emplace({std::min(i, j), std::max(i, j)}, static_cast<int>(result.nodes.size()));
        if (added) result.nodes.push_back({i, j});
        sides[static_cast<std::size_t>(side++)] = it->second;
      }
    result.of_facet.push_back(sides);
  }
  return result;
}

VecX natural_force_density(const FilmSides& sides, const std::vector<FilmFacet>& facets,
                           const Coordinates& nodes) {
  VecX q = VecX::Zero(static_cast<Eigen::Index>(sides.nodes.size()));
  for (std::size_t f = 0; f < facets.size(); ++f)
    with_corners(facets[f], nodes, [&](const auto& x) {
      constexpr int n = std::decay_t<decltype(x)>::ColsAtCompileTime;
      const element::MembraneLaw law{Mat3::Zero(), target_stress(facets[f], nodes)};
      const auto tangent =
          element::evaluate_membrane<n>(law, x, Vec<3 * n>::Zero(), element::Want::tangent).tangent;
      std::size_t side = 0;
      for (int b = 1; b < n; ++b)
        for (int a = 0; a < b; ++a) q[sides.of_facet[f][side++]] -= tangent(3 * a, 3 * b);
    });
  return q;
}

void check_areas(const Net& net, const std::vector<FilmFacet>& facets) {
  const Coordinates nodes = to_coordinates(net.nodes);
  for (const auto& facet : facets) {
    const int n = facet.nodes.size();
    double side = 0, smallest = corner_normal(facet, nodes, 0).norm();
    for (int k = 0; k < n; ++k) {
      side = std::max(side, (nodes.row(facet.nodes[(k + 1) % n]) - nodes.row(facet.nodes[k])).squaredNorm());
      smallest = std::min(smallest, corner_normal(facet, nodes, k).norm());
    }
    if (!(smallest > 1e-12 * side))
      throw NodeError("the facet of the film between ", {facet.nodes.begin(), facet.nodes.end()},
                      " has no area at the start");
  }
}

}  // namespace tautline::formfinding
