#include <formfinding/net_forces.hpp>

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <tautline/core/error.hpp>

namespace tautline::formfinding {

namespace {

bool has_constant_tension(const ElasticNet& net, int branch) {
  return net.tension.size() > 0 && !std::isnan(net.tension[branch]);
}

void check_films(const ElasticNet& net) {
  const int n_nodes = static_cast<int>(net.net.nodes.size());
  if (net.surface_stress.size() != static_cast<Eigen::Index>(net.triangles.size()))
    throw ModelError(fmt::format("{} triangles, but {} surface stresses", net.triangles.size(),
                                 net.surface_stress.size()));
  for (std::size_t t = 0; t < net.triangles.size(); ++t) {
    const auto [low, high] = std::minmax_element(net.triangles[t].begin(), net.triangles[t].end());
    if (*low < 0 || *high >= n_nodes)
      throw ModelError(fmt::format("triangle {} names node {}, but the net has {} nodes", t,
                                   *low < 0 ? *low : *high, n_nodes));
    if (!(net.surface_stress[static_cast<Eigen::Index>(t)] > 0))
      throw ModelError(fmt::format("the surface stress of triangle {} must be positive", t));
  }
}

}  // namespace

void check(const ElasticNet& net) {
  check(net.net);
  const auto m = static_cast<Eigen::Index>(net.net.branches.size());
  if (net.tension.size() != 0 && net.tension.size() != m)
    throw ModelError(fmt::format("the net has {} branches, but {} tensions", m, net.tension.size()));
  for (int b = 0; b < m; ++b) {
    if (has_constant_tension(net, b)) continue;
    if (net.axial_stiffness.size() != m || net.unstressed_length.size() != m)
      throw ModelError(
          fmt::format("the net has {} branches, but {} axial stiffnesses and {} unstressed lengths", m,
                      net.axial_stiffness.size(), net.unstressed_length.size()));
    if (!(net.axial_stiffness[b] > 0) || !(net.unstressed_length[b] > 0))
      throw ModelError(
          fmt::format("the axial stiffness and unstressed length of branch {} must be positive", b));
  }
  check_films(net);
}

BranchForce branch_force(const ElasticNet& net, int b, double length) {
  if (has_constant_tension(net, b)) return {net.tension[b], 0, false};
  const double stiffness = net.axial_stiffness[b] / net.unstressed_length[b];
  const double tension = stiffness * (length - net.unstressed_length[b]);
  const bool pressed = net.carries_compression.empty() ? false : net.carries_compression[b];
  if (tension < 0 && !pressed) return {0, 0, true};
  return {tension, stiffness, false};
}

Vec3 cotangents(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double twice_area = (b - a).cross(c - a).norm();
  return Vec3((b - a).dot(c - a), (c - b).dot(a - b), (a - c).dot(b - c)) / twice_area;
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
  for (std::size_t t = 0; t < net.triangles.size(); ++t) {
    // Natural force densities: side opposite to a corner pulls with stress/2 cot(corner) times its length.
    const auto& corner = net.triangles[t];
    const double stress = net.surface_stress[static_cast<Eigen::Index>(t)];
    const Vec3 cot = cotangents(nodes.row(corner[0]), nodes.row(corner[1]), nodes.row(corner[2]));
    for (int k = 0; k < 3; ++k) {
      const int i = corner[(k + 1) % 3], j = corner[(k + 2) % 3];
      const Eigen::RowVector3d side = nodes.row(j) - nodes.row(i);
      result.force.row(i) += 0.5 * stress * cot[k] * side;
      result.force.row(j) -= 0.5 * stress * cot[k] * side;
      result.scale = std::max(result.scale, stress * side.norm());
    }
  }
  return result;
}

FilmDirections film_directions(const ElasticNet& net, const Coordinates& nodes) {
  FilmDirections result{Coordinates::Zero(nodes.rows(), 3), Coordinates::Zero(nodes.rows(), 3)};
  for (const auto& corner : net.triangles) {
    const Vec3 a = nodes.row(corner[0]), b = nodes.row(corner[1]), c = nodes.row(corner[2]);
    const Vec3 area = (b - a).cross(c - a);
    for (const int node : corner) result.normal.row(node) += area;
  }
  std::vector<std::vector<int>> meeting(static_cast<std::size_t>(nodes.rows()));
  for (std::size_t b = 0; b < net.net.branches.size(); ++b)
    for (const int node : net.net.branches[b]) meeting[node].push_back(static_cast<int>(b));
  for (Eigen::Index i = 0; i < nodes.rows(); ++i) {
    const auto& branches = meeting[static_cast<std::size_t>(i)];
    const bool of_film = !result.normal.row(i).isZero(0);
    if (!branches.empty()) result.normal.row(i).setZero();
    result.normal.row(i).normalize();
    if (!of_film || branches.size() != 2 || !has_constant_tension(net, branches[0]) ||
        !has_constant_tension(net, branches[1]) || net.tension[branches[0]] != net.tension[branches[1]])
      continue;
    const auto away = [&](int branch) -> Eigen::RowVector3d {
      const auto [a, b] = net.net.branches[branch];
      return (nodes.row(a == i ? b : a) - nodes.row(i)).normalized();
    };
    result.tangent.row(i) = (away(branches[0]) - away(branches[1])).normalized();
  }
  return result;
}

void keep_what_counts(const FilmDirections& directions, const std::vector<int>& free_nodes,
                      Coordinates& force) {
  for (std::size_t i = 0; i < free_nodes.size(); ++i) {
    const Eigen::RowVector3d normal = directions.normal.row(free_nodes[i]);
    const Eigen::RowVector3d tangent = directions.tangent.row(free_nodes[i]);
    const auto row = static_cast<Eigen::Index>(i);
    if (!normal.isZero(0)) force.row(row) = force.row(row).dot(normal) * normal;
    if (!tangent.isZero(0)) force.row(row) -= force.row(row).dot(tangent) * tangent;
  }
}

VecX nodal_stiffness(const ElasticNet& net, const Coordinates& nodes) {
  VecX stiffness = VecX::Zero(nodes.rows());
  const Coordinates vectors = branch_vectors(net.net, nodes);
  for (int b = 0; b < vectors.rows(); ++b) {
    // A slack cable counts as taut: it may become so before the masses are set again.
    const double length = vectors.row(b).norm();
    const BranchForce force = branch_force(net, b, length);
    const double elastic =
        has_constant_tension(net, b) ? 0 : net.axial_stiffness[b] / net.unstressed_length[b];
    const double sum = std::max(elastic, length > 0 ? force.tension / length : 0.0);
    for (const int node : net.net.branches[b]) stiffness[node] += sum;
  }
  for (std::size_t t = 0; t < net.triangles.size(); ++t) {
    const auto& corner = net.triangles[t];
    const Vec3 cot = cotangents(nodes.row(corner[0]), nodes.row(corner[1]), nodes.row(corner[2]));
    // Rows of the second derivative of the area: cotangents across the film, 1/2 each along it.
    for (const int node : corner)
      stiffness[node] += net.surface_stress[static_cast<Eigen::Index>(t)] * (0.5 * cot.cwiseAbs().sum() + 1);
  }
  return stiffness;
}

}  // namespace tautline::formfinding
