#pragma once
/// @file
/// What rigid arms, hinges and held rotations add to a tangent. Theory:
/// docs/theory/constraints.md#second-derivative

#include <tautline/assembly/dof_map.hpp>
#include <tautline/assembly/kinematics.hpp>
#include <tautline/model/model.hpp>

#include "assembly/expansion.hpp"

namespace tautline::assembly {

/// Adds to a matrix in unknowns what forces on followers add through their arms and hinges, and moments on
/// nodes whose rotations are held in part.
class LinkTerms {
 public:
  LinkTerms(const Kinematics& kinematics, const DofMap& map, const model::Model& model,
            const Expansion& expansion, MatX& matrix)
      : kinematics_(kinematics), map_(map), model_(model), expansion_(expansion), matrix_(matrix) {}

  /// Of forces on the rows of an element.
  template <class Nodes, class Force>
  void add(const Nodes& nodes, bool rotations, const Force& force) {
    const int stride = rotations ? 6 : 3;
    int row = 0;
    for (const int node : nodes) {
      const Vec3 f = force.template segment<3>(row);
      const Vec3 m = rotations ? Vec3(force.template segment<3>(row + 3)) : Vec3(Vec3::Zero());
      add(node, f, m);
      row += stride;
    }
  }

 private:
  /// A follower hands its force on to its leader, which may follow another.
  void add(int node, const Vec3& f, const Vec3& m) {
    const int index = kinematics_.link_of(node);
    if (index < 0 || model_.links[static_cast<std::size_t>(index)].rotation_free) add_own(node, m);
    if (index < 0) return;
    const auto& link = model_.links[static_cast<std::size_t>(index)];
    const Mat<6> h = kinematics_.second_derivative(index, f, m);
    const auto& spin = kinematics_.rotation(link.leader);
    const int hinge = link.hinge.empty() ? -1 : map_.rotation_block[static_cast<std::size_t>(node)];
    const int b = hinge < 0 ? -1 : 3 * expansion_.place_of(hinge);
    for (const auto& [block, by] : spin) {
      const int a = 3 * expansion_.place_of(block);
      for (const auto& [other, by_other] : spin)
        matrix_.block<3, 3>(a, 3 * expansion_.place_of(other)) +=
            by.transpose() * h.topLeftCorner<3, 3>() * by_other;
      if (b < 0) continue;
      const Mat3 cross = by.transpose() * h.topRightCorner<3, 3>();
      matrix_.block<3, 3>(a, b) += cross;
      matrix_.block<3, 3>(b, a) += cross.transpose();
    }
    if (b >= 0) matrix_.block<3, 3>(b, b) += h.bottomRightCorner<3, 3>();
    add(link.leader, f, kinematics_.lever(index).cross(f) + (link.rotation_free ? Vec3(Vec3::Zero()) : m));
  }

  /// Of the moment on a node that turns by itself, or with the node that leads it round an axis.
  void add_own(int node, const Vec3& m) {
    if (const int index = kinematics_.cyclic_of(node); index >= 0) {
      const auto& pair = model_.cyclic_pairs[static_cast<std::size_t>(index)];
      return add_own(pair.leader, pair.turn.transpose() * m);
    }
    if (!kinematics_.charted(node) || m.isZero(0)) return;
    const int a = 3 * expansion_.place_of(map_.rotation_block[static_cast<std::size_t>(node)]);
    matrix_.block<3, 3>(a, a) += kinematics_.curvature(node, m);
  }

  const Kinematics& kinematics_;
  const DofMap& map_;
  const model::Model& model_;
  const Expansion& expansion_;
  MatX& matrix_;
};

}  // namespace tautline::assembly
