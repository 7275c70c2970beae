#pragma once
/// @file
/// The triangular net inside a rim: which nodes there are, and what joins them. Theory:
/// docs/theory/reflector.md

#include <array>
#include <vector>

namespace tautline::reflector {

/// The triangular net: centre, ring k of 6k nodes from +x counter-clockwise.
class HexagonalLattice {
 public:
  explicit HexagonalLattice(int rings) : rings_(rings) {}

  int rings() const { return rings_; }
  int n_nodes() const { return first(rings_ + 1); }
  /// Nodes inside the rim; they come first.
  int n_free() const { return first(rings_); }
  int n_rim() const { return 6 * rings_; }
  /// Node `j` (counted round and round) of ring `k`.
  int node(int k, int j) const { return k == 0 ? 0 : first(k) + j % (6 * k); }
  int rim(int j) const { return node(rings_, j); }

  /// Triangles, counter-clockwise seen from +z.
  std::vector<std::array<int, 3>> facets() const;
  /// Sides of the triangles, lower node first, except those between neighbours on the rim.
  std::vector<std::array<int, 2>> sides() const;

 private:
  static int first(int k) { return k == 0 ? 0 : 1 + 3 * k * (k - 1); }
  int rings_;
};

}  // namespace tautline::reflector
