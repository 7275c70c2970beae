#include <formfinding/constraint.hpp>

#include <cmath>

namespace tautline::formfinding {

namespace {

int begin_row(ConstraintRows& rows, double value, double target, double scale) {
  rows.value.push_back(value / scale);
  rows.target.push_back(target / scale);
  rows.scale.push_back(scale);
  return static_cast<int>(rows.value.size()) - 1;
}

/// Derivatives of a row that depends on the force density and the length of one branch.
void add_branch(const NetState& state, int b, double by_q, double by_length, int row, ConstraintRows& rows) {
  const double scale = rows.scale[row];
  rows.by_force_density.emplace_back(row, b, by_q / scale);
  if (state.length[b] == 0) return;  // no direction, no derivative
  for (int d = 0; d < 3; ++d)
    rows.by_vector[d].emplace_back(row, b, by_length * state.vectors(b, d) / (state.length[b] * scale));
}

void add_tension(const NetState& state, int b, double target, double scale, ConstraintRows& rows) {
  const double q = state.force_density[b], L = state.length[b];
  add_branch(state, b, L, q, begin_row(rows, q * L, target, scale), rows);
}

void add_unstressed_length(const NetState& state, int b, double EA, double target, ConstraintRows& rows) {
  const double q = state.force_density[b], L = state.length[b], stretch = (EA + q * L) / EA, L0 = L / stretch;
  add_branch(state, b, -L0 * L0 / EA, 1 / (stretch * stretch), begin_row(rows, L0, target, target), rows);
}

/// Reaction of node i in direction d: -(sum of q (x_j - x_i) + load).
void add_reaction(const NetSystem& system, const NetState& state, int node, const std::vector<int>& branches,
                  int d, double target, double scale, ConstraintRows& rows) {
  double value = system.net().load.empty() ? 0.0 : -system.net().load[node][d];
  const auto sign = [&](int b) { return system.net().branches[b][0] == node ? -1.0 : 1.0; };
  for (const int b : branches) value += sign(b) * state.force_density[b] * state.vectors(b, d);
  const int row = begin_row(rows, value, target, scale);
  for (const int b : branches) {
    rows.by_force_density.emplace_back(row, b, sign(b) * state.vectors(b, d) / scale);
    rows.by_vector[d].emplace_back(row, b, sign(b) * state.force_density[b] / scale);
  }
}

void add_reactions(const NetSystem& system, const NetState& state, const Constraint& constraint,
                   double force_scale, ConstraintRows& rows) {
  const int d = static_cast<int>(constraint.kind) - static_cast<int>(ConstraintKind::reaction_x);
  std::vector<std::vector<int>> at(system.net().nodes.size());
  for (int b = 0; b < system.n_branches(); ++b)
    for (const int node : system.net().branches[b]) at[node].push_back(b);
  for (std::size_t k = 0; k < constraint.members.size(); ++k) {
    const int node = constraint.members[k];
    add_reaction(system, state, node, at[node], d, constraint.value[constraint.value.size() == 1 ? 0 : k],
                 force_scale, rows);
  }
}

}  // namespace

VecX ConstraintRows::missing() const {
  const auto n = static_cast<Eigen::Index>(value.size());
  VecX r = Eigen::Map<const VecX>(target.data(), n) - Eigen::Map<const VecX>(value.data(), n);
  for (const auto& [first, count] : centred)
    r.segment(first, count).array() -= r.segment(first, count).mean();
  return r;
}

void add_tensions(const NetState& state, const VecX& target, ConstraintRows& rows) {
  for (int b = 0; b < target.size(); ++b)
    if (!std::isnan(target[b])) add_tension(state, b, target[b], 1, rows);
}

void add_constraint(const NetSystem& system, const NetState& state, const Constraint& constraint,
                    const VecX& axial_stiffness, double force_scale, ConstraintRows& rows) {
  const auto value = [&](std::size_t k) { return constraint.value[constraint.value.size() == 1 ? 0 : k]; };
  const auto for_each = [&](const auto& add) {
    for (std::size_t k = 0; k < constraint.members.size(); ++k) add(constraint.members[k], k);
  };
  switch (constraint.kind) {
    case ConstraintKind::tension:
      return for_each([&](int b, std::size_t k) { add_tension(state, b, value(k), value(k), rows); });
    case ConstraintKind::length:
      return for_each([&](int b, std::size_t k) {
        add_branch(state, b, 0, 1, begin_row(rows, state.length[b], value(k), value(k)), rows);
      });
    case ConstraintKind::unstressed_length:
      return for_each(
          [&](int b, std::size_t k) { add_unstressed_length(state, b, axial_stiffness[b], value(k), rows); });
    case ConstraintKind::equal_tension:
      rows.centred.push_back(
          {static_cast<int>(rows.value.size()), static_cast<int>(constraint.members.size())});
      return for_each([&](int b, std::size_t) { add_tension(state, b, 0, force_scale, rows); });
    default:
      return add_reactions(system, state, constraint, force_scale, rows);
  }
}

}  // namespace tautline::formfinding
