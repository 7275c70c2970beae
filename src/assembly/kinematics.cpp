#include <tautline/assembly/kinematics.hpp>

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/core/rotation.hpp>
#include <tautline/model/names.hpp>

namespace tautline::assembly {

namespace {

using Term = model::LinearConstraint::Term;

/// Solves the linear constraints for their first components in terms of components that follow nothing: along
/// arms of no length to the leader, round a cyclic structure to the leading face, through other constraints.
class ConstraintSolver {
 public:
  ConstraintSolver(const model::Model& model, const std::vector<int>& link_of)
      : model_(model), link_of_(link_of), cyclic_of_(model.nodes.size(), -1) {
    for (std::size_t i = 0; i < model.cyclic_pairs.size(); ++i)
      cyclic_of_[model.cyclic_pairs[i].follower] = static_cast<int>(i);
    for (const auto& constraint : model.constraints) {
      Term first = constraint.terms.front();
      first.node = leader_at_its_place(first.node, constraint);
      if (cyclic_of_[first.node] >= 0)
        refuse(constraint, first.node, "follows another node by cyclic symmetry: write another node first");
      const auto [other, is_new] = by_component_.emplace(key(first), constrained.size());
      if (!is_new)
        refuse(constraint, first.node,
               "follows from another linear constraint in that direction: write another node first");
      constrained.push_back(first);
    }
    resolved.resize(constrained.size());
    mark_.assign(constrained.size(), Mark::none);
    for (std::size_t i = 0; i < constrained.size(); ++i) resolve(i);
  }

  std::vector<Term> constrained;
  std::vector<std::vector<Term>> resolved;

 private:
  enum class Mark { none, begun, done };

  static int key(const Term& term) { return 3 * term.node + term.component; }

  [[noreturn]] void refuse(const model::LinearConstraint& constraint, int node, const char* why) const {
    throw ModelError(fmt::format("{}a linear constraint: {} {}", model::prefix(constraint.where),
                                 model::node_at(model_, node), why));
  }

  int leader_at_its_place(int node, const model::LinearConstraint& constraint) const {
    while (link_of_[node] >= 0) {
      const auto& link = model_.links[link_of_[node]];
      if (model_.nodes[link.leader] != model_.nodes[node])
        refuse(constraint, node, "follows another node through an arm: write its leader in the constraint");
      node = link.leader;
    }
    return node;
  }

  void resolve(std::size_t index) {
    const auto& constraint = model_.constraints[index];
    if (mark_[index] == Mark::begun)
      refuse(constraint, constrained[index].node,
             "follows itself, through this constraint or a ring of them");
    if (mark_[index] == Mark::done) return;
    mark_[index] = Mark::begun;
    const double first = constraint.terms.front().coefficient;
    for (std::size_t k = 1; k < constraint.terms.size(); ++k) {
      const auto& term = constraint.terms[k];
      add({leader_at_its_place(term.node, constraint), term.component, -term.coefficient / first}, index);
    }
    mark_[index] = Mark::done;
  }

  /// Adds a component of a node that follows no link, or what it follows from, to what `index` is the sum of.
  void add(const Term& term, std::size_t index) {
    if (const int cyclic = cyclic_of_[term.node]; cyclic >= 0) {
      const auto& pair = model_.cyclic_pairs[cyclic];
      for (int c = 0; c < 3; ++c)
        if (const double by = pair.turn(term.component, c); by != 0)
          add({pair.leader, c, by * term.coefficient}, index);
      return;
    }
    const auto found = by_component_.find(key(term));
    if (found == by_component_.end()) {
      resolved[index].push_back(term);
      return;
    }
    resolve(found->second);
    const auto of = resolved[found->second];
    for (const auto& part : of)
      resolved[index].push_back({part.node, part.component, part.coefficient * term.coefficient});
  }

  const model::Model& model_;
  const std::vector<int>& link_of_;
  std::vector<int> cyclic_of_;  // by node: the pair whose follower it is, or -1
  std::map<int, std::size_t> by_component_;
  std::vector<Mark> mark_;
};

/// Directions in which a block is held; orthonormal, at most three.
class HeldDirections {
 public:
  void add(const Vec3& direction) {
    Vec3 rest = direction.normalized();
    for (const Vec3& known : basis_) rest -= known * known.dot(rest);
    if (rest.norm() > 1e-8) basis_.push_back(rest.normalized());
  }
  int count() const { return static_cast<int>(basis_.size()); }
  /// Whether every direction is a coordinate axis.
  bool along_axes() const {
    return std::all_of(basis_.begin(), basis_.end(),
                       [](const Vec3& d) { return d.cwiseAbs().maxCoeff() == 1; });
  }
  bool holds(int component) const {
    return std::any_of(basis_.begin(), basis_.end(),
                       [&](const Vec3& d) { return std::abs(d[component]) == 1; });
  }
  /// Orthonormal axes, the held directions first.
  Mat3 frame() const {
    HeldDirections all = *this;
    for (int c = 0; c < 3; ++c) all.add(Vec3::Unit(c));
    Mat3 result;
    for (int k = 0; k < 3; ++k) result.col(k) = all.basis_[static_cast<std::size_t>(k)];
    return result;
  }

 private:
  std::vector<Vec3> basis_;
};

}  // namespace

Kinematics::Kinematics(const model::Model& model, const DofMap& map)
    : model_(&model),
      map_(&map),
      plain_(model.nodes.size(), true),
      held_(static_cast<std::size_t>(3 * map.layout.total), false),
      frame_(static_cast<std::size_t>(map.layout.total), Mat3::Identity()),
      displacement_(model.nodes.size()),
      rotation_(model.nodes.size()),
      charted_(model.nodes.size(), false),
      charted_node_(static_cast<std::size_t>(map.layout.total), -1),
      tilt_(model.nodes.size(), Vec3::Zero()),
      link_of_(model.nodes.size(), -1),
      cyclic_of_(model.nodes.size(), -1),
      arms_(model.links.size()),
      order_(model::links_in_order(model)) {
  for (std::size_t i = 0; i < model.links.size(); ++i)
    link_of_[model.links[i].follower] = static_cast<int>(i);
  for (std::size_t i = 0; i < model.cyclic_pairs.size(); ++i)
    cyclic_of_[model.cyclic_pairs[i].follower] = static_cast<int>(i);
  resolve_constraints();
  hold({}, {});
  linearise(model::State::reference(model));
}

void Kinematics::resolve_constraints() {
  ConstraintSolver solver(*model_, link_of_);
  constrained_ = std::move(solver.constrained);
  resolved_ = std::move(solver.resolved);
}

void Kinematics::hold(const std::vector<model::Support>& supports, const std::set<int>& turned) {
  std::vector<HeldDirections> directions(frame_.size());
  for (const auto& support : supports)
    for (const int node : support.nodes)
      for (int c = 0; c < 6; ++c) {
        const int block = c < 3 ? map_->displacement_block[node] : map_->rotation_block[node];
        if (support.fixed[c] && block >= 0) directions[block].add(support.axes.col(c % 3));
      }
  held_.assign(held_.size(), false);
  std::fill(frame_.begin(), frame_.end(), Mat3::Identity());
  for (std::size_t block = 0; block < directions.size(); ++block) {
    const auto& at = directions[block];
    const bool along_axes = at.along_axes();
    if (!along_axes) frame_[block] = at.frame();
    for (int c = 0; c < 3; ++c) held_[3 * block + c] = along_axes ? at.holds(c) : c < at.count();
  }
  for (const auto& link : model_->links)
    if (const int block = map_->rotation_block[link.follower]; block >= 0 && !link.rotation_free) {
      frame_[block].setIdentity();
      for (std::size_t c = link.hinge.size(); c < 3; ++c) held_[3 * block + c] = true;
    }
  for (std::size_t i = 0; i < constrained_.size(); ++i) {
    const auto& first = constrained_[i];
    const int block = map_->displacement_block[first.node];
    if (held_[3 * block + first.component] || frame_[block] != Mat3::Identity())
      throw ModelError(fmt::format(
          "{}{} is held by a support in a direction that follows from a linear constraint: write the "
          "constraint with another node first, or hold the others",
          model::prefix(model_->constraints[i].where), model::node_at(*model_, first.node)));
    held_[3 * block + first.component] = true;
  }
  for (std::size_t node = 0; node < plain_.size(); ++node) {
    const int u = map_->displacement_block[node], r = map_->rotation_block[node];
    const int n = held_rotations(static_cast<int>(node));
    charted_[node] = n == 1 || (n == 2 && turned.contains(static_cast<int>(node)));
    if (r >= 0) charted_node_[r] = charted_[node] ? static_cast<int>(node) : -1;
    plain_[node] = !charted_[node] && u >= 0 && frame_[u] == Mat3::Identity() &&
                   (r < 0 || frame_[r] == Mat3::Identity());
  }
  for (const auto& first : constrained_) plain_[first.node] = false;
  find_fixed_dependences();
}

void Kinematics::find_fixed_dependences() {
  const auto& m = *map_;
  for (std::size_t node = 0; node < displacement_.size(); ++node) {
    const auto own = [&](int block, std::vector<Dependence>& list) {
      list.clear();
      if (block >= 0) list.push_back({block, frame_[block]});
    };
    own(m.displacement_block[node], displacement_[node]);
    own(m.rotation_block[node], rotation_[node]);
  }
  for (std::size_t i = 0; i < constrained_.size(); ++i)
    for (const auto& term : resolved_[i]) {
      const int block = m.displacement_block[term.node];
      Mat3 matrix = Mat3::Zero();
      matrix.row(constrained_[i].component) = term.coefficient * frame_[block].row(term.component);
      displacement_[constrained_[i].node].push_back({block, matrix});
    }
  const auto turned = [](const Mat3& turn, std::vector<Dependence> list) {
    for (auto& dependence : list) dependence.matrix = turn * dependence.matrix;
    return list;
  };
  for (const auto& pair : model_->cyclic_pairs) {
    displacement_[pair.follower] = turned(pair.turn, displacement_[pair.leader]);
    rotation_[pair.follower] = turned(pair.turn, rotation_[pair.leader]);
  }
}

bool Kinematics::turns_by_itself(int node) const {
  const int link = link_of(node);
  return map_->rotation_block[static_cast<std::size_t>(node)] >= 0 &&
         (link < 0 || model_->links[static_cast<std::size_t>(link)].hinge.empty());
}

int Kinematics::held_rotations(int node) const {
  if (!turns_by_itself(node)) return 0;
  const auto at = 3 * static_cast<std::size_t>(map_->rotation_block[static_cast<std::size_t>(node)]);
  return held_[at] + held_[at + 1] + held_[at + 2];
}

Vec3 Kinematics::held_part(int block, const Vec3& vector) const {
  Vec3 in_axes = frame(block).transpose() * vector;
  for (int c = 0; c < 3; ++c)
    if (!held_[static_cast<std::size_t>(3 * block + c)]) in_axes[c] = 0;
  return frame(block) * in_axes;
}

Vec3 Kinematics::tilt(const model::State& state, int node) const {
  const auto at = static_cast<std::size_t>(node);
  const Vec3 whole = rotation_vector(state.rotation[at] * rotation_of(state.turn[at]).transpose());
  return whole - held_part(map_->rotation_block[at], whole);
}

void Kinematics::settle(model::State& state) const {
  constexpr double same = 1e-9;
  for (std::size_t node = 0; node < charted_.size(); ++node) {
    const int n = held_rotations(static_cast<int>(node)), block = map_->rotation_block[node];
    if (n == 0) continue;
    const Mat3& rotation = state.rotation[node];
    Vec3& turn = state.turn[node];
    if (n == 3) {
      turn = nearest_rotation_vector(rotation, turn);
      continue;
    }
    turn = held_part(block, turn);
    const Vec3 left = rotation_vector(rotation * rotation_of(turn).transpose());
    if (held_part(block, left).norm() <= same) continue;
    for (int c = 0; c < 3; ++c) {
      const bool held = held_[static_cast<std::size_t>(3 * block + c)];
      const Vec3 axis = frame(block).col(c);
      if (held && n == 1)
        turn = nearest_rotation_vector(rotation_of(twist_about(rotation, axis) * axis), turn);
      if (!held && n == 2)
        turn = held_part(block, nearest_rotation_vector(
                                    rotation_of(-twist_about(rotation, axis) * axis) * rotation, turn));
    }
  }
}

void Kinematics::find_charts(const model::State& state) {
  for (std::size_t node = 0; node < charted_.size(); ++node) {
    if (!charted_[node]) continue;
    const int block = map_->rotation_block[node];
    tilt_[node] = tilt(state, static_cast<int>(node));
    const Mat3 free = spin_of_rotation_vector(tilt_[node]),
               held = rotation_of(tilt_[node]) * spin_of_rotation_vector(state.turn[node]);
    Mat3 spin;
    for (int c = 0; c < 3; ++c)
      spin.col(c) = (held_[static_cast<std::size_t>(3 * block + c)] ? held : free) * frame(block).col(c);
    rotation_[node] = {{block, spin}};
  }
  for (const auto& pair : model_->cyclic_pairs)
    if (charted_[pair.leader]) {
      const auto& [block, spin] = rotation_[pair.leader].front();
      rotation_[pair.follower] = {{block, pair.turn * spin}};
    }
}

void Kinematics::linearise(const model::State& state) {
  const auto& m = *map_;
  find_charts(state);
  for (const int i : order_) {
    const auto& link = model_->links[i];
    auto& arm = arms_[i];
    const Mat3 turn = leader_rotation(state, link);
    arm.lever = turn * (model_->nodes[link.follower] - model_->nodes[link.leader]);
    Mat3 so_far = turn, axes = Mat3::Zero();
    for (std::size_t k = 0; k < link.hinge.size(); ++k) {
      arm.axis[k] = so_far * link.hinge[k];
      axes.col(static_cast<int>(k)) = arm.axis[k];
      so_far = so_far * rotation_of(link.hinge[k] * state.hinge_angle[i][static_cast<int>(k)]);
    }
    const auto& leader_turn = rotation_[link.leader];
    auto& displacement = displacement_[link.follower];
    displacement = displacement_[link.leader];
    for (const auto& [block, matrix] : leader_turn)
      displacement.push_back({block, -skew(arm.lever) * matrix});
    if (!m.rotational[link.follower] || link.rotation_free) continue;
    auto& rotation = rotation_[link.follower];
    rotation = leader_turn;
    if (!link.hinge.empty()) rotation.push_back({m.rotation_block[link.follower], axes});
  }
}

Mat3 Kinematics::leader_rotation(const model::State& state, const model::Link& link) const {
  return map_->rotational[link.leader] ? state.rotation[link.leader] : Mat3(Mat3::Identity());
}

model::State Kinematics::moved(const model::State& from, const std::vector<double>& increments) const {
  model::State state = from;
  const auto increment = [&](int block) -> Vec3 {
    const Eigen::Map<const Vec3> x(&increments[static_cast<std::size_t>(3 * block)]);
    return frame_[block] * x;
  };
  for (std::size_t node = 0; node < model_->nodes.size(); ++node) {
    const int u = map_->displacement_block[node], r = map_->rotation_block[node];
    if (u >= 0) state.displacement[node] += increment(u);
    if (r < 0) continue;
    if (turns_by_itself(static_cast<int>(node)))
      turn_node(state, static_cast<int>(node), increment(r));
    else
      state.hinge_angle[link_of_[node]] += increment(r);
  }
  carry_followers(state);
  return state;
}

void Kinematics::turn_node(model::State& state, int node, const Vec3& increment) const {
  const auto at = static_cast<std::size_t>(node);
  Mat3& rotation = state.rotation[at];
  Vec3& turn = state.turn[at];
  if (charted_[at]) {
    const Vec3 prescribed = held_part(map_->rotation_block[at], increment);
    const Vec3 tilt_now = tilt(state, node) + increment - prescribed;
    turn += prescribed;
    rotation = rotation_of(tilt_now) * rotation_of(turn);
    return;
  }
  rotation = rotation_of(increment) * rotation;
  if (held_rotations(node) == 3 && !increment.isZero(0))
    turn = nearest_rotation_vector(rotation, turn + increment);
}

Vec3 Kinematics::unknown_of(int block, const Vec3& value) const {
  const int node = charted_node_[static_cast<std::size_t>(block)];
  if (node < 0) return in_axes(block, value);
  return rotation_[static_cast<std::size_t>(node)].front().matrix.colPivHouseholderQr().solve(value);
}

Mat3 Kinematics::curvature(int node, const Vec3& moment) const {
  const auto at = static_cast<std::size_t>(node);
  if (!charted_[at]) return Mat3::Zero();
  const Mat3& axes = frame(map_->rotation_block[at]);
  return axes.transpose() * spin_curvature(tilt_[at], moment) * axes;
}

Mat3 Kinematics::reaction_axes(int node) const {
  const auto at = static_cast<std::size_t>(node);
  if (!charted_[at] || held_rotations(node) != 1) return Mat3::Identity();
  return rotation_of(tilt_[at] / 2);
}

Kinematics Kinematics::in_nodal_spins(const model::State& state) const {
  Kinematics result = *this;
  std::fill(result.charted_.begin(), result.charted_.end(), false);
  std::fill(result.charted_node_.begin(), result.charted_node_.end(), -1);
  result.find_fixed_dependences();
  result.linearise(state);
  return result;
}

void Kinematics::carry_followers(model::State& state) const {
  for (std::size_t i = 0; i < constrained_.size(); ++i) {
    double sum = 0;
    for (const auto& term : resolved_[i])
      sum += term.coefficient * state.displacement[term.node][term.component];
    state.displacement[constrained_[i].node][constrained_[i].component] = sum;
  }
  for (const auto& pair : model_->cyclic_pairs) {
    state.displacement[pair.follower] = pair.turn * state.displacement[pair.leader];
    state.rotation[pair.follower] = pair.turn * state.rotation[pair.leader] * pair.turn.transpose();
  }
  for (const int i : order_) {
    const auto& link = model_->links[i];
    const Mat3 turn = leader_rotation(state, link);
    const Vec3 lever = model_->nodes[link.follower] - model_->nodes[link.leader];
    state.displacement[link.follower] = state.displacement[link.leader] + turn * lever - lever;
    if (!map_->rotational[link.follower] || link.rotation_free) continue;
    Mat3 rotation = turn;
    for (std::size_t k = 0; k < link.hinge.size(); ++k)
      rotation = rotation * rotation_of(link.hinge[k] * state.hinge_angle[i][static_cast<int>(k)]);
    state.rotation[link.follower] = rotation;
  }
}

Mat<6> Kinematics::second_derivative(int index, const Vec3& force, const Vec3& moment) const {
  const auto& link = model_->links[index];
  const auto& arm = arms_[index];
  Mat<6> h = Mat<6>::Zero();
  h.topLeftCorner<3, 3>() = (arm.lever * force.transpose() + force * arm.lever.transpose()) / 2 -
                            arm.lever.dot(force) * Mat3::Identity();
  const auto n = static_cast<int>(link.hinge.size());
  for (int k = 0; k < n; ++k) {
    h.block<3, 1>(0, 3 + k) = arm.axis[k].cross(moment) / 2;
    for (int j = 0; j < k; ++j) h(3 + j, 3 + k) = moment.dot(arm.axis[j].cross(arm.axis[k])) / 2;
  }
  h.triangularView<Eigen::StrictlyLower>() = h.transpose();
  return h;
}

}  // namespace tautline::assembly
