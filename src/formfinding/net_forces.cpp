#include <formfinding/net_forces.hpp>

#include <formfinding/film_sides.hpp>

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <tautline/core/error.hpp>

namespace tautline::formfinding {

namespace {

bool has_entry(const VecX& values, int branch) {
  return values.size() > 0 && !std::isnan(values[branch]);
}

void check_film(const ElasticNet& net) {
  const int n_nodes = static_cast<int>(net.net.nodes.size());
  for (std::size_t f = 0; f < net.film.size(); ++f) {
    const auto& facet = net.film[f];
    const auto [low, high] = std::minmax_element(facet.nodes.begin(), facet.nodes.end());
    if (*low < 0 || *high >= n_nodes)
      throw ModelError(fmt::format("facet {} of the film names node {}, but the net has {} nodes", f + 1,
                                   (*low < 0 ? *low : *high) + 1, n_nodes));
    if (!(std::min(facet.stress[0], facet.stress[1]) > 0))
      throw ModelError(fmt::format("the stress of facet {} of the film must be positive", f + 1));
  }
}

}  // namespace

void check(const ElasticNet& net) {
  check(net.net);
  const auto m = static_cast<Eigen::Index>(net.net.branches.size());
  if (net.tension.size() != 0 && net.tension.size() != m)
    throw ModelError(fmt::format("the net has {} branches, but {} tensions", m, net.tension.size()));
  for (int b = 0; b < m; ++b) {
    if (!is_elastic(net, b)) continue;
    if (net.axial_stiffness.size() != m || net.unstressed_length.size() != m)
      throw ModelError(
          fmt::format("the net has {} branches, but {} axial stiffnesses and {} unstressed lengths", m,
                      net.axial_stiffness.size(), net.unstressed_length.size()));
    if (!(net.axial_stiffness[b] > 0) || !(net.unstressed_length[b] > 0))
      throw ModelError(
          fmt::format("the axial stiffness and unstressed length of branch {} must be positive", b + 1));
  }
  check_film(net);
}

bool is_elastic(const ElasticNet& net, int b) {
  return !has_entry(net.tension, b) && !has_entry(net.force_density, b);
}

BranchForce branch_force(const ElasticNet& net, int b, double length) {
  if (has_entry(net.tension, b)) return {net.tension[b], 0, false};
  if (has_entry(net.force_density, b)) return {net.force_density[b] * length, net.force_density[b], false};
  const double stiffness = net.axial_stiffness[b] / net.unstressed_length[b];
  const double tension = stiffness * (length - net.unstressed_length[b]);
  const bool pressed = net.carries_compression.empty() ? false : net.carries_compression[b];
  if (tension < 0 && !pressed) return {0, 0, true};
  return {tension, stiffness, false};
}

NetForces net_forces(const ElasticNet& net, const Coordinates& nodes) {
  NetForces result;
  result.tension.resize(static_cast<Eigen::Index>(net.net.branches.size()));
  VecX density(result.tension.size());
  const Coordinates vectors = branch_vectors(net.net, nodes);
  for (int b = 0; b < result.tension.size(); ++b) {
    const double length = vectors.row(b).norm();
    result.tension[b] = branch_force(net, b, length).tension;
    density[b] = length > 0 ? result.tension[b] / length : 0;
    result.scale = std::max(result.scale, result.tension[b]);
  }
  for (const Vec3& load : net.net.load) result.scale = std::max(result.scale, load.norm());
  result.force = nodal_forces(net.net, density, vectors);
  add_film_forces(net.film, target_stresses(net.film, nodes), nodes, result.force);
  for (const auto& facet : net.film)
    for (int k = 0, n = facet.nodes.size(); k < n; ++k)
      result.scale = std::max(
          result.scale,
          facet.largest_stress() * (nodes.row(facet.nodes[(k + 1) % n]) - nodes.row(facet.nodes[k])).norm());
  return result;
}

VecX nodal_stiffness(const ElasticNet& net, const Coordinates& nodes) {
  VecX stiffness = VecX::Zero(nodes.rows());
  const Coordinates vectors = branch_vectors(net.net, nodes);
  for (int b = 0; b < vectors.rows(); ++b) {
    // A slack cable counts as taut: it may become so before the masses are set again.
    const double length = vectors.row(b).norm();
    const BranchForce force = branch_force(net, b, length);
    const double elastic = is_elastic(net, b) ? net.axial_stiffness[b] / net.unstressed_length[b] : 0;
    const double sum = std::max(elastic, length > 0 ? force.tension / length : 0.0);
    for (const int node : net.net.branches[b]) stiffness[node] += sum;
  }
  const FilmSides sides = find_sides(net.film);
  const VecX density = natural_force_density(sides, net.film, nodes);
  for (std::size_t side = 0; side < sides.nodes.size(); ++side)
    for (const int node : sides.nodes[side])
      stiffness[node] += std::abs(density[static_cast<Eigen::Index>(side)]);
  // The second derivative of the area has as much again along the film.
  for (const auto& facet : net.film)
    for (const int node : facet.nodes) stiffness[node] += (facet.nodes.size() - 2) * facet.largest_stress();
  return stiffness;
}

}  // namespace tautline::formfinding
