#pragma once
/// @file
/// What the reflectors with two triangular nets inside a circle have in common.

#include <reflector/hexagonal_lattice.hpp>
#include <string>
#include <tautline/model/model.hpp>
#include <tautline/reflector/paraboloid.hpp>
#include <tautline/reflector/triangular_net_options.hpp>

namespace tautline::reflector {

/// @throws ModelError where rings or gap make no net
void check_triangular_nets(const TriangularNetOptions& options);

/// Adds nets, ties and cloth to a model, front nodes first; the frame is left to who derives from it.
class TriangularNets {
 public:
  /// @throws ModelError where the options make no dish
  explicit TriangularNets(const TriangularNetOptions& options);

 protected:
  int rear(int front_node) const { return front_node + lattice_.n_nodes(); }
  int add_group(const std::string& name, model::ElementKind kind);
  /// Both nets: rings as circles, the last at rim_height, the others on the surface; the rear net mirrored.
  /// @throws ModelError if they touch
  void add_net_nodes();
  void add_nets_and_ties();
  void add_cloth();
  void add_net_selections();
  /// The beam in selection `held_strut`: of those in `beams`, spread evenly from +x, the one nearest to
  /// `azimuth` [degree].
  void hold_strut(const std::vector<std::vector<int>>& beams, double azimuth);

  Paraboloid surface_;
  HexagonalLattice lattice_;
  model::Model model_;

 private:
  void check_apart() const;

  const TriangularNetOptions& net_options_;
};

}  // namespace tautline::reflector
