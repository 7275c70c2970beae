#pragma once
/// @file
/// Tangent of a net of cables: axial stiffness along, tension over length across every branch; guides are
/// stiff springs.

#include <formfinding/net_forces.hpp>
#include <functional>

namespace tautline::formfinding {

class ElasticTangent {
 public:
  explicit ElasticTangent(const ElasticNet& net);

  int n_free() const noexcept { return static_cast<int>(free_nodes_.size()); }
  const std::vector<int>& free_nodes() const noexcept { return free_nodes_; }
  /// Adds a block of the tangent between two nodes, in the order given.
  using AddBlock = std::function<void(int, int, const Mat3&)>;
  /// @param[in] shift    added to the diagonal, in parts of the stiffness at each node [-]
  /// @param[in] add_film adds the tangent of a film; may be empty
  /// @return whether the tangent is positive definite
  bool factorise(const Coordinates& nodes, double shift,
                 const std::function<void(const AddBlock&)>& add_film = {});
  /// Displacements of the free nodes under forces on them [n_free x 3].
  Coordinates solve(const Coordinates& force) const;

 private:
  const ElasticNet& net_;
  std::vector<int> free_nodes_, free_index_;
  SparseFactor factor_;
};

}  // namespace tautline::formfinding
