#pragma once
/// @file
/// The nets between the spokes of an umbrella: which nodes there are, and what joins them. Source: Belov
/// (2021), appendix A and section 3.3.3. Theory: docs/theory/umbrella.md

#include <array>
#include <string>
#include <vector>

#include <tautline/reflector/umbrella_options.hpp>

namespace tautline::reflector {

using Side = std::array<int, 2>;

/// Cords of one net that have a name in common.
struct CordGroup {
  std::string name;  ///< without front_ or rear_
  std::vector<Side> sides;
};

/// @brief Nodes of the front net; the rear net has one under each.
///
/// Sector s lies between spokes s and s + 1 (counted round and round). A node of ring k has a column y from
/// -k (on spoke s) to k (on spoke s + 1); its number i on the ring counts the columns that the pattern has
/// there: every second with triangles and belts, all but 0 with rectangles, all with right triangles (ring 1
/// lacks 0). The peripheral cord has as many nodes between its tips as the last ring between its ends.
class UmbrellaNet {
 public:
  /// @param[in] front  the front net's pattern
  UmbrellaNet(int spokes, int rings, NetPattern front = NetPattern::triangles);

  int n_spokes() const { return spokes_; }
  int n_rings() const { return rings_; }
  NetPattern front() const { return front_; }
  int n_nodes() const { return tip(spokes_ - 1) + 1; }
  /// Nodes that are neither on the hub nor tips; they come first.
  int n_free() const { return hub(0); }
  /// Nodes over the spokes come before all others.
  bool over_spoke(int node) const { return node < spokes_ * rings_; }
  bool has_crossings() const { return front_ == NetPattern::triangles; }

  /// Parts of ring k in a sector.
  int parts(int k) const { return static_cast<int>(columns_[k].size()) - 1; }
  /// Column of the i-th node of ring k.
  int column(int k, int i) const { return columns_[k][i]; }

  int hub(int s) const { return peripheral_start() + spokes_ * (parts(rings_) - 1) + s % spokes_; }
  int tip(int s) const { return hub(0) + spokes_ + s % spokes_; }
  int spoke(int s, int k) const { return k == 0 ? hub(s) : rings_ * (s % spokes_) + k - 1; }
  int ring(int s, int k, int i) const;
  /// The node in which the cords next to spoke s (side 0) or s + 1 (side 1) cross.
  int crossing(int s, int side) const { return sector_start(s) + sector_size_ - 2 + side; }
  int peripheral(int s, int i) const;

  /// Cords of a net of the pattern on these nodes, in the order of the model's groups.
  /// @param[in] separate_rings, end_cords  as in UmbrellaOptions; patterns other than triangles have both
  std::vector<CordGroup> cords(NetPattern pattern, bool separate_rings, bool end_cords) const;
  /// Triangles of the cloth on the front net, counter-clockwise seen from +z.
  std::vector<std::array<int, 3>> facets() const;

 private:
  int sector_start(int s) const { return rings_ * spokes_ + (s % spokes_) * sector_size_; }
  int peripheral_start() const { return rings_ * spokes_ + spokes_ * sector_size_; }
  /// Node of ring k in column y, or -1.
  int at(int s, int k, int y) const;

  std::vector<CordGroup> triangle_cords(bool separate_rings, bool end_cords) const;
  std::vector<CordGroup> plain_cords(NetPattern pattern) const;
  std::vector<Side> ring_cords(NetPattern pattern) const;
  std::vector<Side> spoke_cords() const;
  std::vector<Side> triangle_radials() const;
  std::vector<Side> coarse_diagonals() const;
  std::vector<Side> column_cords() const;
  std::vector<Side> right_diagonals() const;
  std::vector<Side> connectors(int first, int last, int step) const;
  std::vector<Side> peripheral_cords(bool at_ends, bool through_crossings) const;
  std::vector<CordGroup> crossing_cords() const;
  std::vector<Side> end_cords() const;
  void add_lattice_facets(int s, std::vector<std::array<int, 3>>& facets) const;
  void add_column_facets(int s, std::vector<std::array<int, 3>>& facets) const;

  int spokes_, rings_;
  NetPattern front_;
  std::vector<std::vector<int>> columns_;  ///< of each ring, from spoke to spoke
  int sector_size_;                        ///< nodes of a sector that are neither over spokes nor peripheral
};

}  // namespace tautline::reflector
