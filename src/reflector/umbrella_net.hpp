#pragma once
/// @file
/// The net between the spokes of an umbrella: which nodes there are, and what joins them. Source: Belov
/// (2021), appendix A. Theory: docs/theory/umbrella.md

#include <array>
#include <vector>

namespace tautline::reflector {

using Side = std::array<int, 2>;

/// Cords a go from the last ring to the tips, cords b from the ends of the spoke lines to the peripheral
/// cord; they cross in a node, which parts them.
enum class CrossingCord { a_inner, a_outer, b_inner, b_outer };

/// Sector s lies between spokes s and s + 1 (counted round and round). Ring k has k parts in a sector; node t
/// of it, 0 to k, begins and ends on the spokes. Peripheral cord: part i from 0 (tip s) to `rings` (tip s +
/// 1).
class UmbrellaNet {
 public:
  UmbrellaNet(int spokes, int rings) : spokes_(spokes), rings_(rings) {}

  int n_spokes() const { return spokes_; }
  int n_rings() const { return rings_; }
  int n_nodes() const { return tip(spokes_ - 1) + 1; }
  /// Nodes that are neither on the hub nor tips; they come first.
  int n_free() const { return hub(0); }
  /// Nodes over the spokes come before all others.
  bool over_spoke(int node) const { return node < spokes_ * rings_; }

  int hub(int s) const { return peripheral_start() + spokes_ * (rings_ - 1) + s % spokes_; }
  int tip(int s) const { return hub(0) + spokes_ + s % spokes_; }
  int ring(int s, int k, int t) const;
  /// The node in which the cords next to spoke s (side 0) or s + 1 (side 1) cross.
  int crossing(int s, int side) const { return sector_start(s) + rings_ * (rings_ - 1) / 2 + side; }
  int peripheral(int s, int i) const;

  /// Without the end parts of the last ring, which the crossing cords replace.
  std::vector<Side> rings() const;
  /// The cords on the spoke lines and those parallel to them, from ring to ring.
  std::vector<Side> radials() const;
  std::vector<Side> connectors(bool at_ends) const;
  std::vector<Side> peripheral_cords(bool at_ends) const;
  std::vector<Side> crossing_cords(CrossingCord cord) const;
  std::vector<Side> end_cords() const;
  /// Triangles, counter-clockwise seen from +z.
  std::vector<std::array<int, 3>> facets() const;

 private:
  int spoke(int s, int k) const { return k == 0 ? hub(s) : rings_ * (s % spokes_) + k - 1; }
  int sector_start(int s) const { return rings_ * spokes_ + (s % spokes_) * (rings_ * (rings_ - 1) / 2 + 2); }
  int peripheral_start() const { return rings_ * spokes_ + spokes_ * (rings_ * (rings_ - 1) / 2 + 2); }

  int spokes_, rings_;
};

}  // namespace tautline::reflector
