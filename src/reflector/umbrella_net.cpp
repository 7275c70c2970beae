#include <reflector/umbrella_net.hpp>

namespace tautline::reflector {

int UmbrellaNet::ring(int s, int k, int t) const {
  if (t == 0) return spoke(s, k);
  if (t == k) return spoke(s + 1, k);
  return sector_start(s) + (k - 1) * (k - 2) / 2 + t - 1;
}

int UmbrellaNet::peripheral(int s, int i) const {
  if (i == 0) return tip(s);
  if (i == rings_) return tip(s + 1);
  return peripheral_start() + (s % spokes_) * (rings_ - 1) + i - 1;
}

std::vector<Side> UmbrellaNet::rings() const {
  std::vector<Side> sides;
  for (int s = 0; s < spokes_; ++s)
    for (int k = 1; k <= rings_; ++k) {
      const int skipped = k == rings_ ? 1 : 0;
      for (int t = skipped; t < k - skipped; ++t) sides.push_back({ring(s, k, t), ring(s, k, t + 1)});
    }
  return sides;
}

std::vector<Side> UmbrellaNet::radials() const {
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

std::vector<Side> UmbrellaNet::connectors(bool at_ends) const {
  std::vector<Side> sides;
  for (int s = 0; s < spokes_; ++s)
    for (int t = 1; t < rings_; ++t)
      if ((t == 1 || t == rings_ - 1) == at_ends) sides.push_back({ring(s, rings_, t), peripheral(s, t)});
  return sides;
}

std::vector<Side> UmbrellaNet::peripheral_cords(bool at_ends) const {
  std::vector<Side> sides;
  for (int s = 0; s < spokes_; ++s)
    for (int i = 0; i < rings_; ++i)
      if ((i == 0 || i == rings_ - 1) == at_ends) sides.push_back({peripheral(s, i), peripheral(s, i + 1)});
  return sides;
}

std::vector<Side> UmbrellaNet::crossing_cords(CrossingCord cord) const {
  std::vector<Side> sides;
  for (int s = 0; s < spokes_; ++s)
    for (int side = 0; side < 2; ++side) {
      const int middle = crossing(s, side), next_to_spoke = side == 0 ? 1 : rings_ - 1;
      switch (cord) {
        case CrossingCord::a_inner:
          sides.push_back({ring(s, rings_, next_to_spoke), middle});
          break;
        case CrossingCord::a_outer:
          sides.push_back({middle, tip(s + side)});
          break;
        case CrossingCord::b_inner:
          sides.push_back({spoke(s + side, rings_), middle});
          break;
        case CrossingCord::b_outer:
          sides.push_back({middle, peripheral(s, next_to_spoke)});
          break;
      }
    }
  return sides;
}

std::vector<Side> UmbrellaNet::end_cords() const {
  std::vector<Side> sides;
  for (int s = 0; s < spokes_; ++s) sides.push_back({spoke(s, rings_), tip(s)});
  return sides;
}

std::vector<std::array<int, 3>> UmbrellaNet::facets() const {
  std::vector<std::array<int, 3>> facets;
  for (int s = 0; s < spokes_; ++s) {
    facets.push_back({hub(s), spoke(s, 1), hub(s + 1)});
    facets.push_back({hub(s + 1), spoke(s, 1), spoke(s + 1, 1)});
    for (int k = 1; k < rings_; ++k)
      for (int t = 0; t <= k; ++t) {
        const bool at_spoke = t == 0 || t == k;
        if (k + 1 < rings_ || !at_spoke)
          facets.push_back({ring(s, k, t), ring(s, k + 1, t), ring(s, k + 1, t + 1)});
        if (t < k) facets.push_back({ring(s, k, t), ring(s, k + 1, t + 1), ring(s, k, t + 1)});
      }
  }
  return facets;
}

}  // namespace tautline::reflector
