#pragma once
/// @file
/// The equilibrium equations of a net, D x = f - D_f x_f (eq. 2.12), and the incidence matrix C as two
/// operations.

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <tautline/formfinding/net.hpp>

namespace tautline::formfinding {

/// Row = node or branch, column = direction.
using Coordinates = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// Throws ModelError unless indices and sizes fit together.
void check(const Net& net);

class NetSystem {
 public:
  /// @pre `net` passed check() and outlives this object.
  explicit NetSystem(const Net& net);

  int n_free() const noexcept { return static_cast<int>(free_nodes_.size()); }
  int n_branches() const noexcept { return static_cast<int>(net_.branches.size()); }
  const Net& net() const noexcept { return net_; }
  const std::vector<int>& free_nodes() const noexcept { return free_nodes_; }

  /// Factorises D for these force densities. @throws ModelError if D is singular, naming a node.
  void factorise(const VecX& force_density);
  /// D^-1 `right`, rows = free nodes. @pre factorised
  MatX solve(const MatX& right) const;
  /// Node coordinates in equilibrium in all three directions. @pre factorised for the same force densities
  Coordinates equilibrium(const VecX& force_density) const;

  /// C: second minus first end of every branch, from values at the free nodes (zero at the fixed ones).
  MatX along_branches(const MatX& free_values) const;
  /// C^T restricted to the free nodes: the transpose of along_branches.
  MatX at_free_nodes(const MatX& branch_values) const;

 private:
  /// @throws ModelError naming a free node that no path of branches with a force density joins to a fixed
  /// node.
  void check_hung(const VecX& force_density) const;
  void check_pivots() const;

  const Net& net_;
  std::vector<int> free_nodes_;    ///< node of each free index
  std::vector<int> free_index_;    ///< free index of each node, -1 if fixed
  Eigen::SparseMatrix<double> D_;  ///< lower triangle
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
  bool analysed_ = false;
};

/// Second minus first end of every branch [m].
Coordinates branch_vectors(const Net& net, const Coordinates& nodes);

/// Sum of all branch forces and loads on each node [N].
Coordinates nodal_forces(const Net& net, const VecX& force_density, const Coordinates& vectors);

}  // namespace tautline::formfinding
