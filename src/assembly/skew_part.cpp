// What the tangent leaves out because it is not symmetric: loads that no potential has. Theory:
// docs/theory/newton.md#loads-without-a-potential
#include <array>
#include <map>
#include <utility>

#include <tautline/assembly/system.hpp>
#include <tautline/core/rotation.hpp>

#include "assembly/expansion.hpp"

namespace tautline::assembly {

namespace {

/// Adds a skew matrix given on the rows of an expansion, without the rows and columns of held unknowns.
void add_free(const Expansion& expansion, MatX values, const std::vector<bool>& held, la::SkewPart& to) {
  if (!expansion.plain()) values = (expansion.matrix().transpose() * values * expansion.matrix()).eval();
  const auto blocks = expansion.blocks();
  const auto n = static_cast<int>(blocks.size());
  for (int i = 0; i < n; ++i)
    for (int c = 0; c < 3; ++c)
      if (held[static_cast<std::size_t>(3 * blocks[static_cast<std::size_t>(i)] + c)]) {
        values.row(3 * i + c).setZero();
        values.col(3 * i + c).setZero();
      }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      to.add(blocks[static_cast<std::size_t>(i)], blocks[static_cast<std::size_t>(j)],
             values.block<3, 3>(3 * i, 3 * j));
}

/// Pressure on each side of the facets, less that of the neighbour, by its nodes in ascending order: positive
/// where the facet goes round them in that order.
std::map<std::pair<int, int>, double> pressure_on_sides(const model::Model& model, const Acting& acting) {
  std::map<std::pair<int, int>, double> sides;
  std::size_t next = 0;
  const auto add = [&](const auto& facets) {
    for (const auto& facet : facets) {
      const double p = acting.pressure[next++];
      const int n = facet.nodes.size();
      for (int i = 0; p != 0 && i < n; ++i) {
        const int a = facet.nodes[i], b = facet.nodes[(i + 1) % n];
        sides[{std::min(a, b), std::max(a, b)}] += a < b ? p : -p;
      }
    }
  };
  add(model.membranes);
  add(model.shells);
  return sides;
}

}  // namespace

/// A dead moment m: -skew(m)/2 by spins. A pressure: on the sides where it ends, p/2 skew(side) times the
/// products of the shape functions.
la::SkewPart System::skew_part() {
  kinematics_.linearise(state_);
  la::SkewPart result(map_.layout);
  for (int node = 0; node < static_cast<int>(model_.nodes.size()); ++node) {
    const Vec3& moment = now_.moment[static_cast<std::size_t>(node)];
    if (moment.isZero(0) || !map_.rotational[static_cast<std::size_t>(node)]) continue;
    MatX values = MatX::Zero(6, 6);
    values.bottomRightCorner<3, 3>() = -skew(moment) / 2;
    add_free(Expansion(kinematics_, map_, std::array<int, 1>{node}, true), values, held(), result);
  }
  for (const auto& [side, p] : pressure_on_sides(model_, now_)) {
    if (p == 0) continue;
    const auto& [a, b] = side;
    const auto place = [&](int node) -> Vec3 {
      const auto at = static_cast<std::size_t>(node);
      return model_.nodes[at] + state_.displacement[at];
    };
    const Mat3 turn = p / 12 * skew(place(b) - place(a));
    MatX values(6, 6);
    values << 2 * turn, turn, turn, 2 * turn;
    add_free(Expansion(kinematics_, map_, std::array<int, 2>{a, b}, false), values, held(), result);
  }
  result.finish();
  return result;
}

}  // namespace tautline::assembly
