// Where supports that move take the structure, as a first guess. Theory:
// docs/theory/constraints.md#prescribed-motion
#include <algorithm>
#include <cmath>
#include <optional>

#include <tautline/assembly/system.hpp>
#include <tautline/core/rotation.hpp>

namespace tautline::assembly {

namespace {

constexpr double longest_turn = 0.5;   // of a support in one linear step [rad]
constexpr double farthest_turn = 1e6;  // that is followed in such steps [rad]

Vec3 of_block(const std::vector<double>& unknowns, int block) {
  return Eigen::Map<const Vec3>(unknowns.data() + 3 * block);
}

void put(const Vec3& value, int block, std::vector<double>& unknowns) {
  std::copy(value.begin(), value.end(), unknowns.begin() + 3 * block);
}

}  // namespace

/// Where supports turn far, in parts: each begins where the one before came to and takes off what that left
/// out of balance.
bool System::predict(analysis::Workspace& workspace) {
  if (drives_.empty() || lambda_ == driven_to_) return true;
  restart();
  if (turn_as_a_whole()) return true;
  const double from = driven_to_, way = lambda_ - from;
  double turn = 0;
  for (std::size_t node = 0; node < model_.nodes.size(); ++node)
    for (const auto& drive : drives_)
      if (drive.block >= 0 && drive.block == map_.rotation_block[node])
        turn = std::max(turn, drive.way.norm() * std::abs(way));
  if (!(turn <= farthest_turn)) {
    apply(from + way);
    return false;
  }
  const int parts = std::max(1, static_cast<int>(std::ceil(turn / longest_turn)));
  for (int part = 1; part <= parts; ++part) {
    apply(part == parts ? from + way : from + way * part / parts);
    if (!step_linearly(workspace)) {
      apply(from + way);
      return false;
    }
  }
  return true;
}

/// Newton's step with the tangent of the point where supports still are: from there they go their whole way
/// in one straight line, and what hangs on them goes along.
bool System::step_linearly(analysis::Workspace& workspace) {
  std::vector<double> way = drive_rates();
  for (double& part : way) part *= lambda_ - driven_to_;
  restart();
  la::Vector x(map_.layout), f(map_.layout);
  residual_at(state_, f);
  kinematics_.linearise(state_);
  const auto resistance = extrapolated_stiffness_times(way);
  std::vector<double> right(static_cast<std::size_t>(3 * map_.layout.local));
  f.read(right);
  for (std::size_t i = 0; i < right.size(); ++i) {
    const std::size_t unknown = i + static_cast<std::size_t>(3 * map_.layout.first);
    right[i] = held()[unknown] ? 0.0 : -right[i] - resistance[unknown];
  }
  f.write(right);
  wholly_extrapolated_tangent(workspace.tangent);
  if (!workspace.solver.factor(workspace.tangent)) return false;
  la::solve(workspace.solver, skew_part(), f, x);
  accept(x);
  restart();
  return true;
}

/// The turn of supports that hold all rotations, if it is one for all of them.
std::optional<Vec3> System::common_turn() const {
  constexpr double same = 1e-12;
  std::optional<Vec3> turn;
  const auto rates = drive_rates();
  for (int node = 0; node < static_cast<int>(model_.nodes.size()); ++node) {
    const int held = kinematics_.held_rotations(node);
    if (held == 0) continue;
    const int block = map_.rotation_block[static_cast<std::size_t>(node)];
    const Vec3 own = (lambda_ - driven_to_) * kinematics_.frame(block) * of_block(rates, block);
    if (held < 3 || (turn && (*turn - own).norm() > same * turn->norm())) return std::nullopt;
    turn = own;
  }
  if (turn && turn->isZero(0)) turn.reset();
  return turn;
}

/// Where all that holds the structure turns as one body, so does the structure: in one motion, however far.
/// @return false where it does not, and nothing has moved
bool System::turn_as_a_whole() {
  constexpr double same = 1e-9;
  const bool grounded = std::any_of(model_.springs.begin(), model_.springs.end(),
                                    [](const model::Spring& spring) { return spring.grounded(); });
  const auto turn = common_turn();
  if (!turn || grounded || !model_.constraints.empty() || !model_.cyclic_pairs.empty()) return false;
  const Mat3 rotation = rotation_of(*turn);
  const auto places = model::positions(model_, state_);
  const auto rates = drive_rates();
  const auto own_way = [&](int block) -> Vec3 { return (lambda_ - driven_to_) * of_block(rates, block); };
  const auto is_held = [&](int block, int c) { return held()[static_cast<std::size_t>(3 * block + c)]; };
  std::optional<Vec3> shift;  // of the origin, which the first node that is held tells
  for (std::size_t node = 0; node < places.size() && !shift; ++node)
    if (const int u = map_.displacement_block[node];
        u >= 0 && is_held(u, 0) && is_held(u, 1) && is_held(u, 2))
      shift = places[node] + kinematics_.frame(u) * own_way(u) - rotation * places[node];
  if (!shift) return false;
  std::vector<double> all(origin_.size(), 0.0);
  for (std::size_t node = 0; node < places.size(); ++node) {
    const int u = map_.displacement_block[node], r = map_.rotation_block[node];
    if (r >= 0 && kinematics_.turns_by_itself(static_cast<int>(node)))
      put(kinematics_.in_axes(r, *turn), r, all);
    if (u < 0) continue;
    const Vec3 way = kinematics_.in_axes(u, rotation * places[node] + *shift - places[node]);
    for (int c = 0; c < 3; ++c)
      if (is_held(u, c) && std::abs(way[c] - own_way(u)[c]) > same * size_) return false;
    put(way, u, all);
  }
  la::Vector x(map_.layout);
  x.write(own_part(all));
  accept(x);
  restart();
  last_motion_.reset();  // no element has changed
  return true;
}

}  // namespace tautline::assembly
