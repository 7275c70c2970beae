#include <tautline/formfinding/film_facet.hpp>

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <formfinding/film_element.hpp>
#include <formfinding/net_system.hpp>
#include <map>
#include <tautline/model/section.hpp>

namespace tautline::formfinding {

namespace {

/// Twice the mean normal times the area.
Vec3 area_vector(const FilmFacet& facet, const Coordinates& nodes) {
  const auto at = [&](int k) -> Vec3 { return nodes.row(facet.nodes[k]).transpose(); };
  return facet.nodes.size() == 3 ? (at(1) - at(0)).cross(at(2) - at(0))
                                 : (at(2) - at(0)).cross(at(3) - at(1));
}

}  // namespace

std::vector<FilmFacet> isotropic_film(const std::vector<std::array<int, 3>>& triangles, const VecX& stress) {
  std::vector<FilmFacet> facets;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const double s = stress[static_cast<Eigen::Index>(t)];
    facets.push_back({triangles[t], {s, s}});
  }
  return facets;
}

Vec3 target_stress(const FilmFacet& facet, const Coordinates& nodes) {
  if (facet.stress[0] == facet.stress[1]) return {facet.stress[0], facet.stress[0], 0};
  return with_corners(facet, nodes, [&](const auto& x) {
    return model::along_orientation(element::membrane_frame(x), facet.orientation, facet.stress);
  });
}

Points target_stresses(const std::vector<FilmFacet>& facets, const Coordinates& nodes) {
  Points stress;
  for (const auto& facet : facets) stress.push_back(target_stress(facet, nodes));
  return stress;
}

Vec3 corner_normal(const FilmFacet& facet, const Coordinates& nodes, int k) {
  const int n = facet.nodes.size();
  const auto at = [&](int corner) -> Vec3 { return nodes.row(facet.nodes[corner % n]).transpose(); };
  return (at(k + 1) - at(k)).cross(at(k + n - 1) - at(k));
}

double area(const FilmFacet& facet, const Coordinates& nodes) {
  return with_corners(facet, nodes, [](const auto& x) { return element::membrane_area(x); });
}

void add_film_forces(const std::vector<FilmFacet>& facets, const Points& stress, const Coordinates& nodes,
                     Coordinates& force) {
  for (std::size_t f = 0; f < facets.size(); ++f)
    with_corners(facets[f], nodes, [&](const auto& x) {
      constexpr int n = std::decay_t<decltype(x)>::ColsAtCompileTime;
      element::MembraneLaw law{Mat3::Zero(), stress[f]};
      const auto pull = element::evaluate_membrane<n>(law, x, Vec<3 * n>::Zero(), element::Want::force).force;
      for (int k = 0; k < n; ++k)
        force.row(facets[f].nodes[k]) -= pull.template segment<3>(3 * k).transpose();
    });
}

Points film_forces(const std::vector<FilmFacet>& facets, const Points& stress, const Points& nodes) {
  Coordinates force = Coordinates::Zero(static_cast<Eigen::Index>(nodes.size()), 3);
  add_film_forces(facets, stress, to_coordinates(nodes), force);
  return to_points(force);
}

std::vector<double> film_unevenness(const std::vector<FilmFacet>& facets, const Points& stress,
                                    const Points& nodes) {
  const Coordinates at = to_coordinates(nodes);
  std::vector<double> result;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const Vec3 off = stress[f] - target_stress(facets[f], at);
    result.push_back(std::sqrt(off.squaredNorm() + off[2] * off[2]) / facets[f].largest_stress());
  }
  return result;
}

std::string held_points(const Net& net, const std::vector<FilmFacet>& facets) {
  std::vector<bool> alone(net.nodes.size(), false);
  for (const auto& facet : facets)
    for (const int node : facet.nodes) alone[static_cast<std::size_t>(node)] = net.fixed[node];
  for (const auto& facet : facets) {
    const auto fixed =
        std::count_if(facet.nodes.begin(), facet.nodes.end(), [&](int node) { return net.fixed[node]; });
    if (fixed < 2) continue;
    for (const int node : facet.nodes) alone[static_cast<std::size_t>(node)] = false;
  }
  for (const auto& branch : net.branches)
    for (const int node : branch) alone[static_cast<std::size_t>(node)] = false;
  const auto first = std::find(alone.begin(), alone.end(), true);
  if (first == alone.end()) return "";
  const Vec3& at = net.nodes[static_cast<std::size_t>(first - alone.begin())];
  return fmt::format(
      "; the film is held at a single point, ({:.4g}, {:.4g}, {:.4g}), from which a film of given stress "
      "tears "
      "itself off: hold it by a ring, or by cables that lead there",
      at.x(), at.y(), at.z());
}

std::string turned_over(const Net& drawn, const std::vector<FilmFacet>& facets, const Coordinates& found) {
  const Coordinates before = to_coordinates(drawn.nodes);
  std::map<std::array<int, 2>, const FilmFacet*> first_at;  // each side
  const FilmFacet* first = nullptr;
  int count = 0;
  for (const auto& facet : facets)
    for (int k = 0, n = facet.nodes.size(); k < n; ++k) {
      const int i = facet.nodes[k], j = facet.nodes[(k + 1) % n];
      const auto [it, added] = first_at.try_emplace({std::min(i, j), std::max(i, j)}, &facet);
      if (added) continue;
      const auto together = [&](const Coordinates& x) {
        return area_vector(facet, x).dot(area_vector(*it->second, x));
      };
      if (together(before) * together(found) >= 0) continue;
      first = first == nullptr ? &facet : first;
      ++count;
    }
  if (first == nullptr) return "";
  Vec3 at = Vec3::Zero();
  for (const int node : first->nodes) at += found.row(node).transpose() / first->nodes.size();
  return fmt::format(
      "facets of the film have turned over at {} sides, the first at ({:.4g}, {:.4g}, {:.4g}): draw the "
      "edges "
      "nearer to their shape, or give their cables more tension",
      count, at.x(), at.y(), at.z());
}

}  // namespace tautline::formfinding
