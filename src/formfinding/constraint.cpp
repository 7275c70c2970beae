#include <formfinding/constraint.hpp>

#include <cmath>

namespace tautline::formfinding {

namespace {

int begin_row(ConstraintRows& rows, double value, double target, double scale, double weight = 1) {
  rows.value.push_back(value / scale);
  rows.target.push_back(target / scale);
  rows.scale.push_back(scale);
  rows.weight.push_back(weight);
  return static_cast<int>(rows.value.size()) - 1;
}

/// A row that depends on the force density and the length of one branch.
struct BranchValue {
  double value = 0, by_q = 0, by_L = 0, by_qL = 0, by_qq = 0, by_LL = 0;
};

BranchValue tension_of(double q, double L) {
  return {q * L, L, q, 1, 0, 0};
}

BranchValue unstressed_length_of(double q, double L, double EA) {
  const double s = 1 + q * L / EA, L0 = L / s;
  return {L0,
          -L0 * L0 / EA,
          1 / (s * s),
          -2 * L / (EA * s * s * s),
          2 * L0 * L0 * L0 / (EA * EA),
          -2 * q / (EA * s * s * s)};
}

void add_branch(const NetState& state, int b, const BranchValue& of, double target, double scale,
                double weight, ConstraintRows& rows) {
  const int row = begin_row(rows, of.value, target, scale, weight);
  rows.by_force_density.emplace_back(row, b, of.by_q / scale);
  if (state.length[b] == 0) return;  // no direction, no derivative
  for (int d = 0; d < 3; ++d)
    rows.by_vector[d].emplace_back(row, b, of.by_L * state.vectors(b, d) / (state.length[b] * scale));
  rows.curvature.push_back({row, b, of.by_L / scale, of.by_qL / scale, of.by_qq / scale, of.by_LL / scale});
}

/// What kinds that ask something of a single branch ask it of.
BranchValue value_of(ConstraintKind kind, const NetState& state, int b, const VecX& axial_stiffness) {
  const double q = state.force_density[b], L = state.length[b];
  switch (kind) {
    case ConstraintKind::length:
      return {L, 0, 1, 0, 0, 0};
    case ConstraintKind::unstressed_length:
      return unstressed_length_of(q, L, axial_stiffness[b]);
    case ConstraintKind::force_density:
      return {q, 1, 0, 0, 0, 0};
    default:
      return tension_of(q, L);
  }
}

/// Reaction of node i in direction d: -(sum of q (x_j - x_i) + load).
void add_reaction(const NetSystem& system, const NetState& state, const Constraint& constraint,
                  std::size_t member, const std::vector<int>& branches, double scale, ConstraintRows& rows) {
  const int node = constraint.members[member];
  const int d = static_cast<int>(constraint.kind) - static_cast<int>(ConstraintKind::reaction_x);
  double value = system.net().load.empty() ? 0.0 : -system.net().load[node][d];
  const auto sign = [&](int b) { return system.net().branches[b][0] == node ? -1.0 : 1.0; };
  for (const int b : branches) value += sign(b) * state.force_density[b] * state.vectors(b, d);
  const double target = constraint.wanted(member, value);
  const int row = begin_row(rows, value, target, scale, constraint.weight);
  if (constraint.is_range() && target == value) return;
  for (const int b : branches) {
    rows.by_force_density.emplace_back(row, b, sign(b) * state.vectors(b, d) / scale);
    rows.by_vector[d].emplace_back(row, b, sign(b) * state.force_density[b] / scale);
    rows.by_product[d].emplace_back(row, b, sign(b) / scale);
  }
}

void add_reactions(const NetSystem& system, const NetState& state, const Constraint& constraint,
                   double force_scale, ConstraintRows& rows) {
  std::vector<std::vector<int>> at(system.net().nodes.size());
  for (int b = 0; b < system.n_branches(); ++b)
    for (const int node : system.net().branches[b]) at[node].push_back(b);
  for (std::size_t k = 0; k < constraint.members.size(); ++k)
    add_reaction(system, state, constraint, k, at[constraint.members[k]], force_scale, rows);
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
    if (!std::isnan(target[b]))
      add_branch(state, b, tension_of(state.force_density[b], state.length[b]), target[b], 1, 1, rows);
}

void add_constraint(const NetSystem& system, const NetState& state, const Constraint& constraint,
                    const VecX& axial_stiffness, double force_scale, ConstraintRows& rows) {
  if (constraint.kind >= ConstraintKind::reaction_x)
    return add_reactions(system, state, constraint, force_scale, rows);
  const bool equal = constraint.kind == ConstraintKind::equal_tension;
  if (equal)
    rows.centred.push_back(
        {static_cast<int>(rows.value.size()), static_cast<int>(constraint.members.size())});
  for (std::size_t k = 0; k < constraint.members.size(); ++k) {
    const int b = constraint.members[k];
    const BranchValue found = value_of(constraint.kind, state, b, axial_stiffness);
    const double target = equal ? 0 : constraint.wanted(k, found.value);
    const double scale = equal ? force_scale : constraint.size(k);
    if (constraint.is_range() && target == found.value)
      begin_row(rows, found.value, target, scale, constraint.weight);  // nothing to be mended
    else
      add_branch(state, b, found, target, scale, constraint.weight, rows);
  }
}

}  // namespace tautline::formfinding
