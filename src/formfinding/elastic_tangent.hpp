#pragma once
/// @file
/// Tangent of a net of cables: axial stiffness along, tension over length across every branch.

#include <formfinding/net_forces.hpp>

namespace tautline::formfinding {

class ElasticTangent {
 public:
  explicit ElasticTangent(const ElasticNet& net);

  int n_free() const noexcept { return static_cast<int>(free_nodes_.size()); }
  const std::vector<int>& free_nodes() const noexcept { return free_nodes_; }
  /// @param[in] shift  added to the diagonal, in parts of the stiffness at each node [-]
  /// @return whether the tangent is positive definite
  bool factorise(const Coordinates& nodes, double shift);
  /// Displacements of the free nodes under forces on them [n_free x 3].
  Coordinates solve(const Coordinates& force) const;

 private:
  const ElasticNet& net_;
  std::vector<int> free_nodes_, free_index_;
  SparseFactor factor_;
};

}  // namespace tautline::formfinding
