#include <reflector/umbrella_net.hpp>

#include <algorithm>

namespace tautline::reflector {

namespace {

using Facet = std::array<int, 3>;

bool has_columns(NetPattern pattern) {
  return pattern == NetPattern::rectangles || pattern == NetPattern::right_triangles;
}

/// Columns of the nodes of ring k.
std::vector<int> columns_of(NetPattern front, int k) {
  std::vector<int> columns;
  for (int y = -k; y <= k; ++y) {
    const bool there = !has_columns(front)               ? (k + y) % 2 == 0
                       : front == NetPattern::rectangles ? y != 0
                                                         : y != 0 || k > 1;
    if (there) columns.push_back(y);
  }
  return columns;
}

void append(std::vector<Side>& to, const std::vector<Side>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

}  // namespace

UmbrellaNet::UmbrellaNet(int spokes, int rings, NetPattern front)
    : spokes_(spokes), rings_(rings), front_(front), sector_size_(front == NetPattern::triangles ? 2 : 0) {
  for (int k = 0; k <= rings; ++k) columns_.push_back(k == 0 ? std::vector{0} : columns_of(front, k));
  for (int k = 1; k <= rings; ++k) sector_size_ += parts(k) - 1;
}

int UmbrellaNet::ring(int s, int k, int i) const {
  if (i == 0) return spoke(s, k);
  if (i == parts(k)) return spoke(s + 1, k);
  int before = 0;
  for (int j = 1; j < k; ++j) before += parts(j) - 1;
  return sector_start(s) + before + i - 1;
}

int UmbrellaNet::at(int s, int k, int y) const {
  const auto& columns = columns_[k];
  const auto found = std::find(columns.begin(), columns.end(), y);
  return found == columns.end() ? -1 : ring(s, k, static_cast<int>(found - columns.begin()));
}

int UmbrellaNet::peripheral(int s, int i) const {
  if (i == 0) return tip(s);
  if (i == parts(rings_)) return tip(s + 1);
  return peripheral_start() + (s % spokes_) * (parts(rings_) - 1) + i - 1;
}

/// Triangles lack the end parts of the last ring, which the crossing cords replace; coarse ones every second
/// ring.
std::vector<Side> UmbrellaNet::ring_cords(NetPattern pattern) const {
  std::vector<Side> sides;
  for (int s = 0; s < spokes_; ++s)
    for (int k = 1; k <= rings_; ++k) {
      if (pattern == NetPattern::coarse_triangles && k % 2 == 1) continue;
      const int skipped = k == rings_ && pattern == NetPattern::triangles ? 1 : 0;
      for (int i = skipped; i < parts(k) - skipped; ++i) sides.push_back({ring(s, k, i), ring(s, k, i + 1)});
    }
  return sides;
}

std::vector<Side> UmbrellaNet::spoke_cords() const {
  std::vector<Side> sides;
  for (int s = 0; s < spokes_; ++s)
    for (int k = 0; k < rings_; ++k) sides.push_back({spoke(s, k), spoke(s, k + 1)});
  return sides;
}

/// The cords on the spoke lines and those parallel to them, from ring to ring.
std::vector<Side> UmbrellaNet::triangle_radials() const {
  std::vector<Side> sides;
  for (int s = 0; s < spokes_; ++s) {
    sides.push_back({hub(s), spoke(s, 1)});
    // The t-th node of ring k lies between the t-th and the (t + 1)-th of ring k + 1.
    for (int k = 1; k < rings_; ++k)
      for (int t = 0; t <= k; ++t) {
        sides.push_back({ring(s, k, t), ring(s, k + 1, t)});
        if (t < k) sides.push_back({ring(s, k, t), ring(s, k + 1, t + 1)});
      }
  }
  return sides;
}

/// Every second of the lines parallel to the spokes; they begin where an even ring meets the other spoke.
std::vector<Side> UmbrellaNet::coarse_diagonals() const {
  std::vector<Side> sides;
  for (int s = 0; s < spokes_; ++s)
    for (int k = 2; k < rings_; ++k)
      for (int t = 0; t <= k; ++t) {
        if (t > 0 && t % 2 == 0) sides.push_back({ring(s, k, t), ring(s, k + 1, t)});
        if (t < k && (k - t) % 2 == 0) sides.push_back({ring(s, k, t), ring(s, k + 1, t + 1)});
      }
  return sides;
}

std::vector<Side> UmbrellaNet::column_cords() const {
  std::vector<Side> sides;
  for (int s = 0; s < spokes_; ++s)
    for (int k = 1; k < rings_; ++k)
      for (const int y : columns_[k]) sides.push_back({at(s, k, y), at(s, k + 1, y)});
  return sides;
}

/// From the nodes that the lattice of isosceles triangles has, too; not along the spokes.
std::vector<Side> UmbrellaNet::right_diagonals() const {
  std::vector<Side> sides;
  for (int s = 0; s < spokes_; ++s)
    for (int k = 1; k < rings_; ++k)
      for (const int y : columns_[k]) {
        if ((k + y) % 2 != 0) continue;
        if (y > -k) sides.push_back({at(s, k, y), at(s, k + 1, y - 1)});
        if (y < k) sides.push_back({at(s, k, y), at(s, k + 1, y + 1)});
      }
  return sides;
}

std::vector<Side> UmbrellaNet::connectors(int first, int last, int step) const {
  std::vector<Side> sides;
  for (int s = 0; s < spokes_; ++s)
    for (int i = first; i <= last; i += step) sides.push_back({ring(s, rings_, i), peripheral(s, i)});
  return sides;
}

std::vector<Side> UmbrellaNet::peripheral_cords(bool at_ends, bool through_crossings) const {
  std::vector<Side> sides;
  const int n = parts(rings_);
  for (int s = 0; s < spokes_; ++s)
    for (int i = 0; i < n; ++i) {
      if ((i == 0 || i == n - 1) != at_ends) continue;
      const int a = peripheral(s, i), b = peripheral(s, i + 1);
      if (at_ends && through_crossings) {
        const int middle = crossing(s, i == 0 ? 0 : 1);
        sides.push_back({a, middle});
        sides.push_back({middle, b});
      } else {
        sides.push_back({a, b});
      }
    }
  return sides;
}

/// Cords a go from the last ring to the tips, cords b from the ends of the spoke lines to the peripheral
/// cord; they cross in a node, which parts them.
std::vector<CordGroup> UmbrellaNet::crossing_cords() const {
  CordGroup a_inner{"crossing_a_inner", {}}, a_outer{"crossing_a_outer", {}}, b_inner{"crossing_b_inner", {}},
      b_outer{"crossing_b_outer", {}};
  for (int s = 0; s < spokes_; ++s)
    for (int side = 0; side < 2; ++side) {
      const int middle = crossing(s, side), next_to_spoke = side == 0 ? 1 : rings_ - 1;
      a_inner.sides.push_back({ring(s, rings_, next_to_spoke), middle});
      a_outer.sides.push_back({middle, tip(s + side)});
      b_inner.sides.push_back({spoke(s + side, rings_), middle});
      b_outer.sides.push_back({middle, peripheral(s, next_to_spoke)});
    }
  return {a_inner, a_outer, b_inner, b_outer};
}

std::vector<Side> UmbrellaNet::end_cords() const {
  std::vector<Side> sides;
  for (int s = 0; s < spokes_; ++s) sides.push_back({spoke(s, rings_), tip(s)});
  return sides;
}

std::vector<CordGroup> UmbrellaNet::triangle_cords(bool separate_rings, bool with_end_cords) const {
  auto net = triangle_radials();
  const auto rings = ring_cords(NetPattern::triangles);
  if (!separate_rings) append(net, rings);
  const auto ends = connectors(1, rings_ - 1, rings_ - 2);
  std::vector<CordGroup> groups{{"net", net}};
  if (separate_rings) groups.push_back({"rings", rings});
  groups.push_back({"connectors", connectors(2, rings_ - 2, 1)});
  groups.push_back({"end_connectors", ends});
  groups.push_back({"peripheral", peripheral_cords(false, false)});
  groups.push_back({"end_peripheral", peripheral_cords(true, false)});
  for (auto& group : crossing_cords()) groups.push_back(std::move(group));
  if (with_end_cords) groups.push_back({"end_cords", end_cords()});
  return groups;
}

std::vector<CordGroup> UmbrellaNet::plain_cords(NetPattern pattern) const {
  auto net = spoke_cords();
  if (pattern == NetPattern::coarse_triangles) append(net, coarse_diagonals());
  if (pattern == NetPattern::right_triangles) append(net, right_diagonals());
  std::vector<CordGroup> groups{{"net", net}, {"rings", ring_cords(pattern)}};
  if (has_columns(pattern)) groups.push_back({"columns", column_cords()});
  const int last = parts(rings_) - 1;
  if (has_columns(pattern)) groups.push_back({"connectors", connectors(1, last, 1)});
  if (pattern == NetPattern::coarse_triangles) groups.push_back({"connectors", connectors(2, last, 2)});
  groups.push_back({"peripheral", peripheral_cords(false, false)});
  groups.push_back({"end_peripheral", peripheral_cords(true, has_crossings())});
  groups.push_back({"end_cords", end_cords()});
  return groups;
}

std::vector<CordGroup> UmbrellaNet::cords(NetPattern pattern, bool separate_rings, bool end_cords) const {
  return pattern == NetPattern::triangles ? triangle_cords(separate_rings, end_cords) : plain_cords(pattern);
}

void UmbrellaNet::add_lattice_facets(int s, std::vector<Facet>& facets) const {
  for (int k = 1; k < rings_; ++k)
    for (int t = 0; t <= k; ++t) {
      const bool at_spoke = t == 0 || t == k;
      if (k + 1 < rings_ || !at_spoke || !has_crossings())
        facets.push_back({ring(s, k, t), ring(s, k + 1, t), ring(s, k + 1, t + 1)});
      if (t < k) facets.push_back({ring(s, k, t), ring(s, k + 1, t + 1), ring(s, k, t + 1)});
    }
}

/// Rectangles between columns y and z, each in two right triangles; right ones at the spokes.
void UmbrellaNet::add_column_facets(int s, std::vector<Facet>& facets) const {
  for (int k = 1; k < rings_; ++k) {
    facets.push_back({at(s, k, -k), at(s, k + 1, -k - 1), at(s, k + 1, -k)});
    for (int i = 0; i < parts(k); ++i) {
      const int y = column(k, i), z = column(k, i + 1);
      const int a = at(s, k, y), b = at(s, k, z), c = at(s, k + 1, y), d = at(s, k + 1, z);
      const int middle = z == y + 2 ? at(s, k + 1, y + 1) : -1;
      if (middle >= 0) {
        for (const Facet& facet : {Facet{a, c, middle}, Facet{a, middle, b}, Facet{b, middle, d}})
          facets.push_back(facet);
      } else if ((k + y) % 2 == 0) {
        facets.push_back({a, c, d});
        facets.push_back({a, d, b});
      } else {
        facets.push_back({a, c, b});
        facets.push_back({b, c, d});
      }
    }
    facets.push_back({at(s, k, k), at(s, k + 1, k), at(s, k + 1, k + 1)});
  }
}

std::vector<Facet> UmbrellaNet::facets() const {
  std::vector<Facet> facets;
  for (int s = 0; s < spokes_; ++s) {
    facets.push_back({hub(s), spoke(s, 1), hub(s + 1)});
    facets.push_back({hub(s + 1), spoke(s, 1), spoke(s + 1, 1)});
    if (has_columns(front_))
      add_column_facets(s, facets);
    else
      add_lattice_facets(s, facets);
  }
  return facets;
}

}  // namespace tautline::reflector
