#include <cmath>
#include <formfinding/constraint.hpp>

namespace tautline::formfinding {

VecX ConstraintRows::missing() const {
  const auto n = static_cast<Eigen::Index>(value.size());
  return Eigen::Map<const VecX>(target.data(), n) - Eigen::Map<const VecX>(value.data(), n);
}

void add_tensions(const NetState& state, const VecX& target, ConstraintRows& rows) {
  for (int b = 0; b < target.size(); ++b) {
    if (std::isnan(target[b])) continue;
    const double q = state.force_density[b], L = state.length[b];
    const int row = static_cast<int>(rows.value.size());
    rows.value.push_back(q * L);
    rows.target.push_back(target[b]);
    rows.by_force_density.emplace_back(row, b, L);
    if (L == 0) continue;  // no direction, no derivative
    for (int d = 0; d < 3; ++d) rows.by_vector[d].emplace_back(row, b, q * state.vectors(b, d) / L);
  }
}

}  // namespace tautline::formfinding
