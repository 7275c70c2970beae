#pragma once
/// @file
/// The equilibrium equations of a net, D x = f - D_f x_f (eq. 2.12), and the incidence matrix C as two
/// operations.

#include <formfinding/sparse_factor.hpp>
#include <tautline/formfinding/net.hpp>

namespace tautline::formfinding {

/// Throws ModelError unless indices and sizes fit together.
void check(const Net& net, const Surface* surface = nullptr);

/// A net in the shape that some force densities give it.
struct NetState {
  VecX force_density;     ///< [N/m]
  Coordinates nodes;      ///< all nodes [m]
  Coordinates vectors;    ///< second minus first end of every branch [m]
  VecX length;            ///< [m]
  VecX slope_x, slope_y;  ///< dz/dx, dz/dy of the surface at the free nodes; zero at those not on it
  bool z_follows_surface =
      true;  ///< in the derivative; if not, dz comes from vertical equilibrium (eq. 2.61)
};

/// @brief The shape of a net as a function of its force densities, and how it answers forces.
///
/// Free nodes are in equilibrium in all directions but those in which a surface (z) or a guide holds them.
class NetSystem {
 public:
  /// @pre `net` passed check(); net and surface outlive this object.
  explicit NetSystem(const Net& net, const Surface* surface = nullptr);

  int n_free() const noexcept { return static_cast<int>(free_nodes_.size()); }
  int n_branches() const noexcept { return static_cast<int>(net_.branches.size()); }
  const Net& net() const noexcept { return net_; }
  const Surface* surface() const noexcept { return surface_; }
  const std::vector<int>& free_nodes() const noexcept { return free_nodes_; }
  int free_index(int node) const noexcept { return free_index_[node]; }

  /// Ways in which a free node can move, and directions in which it must balance: the columns.
  struct Directions {
    int count = 3;
    Mat3 motion = Mat3::Identity(), force = Mat3::Identity();
  };
  Directions directions(const NetState& state, int free) const;

  /// Factorises D for these force densities. @throws ModelError if D is singular, naming a node.
  void factorise(const VecX& force_density);
  /// Number of directions in which the factorised net is unstable: negative eigenvalues of D.
  int negative_pivots() const;

  /// Shape in equilibrium. @pre factorised for the same force densities
  NetState equilibrium(const VecX& force_density) const;
  /// The state of these nodes, those of the surface put onto it.
  NetState state(const VecX& force_density, Coordinates nodes) const;

  /// How the free nodes move when `force` [n_free x 3] is added to them, force densities held. @pre
  /// factorised
  Coordinates respond(const NetState& state, const Coordinates& force) const;
  /// The transpose of respond.
  Coordinates respond_transposed(const NetState& state, const Coordinates& values) const;
  /// Removes the components of forces on free nodes that surface and guides take.
  Coordinates unbalanced(Coordinates force) const;

  /// C: second minus first end of every branch, from values at the free nodes (zero at the fixed ones).
  Coordinates along_branches(const Coordinates& free_values) const;
  /// C^T restricted to the free nodes: the transpose of along_branches.
  Coordinates at_free_nodes(const Coordinates& branch_values) const;

 private:
  bool on_surface(int free) const noexcept { return !on_surface_.empty() && on_surface_[free]; }
  bool guided() const noexcept { return !net_.guides.empty(); }
  /// @throws ModelError naming a free node that no path of branches with a force density joins to a fixed
  /// node.
  void check_hung(const VecX& force_density) const;
  [[noreturn]] void report_cancelled(int free) const;
  void factorise_scalar(const VecX& force_density);
  void factorise_guided(const VecX& force_density);
  /// B^T `force`: one value for each unknown of the guided net.
  VecX to_unknowns(const Coordinates& force) const;
  Coordinates from_unknowns(const VecX& unknowns) const;
  Coordinates solve_heights(const Coordinates& force) const;
  /// D_zs: forces along z at the free nodes off the surface from displacements of those on it, and back.
  VecX couple(const VecX& values, bool transposed) const;

  const Net& net_;
  const Surface* surface_;
  std::vector<int> free_nodes_;     ///< node of each free index
  std::vector<int> free_index_;     ///< free index of each node, -1 if fixed
  std::vector<bool> on_surface_;    ///< of each free index; empty without a surface
  std::vector<int> height_nodes_;   ///< free indices off the surface
  std::vector<int> height_index_;   ///< index among those of each free index, -1 on the surface
  std::vector<Mat3> basis_;         ///< guided net: columns are the free directions of each free index
  std::vector<int> first_unknown_;  ///< guided net: of each free index, and the total
  SparseFactor factor_;             ///< of D, or of B^T D B for a guided net
  SparseFactor height_factor_;      ///< of D among the nodes off the surface, if only some are on it
  VecX force_density_;              ///< factorised
};

/// Second minus first end of every branch [m].
Coordinates branch_vectors(const Net& net, const Coordinates& nodes);

/// Sum of all branch forces and loads on each node [N].
Coordinates nodal_forces(const Net& net, const VecX& force_density, const Coordinates& vectors);

Points to_points(const Coordinates& nodes);
Coordinates to_coordinates(const Points& points);

/// |x|, |y|, |z| over the free nodes [m].
Vec3 coordinate_norm(const NetSystem& system, const NetState& state);

}  // namespace tautline::formfinding
