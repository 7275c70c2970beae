#include <formfinding/film_sides.hpp>

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <formfinding/lsqr.hpp>
#include <formfinding/net_forces.hpp>
#include <map>
#include <tautline/core/error.hpp>

namespace tautline::formfinding {

namespace {

/// Forces on the free nodes from changes of the stress along the sides [N/m].
class SideForces {
 public:
  SideForces(const NetSystem& system, const Triangles& triangles, const Coordinates& nodes)
      : system_(system), triangles_(triangles), free_index_(system.net().nodes.size(), -1) {
    for (int i = 0; i < system.n_free(); ++i) free_index_[system.free_nodes()[i]] = i;
    for (const auto& corners : triangles) {
      const double a = area(corners, nodes);
      for (int k = 0; k < 3; ++k) {
        const Vec3 side = nodes.row(corners[(k + 2) % 3]) - nodes.row(corners[(k + 1) % 3]);
        pull_.push_back(side * (a / side.squaredNorm()));
        weight_.push_back(a / side.squaredNorm());
      }
    }
  }

  Eigen::Index columns() const { return static_cast<Eigen::Index>(pull_.size()); }
  /// Force density per stress of one side [-].
  double weight(std::size_t side) const { return weight_[side]; }

  VecX apply(const VecX& stress) const {
    Coordinates force = Coordinates::Zero(system_.n_free(), 3);
    for_each_side([&](std::size_t side, int i, int j) {
      const Eigen::RowVector3d pull = stress[static_cast<Eigen::Index>(side)] * pull_[side].transpose();
      if (i >= 0) force.row(i) += pull;
      if (j >= 0) force.row(j) -= pull;
    });
    return flat(system_.unbalanced(force));
  }

  VecX apply_transposed(const VecX& values) const {
    const Coordinates at =
        system_.unbalanced(Eigen::Map<const Coordinates>(values.data(), system_.n_free(), 3));
    VecX result = VecX::Zero(columns());
    for_each_side([&](std::size_t side, int i, int j) {
      Vec3 difference = Vec3::Zero();
      if (i >= 0) difference += at.row(i);
      if (j >= 0) difference -= at.row(j);
      result[static_cast<Eigen::Index>(side)] = pull_[side].dot(difference);
    });
    return result;
  }

  static VecX flat(const Coordinates& rows) { return Eigen::Map<const VecX>(rows.data(), rows.size()); }

 private:
  template <class Visit>
  void for_each_side(const Visit& visit) const {
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        visit(3 * t + k, free_index_[triangles_[t][(k + 1) % 3]], free_index_[triangles_[t][(k + 2) % 3]]);
  }

  const NetSystem& system_;
  const Triangles& triangles_;
  std::vector<int> free_index_;
  std::vector<Vec3> pull_;  ///< at the first end, for a unit of stress [m]
  std::vector<double> weight_;
};

}  // namespace

FilmSides find_sides(const Triangles& triangles) {
  FilmSides result;
  std::map<std::array<int, 2>, int> known;
  for (const auto& corner : triangles) {
    std::array<int, 3> sides;
    for (int k = 0; k < 3; ++k) {
      const int i = corner[(k + 1) % 3], j = corner[(k + 2) % 3];
      const auto [it, added] =
          known.try_emplace({std::min(i, j), std::max(i, j)}, static_cast<int>(result.nodes.size()));
      if (added) result.nodes.push_back({i, j});
      sides[k] = it->second;
    }
    result.of_triangle.push_back(sides);
  }
  return result;
}

VecX natural_force_density(const FilmSides& sides, const Triangles& triangles, const VecX& surface_stress,
                           const Coordinates& nodes) {
  VecX q = VecX::Zero(static_cast<Eigen::Index>(sides.nodes.size()));
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& corner = triangles[t];
    const Vec3 cot = cotangents(nodes.row(corner[0]), nodes.row(corner[1]), nodes.row(corner[2]));
    for (int k = 0; k < 3; ++k)
      q[sides.of_triangle[t][k]] += 0.5 * surface_stress[static_cast<Eigen::Index>(t)] * cot[k];
  }
  return q;
}

double area(const std::array<int, 3>& corners, const Coordinates& nodes) {
  const Vec3 a = nodes.row(corners[0]), b = nodes.row(corners[1]), c = nodes.row(corners[2]);
  return 0.5 * (b - a).cross(c - a).norm();
}

void check_areas(const Triangles& triangles, const Coordinates& nodes) {
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& corner = triangles[t];
    const double side = (nodes.row(corner[1]) - nodes.row(corner[0])).squaredNorm();
    if (!(area(corner, nodes) > 1e-12 * side))
      throw ModelError(fmt::format("triangle {} of nodes {}, {}, {} has no area at the start", t, corner[0],
                                   corner[1], corner[2]));
  }
}

Points balance_film(const Net& net, const VecX& tension, const Triangles& triangles,
                    const VecX& surface_stress, const Points& nodes) {
  const FilmSides sides = find_sides(triangles);
  Net all = net;
  all.branches.insert(all.branches.end(), sides.nodes.begin(), sides.nodes.end());
  const NetSystem system(all);
  const Coordinates at = to_coordinates(nodes);
  NetState state = system.state(VecX::Zero(static_cast<Eigen::Index>(all.branches.size())), at);
  const Eigen::Index n = tension.size();
  state.force_density.head(n) = tension.cwiseQuotient(state.length.head(n));
  state.force_density.tail(state.force_density.size() - n) =
      natural_force_density(sides, triangles, surface_stress, at);
  return balanced_sides(system, state, triangles, surface_stress);
}

Points balanced_sides(const NetSystem& system, const NetState& state, const Triangles& triangles,
                      const VecX& surface_stress) {
  const SideForces forces(system, triangles, state.nodes);
  const Coordinates all = nodal_forces(system.net(), state.force_density, state.vectors);
  Coordinates left(system.n_free(), 3);
  for (int i = 0; i < system.n_free(); ++i) left.row(i) = all.row(system.free_nodes()[i]);
  const VecX target = -SideForces::flat(system.unbalanced(left));
  const VecX change = least_squares(forces, target, 1e-13, 20 * (static_cast<int>(target.size()) + 50)).x;
  Points density;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& corner = triangles[t];
    const Vec3 cot =
        cotangents(state.nodes.row(corner[0]), state.nodes.row(corner[1]), state.nodes.row(corner[2]));
    Vec3 q = 0.5 * surface_stress[static_cast<Eigen::Index>(t)] * cot;
    for (std::size_t k = 0; k < 3; ++k)
      q[static_cast<int>(k)] += change[static_cast<Eigen::Index>(3 * t + k)] * forces.weight(3 * t + k);
    density.push_back(q);
  }
  return density;
}

}  // namespace tautline::formfinding
