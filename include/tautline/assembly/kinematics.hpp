#pragma once
/// @file
/// How the nodes move with the unknowns: supports in rotated axes, rigid arms, hinges, linear constraints.

#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include <tautline/assembly/dof_map.hpp>
#include <tautline/model/model.hpp>
#include <tautline/model/state.hpp>

namespace tautline::assembly {

/// A part of a node's increment: matrix x the increment of an unknown block.
struct Dependence {
  int block = -1;
  Mat3 matrix;
};

/// @brief Displacements and rotations of the nodes as functions of the unknowns.
///
/// The unknowns of a node without links or rotated supports are its own increments. Source for the rotations:
/// spatial spins, docs/theory/conventions.md; derivation: docs/theory/constraints.md.
class Kinematics {
 public:
  Kinematics() = default;
  Kinematics(const model::Model& model, const DofMap& map);

  /// Directions of the unknowns for supports in rotated axes; marks what `supports` and the constraints hold.
  /// `turned`: nodes whose rotation is prescribed.
  /// @throws ModelError where the supports of a node contradict its links
  void hold(const std::vector<model::Support>& supports, const std::set<int>& turned);
  /// Finds what rotation the supports hold of each node in `state` (State::turn), which may have come about
  /// under others; what is known stays.
  void settle(model::State& state) const;
  /// Whether an unknown is held: index 3 * block + component.
  const std::vector<bool>& held() const noexcept { return held_; }
  /// Axes of a block's unknowns, columns in the global frame.
  const Mat3& frame(int block) const noexcept { return frame_[static_cast<std::size_t>(block)]; }

  /// Takes the arms and hinge axes of `state` for the increments about it.
  void linearise(const model::State& state);
  /// Whether the node's blocks are its unknowns as they stand.
  bool plain(int node) const noexcept { return plain_[static_cast<std::size_t>(node)]; }
  const std::vector<Dependence>& displacement(int node) const {
    return displacement_[static_cast<std::size_t>(node)];
  }
  const std::vector<Dependence>& rotation(int node) const {
    return rotation_[static_cast<std::size_t>(node)];
  }

  /// State reached from `state` by increments of the unknowns (all of them, of every rank).
  model::State moved(const model::State& state, const std::vector<double>& increments) const;
  /// Puts followers where their leaders want them.
  void carry_followers(model::State& state) const;
  /// Components along the axes of a block's unknowns.
  Vec3 in_axes(int block, const Vec3& value) const { return frame(block).transpose() * value; }
  /// The increment of the unknowns of one block that turns or moves its node as the nodal increment `value`.
  Vec3 unknown_of(int block, const Vec3& value) const;

  /// Whether a node has a rotation of its own and no hinge angles instead.
  bool turns_by_itself(int node) const;
  /// Number of rotations of a node that supports hold; 0 for a follower.
  int held_rotations(int node) const;
  /// Whether supports hold some rotations of a node, so that its unknowns are a rotation vector and not
  /// spins; see docs/theory/constraints.md#held-rotations.
  bool charted(int node) const noexcept { return charted_[static_cast<std::size_t>(node)]; }
  bool any_charted() const { return std::find(charted_.begin(), charted_.end(), true) != charted_.end(); }
  /// What the moment on a node adds to the second derivative by the unknowns of its rotation, if charted.
  Mat3 curvature(int node, const Vec3& moment) const;
  /// Rotation from the axes of a support to those about which its moment acts on the node at present.
  Mat3 reaction_axes(int node) const;
  /// The same with spins as unknowns everywhere, about `state`: what is conjugate to them are moments.
  Kinematics in_nodal_spins(const model::State& state) const;
  /// Cyclic pair whose follower is `node`, or -1.
  int cyclic_of(int node) const noexcept { return cyclic_of_[static_cast<std::size_t>(node)]; }

  /// Displacement components that follow from the linear constraints, one for each of these.
  const std::vector<model::LinearConstraint::Term>& constrained() const noexcept { return constrained_; }

  /// Links whose follower is `node`, or -1.
  int link_of(int node) const noexcept { return link_of_[static_cast<std::size_t>(node)]; }
  /// Whether a link leaves the rotation of its follower alone.
  bool rotation_is_free(int link) const {
    return model_->links[static_cast<std::size_t>(link)].rotation_free;
  }
  /// Part of the second derivative that a force and moment on a link's follower add, order (leader's spin,
  /// hinge angles); see the theory page.
  Mat<6> second_derivative(int link, const Vec3& force, const Vec3& moment) const;
  /// From the leader of a link to its follower, at present [m].
  const Vec3& lever(int link) const { return arms_[static_cast<std::size_t>(link)].lever; }

 private:
  struct Arm {
    Vec3 lever;                ///< from leader to follower, at present
    std::array<Vec3, 3> axis;  ///< hinge axes at present
  };

  void resolve_constraints();
  void find_fixed_dependences();
  /// Part of a vector along the held axes of a block.
  Vec3 held_part(int block, const Vec3& vector) const;
  /// Rotation vector of what a charted node has turned after what is prescribed, along its free axes.
  Vec3 tilt(const model::State& state, int node) const;
  void turn_node(model::State& state, int node, const Vec3& increment) const;
  void find_charts(const model::State& state);
  Mat3 leader_rotation(const model::State& state, const model::Link& link) const;

  const model::Model* model_ = nullptr;
  const DofMap* map_ = nullptr;
  std::vector<bool> plain_, held_;
  std::vector<Mat3> frame_;
  std::vector<std::vector<Dependence>> displacement_, rotation_;  // by node
  std::vector<model::LinearConstraint::Term> constrained_;
  /// What each of them is the sum of: components of nodes that follow nothing.
  std::vector<std::vector<model::LinearConstraint::Term>> resolved_;
  std::vector<bool> charted_;      // by node
  std::vector<int> charted_node_;  // by block: whose rotation it is, if charted, or -1
  std::vector<Vec3> tilt_;         // by node, where charted
  std::vector<int> link_of_, cyclic_of_;
  std::vector<Arm> arms_;   // by link
  std::vector<int> order_;  // of the links, leaders first
};

}  // namespace tautline::assembly
