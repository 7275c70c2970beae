#pragma once
/// @file
/// Free bodies: what accelerates them, and where they are said to be. Theory: docs/theory/free_structures.md

#include <vector>

#include <tautline/assembly/system.hpp>

namespace tautline::assembly {

/// @brief The inertia of free bodies under what acts on them, and the gauge of their place.
///
/// Each body gets the uniform linear and angular acceleration at which the inertia of its own mass balances
/// the resultants of what acts; its place is that of zero mean displacement and rotation, weighed by mass.
class InertiaRelief {
 public:
  /// @throws ModelError if a body has no mass or something ties it to the ground or to another one
  InertiaRelief(const model::Model& model, const DofMap& map, const model::State& state);

  /// Six unknowns of each body, statically determinate, whose increments are left out of a solve.
  std::vector<model::Support> holds(const model::State& state) const;
  /// Masses in this state, which `balance` uses until they are taken again.
  void take_masses(const model::State& state);
  /// Finds the inertia forces that balance `residual` (internal less external force, complete in this rank's
  /// own entries) at `state`. Collective.
  void balance(const Kinematics& kinematics, const model::State& state, const std::vector<double>& residual);
  /// Forces of inertia: minus mass times acceleration, as found last. @return force, then moment
  const Vec<6>& force(int node) const { return force_[static_cast<std::size_t>(node)]; }
  /// Inertia of a beam per length, that of its middle [N/m].
  Vec3 line_load(const model::Beam& beam, const model::State& state) const;
  void clear();
  /// The state with each body in its place.
  model::State centred(model::State state) const;
  std::vector<BodyAcceleration> accelerations(const model::State& state) const;

 private:
  struct Body {
    std::vector<int> nodes;
    double mass = 0, size = 1;
    Vec3 centre = Vec3::Zero();  ///< of mass, in the reference
    Vec3 line = Vec3::Zero();    ///< direction, if all nodes are on one line in the reference
    Vec<6> acceleration = Vec<6>::Zero();
    bool by_mass = true;  ///< whether mass tells where it is; else each node alike
    bool straight() const { return !line.isZero(0); }
  };

  void find_shape(Body& body) const;
  double weight_of(const Body& body, int node) const;
  Vec3 centre_of(const Body& body, const model::State& state) const;
  Mat3 mean_rotation(const Body& body, const model::State& state, const Vec3& centre) const;
  model::Support hold(const std::string& name, int node, const Mat3& axes, const Vec<6>& fixed) const;
  void add_holds(const Body& body, const Points& positions, std::vector<model::Support>& supports) const;

  const model::Model& model_;
  const DofMap& map_;
  std::vector<Body> bodies_;
  std::vector<double> weight_;   // mass of each node
  std::vector<Mat<6>> inertia_;  // of each node: forces and moments for the six unit accelerations
  std::vector<int> body_of_;     // of each node
  std::vector<Vec3> pole_;       // of each body: about which these are meant
  std::vector<Vec<6>> force_;
};

/// @throws ModelError for a load that prescribes a motion
void refuse_motions(const std::vector<model::Load>& loads);

}  // namespace tautline::assembly
