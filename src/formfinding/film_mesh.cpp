#include <formfinding/film_mesh.hpp>

#include <Eigen/Geometry>
#include <cmath>
#include <formfinding/net_forces.hpp>

namespace tautline::formfinding {

namespace {

/// Normal of the film at each node times twice the area of the facets there, facets of either orientation.
Coordinates film_normals(const std::vector<FilmFacet>& film, const Coordinates& nodes) {
  Coordinates normal = Coordinates::Zero(nodes.rows(), 3);
  for (const auto& facet : film)
    for (int k = 0; k < facet.nodes.size(); ++k) {
      auto sum = normal.row(facet.nodes[k]);
      const Eigen::RowVector3d here = corner_normal(facet, nodes, k).transpose();
      sum += sum.dot(here) < 0 ? Eigen::RowVector3d(-here) : here;
    }
  return normal;
}

bool one_constant_tension(const ElasticNet& net, const std::vector<int>& branches) {
  return branches.size() == 2 && net.tension.size() > 0 &&
         net.tension[branches[0]] == net.tension[branches[1]];  // false for NaN
}

}  // namespace

FilmNet::FilmNet(const ElasticNet& of)
    : elastic(of), sides(find_sides(of.film)), net(of.net), cables_at(net.nodes.size()) {
  for (std::size_t b = 0; b < net.branches.size(); ++b)
    for (const int node : net.branches[b])
      cables_at[static_cast<std::size_t>(node)].push_back(static_cast<int>(b));
  net.branches.insert(net.branches.end(), sides.nodes.begin(), sides.nodes.end());
  drawn = force_density(to_coordinates(net.nodes));
}

VecX FilmNet::force_density(const Coordinates& nodes) const {
  const auto n = n_cables();
  VecX q(static_cast<Eigen::Index>(net.branches.size()));
  for (int b = 0; b < n; ++b) {
    const auto [i, j] = net.branches[static_cast<std::size_t>(b)];
    const double length = (nodes.row(j) - nodes.row(i)).norm();
    q[b] = branch_force(elastic, b, length).tension / length;
  }
  q.tail(q.size() - n) = natural_force_density(sides, elastic.film, nodes);
  return q;
}

FilmMesh::FilmMesh(const FilmNet& net, const std::vector<int>& free_nodes, const Coordinates& nodes)
    : net_(net), free_nodes_(free_nodes) {
  const auto normal = film_normals(net.elastic.film, nodes);
  for (const int node : free_nodes) {
    Mat3 open = Mat3::Zero();
    const auto& branches = net.cables_at[static_cast<std::size_t>(node)];
    const Vec3 n = normal.row(node).transpose();
    if (!n.isZero(0) && branches.empty()) {
      open = Mat3::Identity() - n.normalized() * n.normalized().transpose();
    } else if (!n.isZero(0) && one_constant_tension(net.elastic, branches)) {
      const auto away = [&](int branch) -> Vec3 {
        const auto [a, b] = net.net.branches[static_cast<std::size_t>(branch)];
        return (nodes.row(a == node ? b : a) - nodes.row(node)).transpose().normalized();
      };
      const Vec3 tangent = (away(branches[0]) - away(branches[1])).normalized();
      open = tangent * tangent.transpose();
    }
    open_.push_back(open);
  }
}

void FilmMesh::take_drawn_forces(const Coordinates& nodes, Coordinates& force) const {
  Coordinates drawn = Coordinates::Zero(nodes.rows(), 3);
  for (Eigen::Index b = 0; b < net_.drawn.size(); ++b) {
    const auto [i, j] = net_.net.branches[static_cast<std::size_t>(b)];
    const Eigen::RowVector3d pull = net_.drawn[b] * (nodes.row(j) - nodes.row(i));
    const auto counts = [&](int node) {
      return b < net_.n_cables() || net_.cables_at[static_cast<std::size_t>(node)].empty();
    };
    if (counts(i)) drawn.row(i) += pull;
    if (counts(j)) drawn.row(j) -= pull;
  }
  take(drawn(free_nodes_, Eigen::all), force);
}

void FilmMesh::take(const Coordinates& other, Coordinates& values) const {
  for (Eigen::Index i = 0; i < values.rows(); ++i)
    values.row(i) += (other.row(i) - values.row(i)) * open_[static_cast<std::size_t>(i)];
}

}  // namespace tautline::formfinding
