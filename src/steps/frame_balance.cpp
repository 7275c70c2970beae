#include "steps/frame_balance.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

#include <tautline/core/anderson.hpp>
#include <tautline/core/error.hpp>
#include <tautline/model/element_data.hpp>

#include "steps/frozen_net.hpp"

namespace tautline::steps {

namespace {

constexpr std::size_t anderson_depth = 60;
/// E A of the net's cables over their tension while the frame moves, none larger than it is.
constexpr std::array<double, 5> net_yields{force_density_kept, 3, 30, 300,
                                           std::numeric_limits<double>::infinity()};
/// The same of the frame's own cables of stated tension, which may be all that keeps it from being a
/// mechanism.
constexpr double own_cables_yield = 30;
constexpr double coarsest_step = 0.1;  // of a path that may be tried again with a stiffer net
constexpr double tightness = 1e-12;    // of the frame's equilibrium, a round of many
constexpr int most_rounds = 100;       // for the shape without stress
constexpr int patience = 6;            // rounds in which the force left does not fall: it is rounding

/// The same cable between ends elsewhere.
void keep_unstressed_length(const Points& from, const Points& to, model::Cable& cable) {
  const auto [a, b] = cable.nodes;
  const double unstressed = (from[b] - from[a]).norm() / (1 + cable.initial_strain);
  cable.initial_strain = (to[b] - to[a]).norm() / unstressed - 1;
}

/// Forces on the nodes that move; the others rest.
void load(model::Model& frame, const Points& force, const std::vector<bool>& moves) {
  auto& rest = frame.supports.emplace_back();
  rest.name = "no part of the frame";
  for (std::size_t i = 0; i < force.size(); ++i) {
    if (!moves[i]) {
      rest.nodes.push_back(static_cast<int>(i));
      continue;
    }
    auto& load = frame.loads.emplace_back();
    load.nodes = {static_cast<int>(i)};
    load.force = force[i];
  }
}

/// Second Piola-Kirchhoff resultants before a motion for Cauchy resultants after it, less what the motion
/// strains the membrane by.
Vec3 prestress_before(const model::Model& structure, const model::Membrane& membrane, const Mat3& before,
                      const Mat3& after) {
  const Mat<3, 2> axes = element::membrane_frame<3>(before).leftCols<2>();
  const Mat<3, 2> moved_axes = element::membrane_frame<3>(after).leftCols<2>();
  const auto sides = [](const Mat<3, 2>& frame, const Mat3& x) -> Mat<2> {
    Mat<3, 2> s;
    s << x.col(1) - x.col(0), x.col(2) - x.col(0);
    return frame.transpose() * s;
  };
  const Mat<2> F = sides(moved_axes, after) * sides(axes, before).inverse();
  Mat<2> cauchy;
  cauchy << membrane.prestress[0], membrane.prestress[2], membrane.prestress[2], membrane.prestress[1];
  const Mat<2> back = F.inverse();
  const Mat<2> S = F.determinant() * back * cauchy * back.transpose();
  const Mat<2> E = 0.5 * (F.transpose() * F - Mat<2>::Identity());
  const Mat3 stiffness = model::membrane_law<3>(structure, membrane).stiffness;
  return Vec3(S(0, 0), S(1, 1), S(0, 1)) - stiffness * Vec3(E(0, 0), E(1, 1), 2 * E(0, 1));
}

Mat3 rotation_matrix(const Vec3& vector) {
  const double angle = vector.norm();
  if (angle == 0) return Mat3::Identity();
  return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

Mat3 corners_of(const Points& x, const model::FacetNodes& n) {
  Mat3 corners;
  corners << x[n[0]], x[n[1]], x[n[2]];
  return corners;
}

}  // namespace

Frame::Frame(const Context& context, const FormNet& net, const std::vector<std::string>& found,
             bool precambered, std::vector<bool> keeps_length)
    : drawn_(context.structure.nodes),
      reference_(drawn_),
      precambered_(precambered),
      keeps_length_(std::move(keeps_length)),
      found_(context.structure.groups.size(), false),
      free_(context.structure.nodes.size(), false),
      of_frame_(context.structure.nodes.size(), false) {
  const auto& structure = context.structure;
  for (const auto& name : found) found_[static_cast<std::size_t>(structure.find_group(name))] = true;
  pulls_ = found_;
  for (std::size_t i = 0; i < pulls_.size(); ++i) {
    const auto& group = structure.groups[i];
    const auto& states = context.deck.groups.at(group.name);
    if (group.kind == model::ElementKind::cable && (states.tension || states.force_density)) pulls_[i] = true;
  }
  for (std::size_t i = 0; i < net.nodes.size(); ++i) {
    free_[net.nodes[i]] = !net.net.fixed[i];
    if (net.surface != nullptr && !net.net.fixed[i] && (net.net.on_surface.empty() || net.net.on_surface[i]))
      on_surface_.push_back(net.nodes[i]);
  }
  model::for_each_kind(structure, [&](const auto& elements) {
    for (const auto& element : elements) {
      if (!is_frame(element)) continue;
      for (const int node : element.nodes) of_frame_[static_cast<std::size_t>(node)] = true;
    }
  });
  for (const auto& link : structure.links)
    of_frame_[static_cast<std::size_t>(link.leader)] = of_frame_[static_cast<std::size_t>(link.follower)] =
        true;
  motion_.displacement.assign(reference_.size(), Vec3::Zero());
  motion_.rotation.assign(reference_.size(), Mat3::Identity());
}

model::Model Frame::bare_frame(const model::Model& structure, const std::vector<bool>& left_out) const {
  model::Model frame = structure;
  frame.nodes = reference_;
  frame.initial = motion_;
  orient(frame);
  model::for_each_kind(frame, [&](auto& elements) {
    std::erase_if(elements, [&](const auto& element) {
      return !is_frame(element) || left_out[static_cast<std::size_t>(element.group)];
    });
  });
  for (auto& cable : frame.cables) keep_unstressed_length(structure.nodes, reference_, cable);
  frame.selections.clear();
  frame.loads.clear();
  return frame;
}

model::Model Frame::loaded_frame(const model::Model& structure) const {
  model::Model frame = bare_frame(structure, found_);
  load(frame, net_pull(structure, found_), of_frame_);
  return frame;
}

std::vector<double> Frame::yielding(const model::Model& structure) const {
  std::vector<double> yielding(structure.cables.size());
  for (std::size_t i = 0; i < yielding.size(); ++i) {
    const double net = net_yields[stiffening_];
    yielding[i] = keeps_length_[i]                      ? net_yields.back()
                  : is_found(structure.cables[i].group) ? net
                                                        : std::max(net, own_cables_yield);
  }
  return yielding;
}

model::Model Frame::frame_with_net(const model::Model& structure) const {
  model::Model frame = bare_frame(structure, pulls_);
  for (std::size_t i = 0; i < reference_.size(); ++i)
    if (!of_frame_[i]) frame.nodes[i] = structure.nodes[i];
  const FrozenNet frozen = freeze(structure, pulls_, yielding(structure));
  std::vector<bool> moves = of_frame_;
  for (auto cable : frozen.cables) {
    keep_unstressed_length(structure.nodes, frame.nodes, cable);
    frame.cables.push_back(cable);
    for (const int node : cable.nodes) moves[static_cast<std::size_t>(node)] = true;
  }
  frame.groups.push_back(frozen.group);
  Points force = net_pull(structure, pulls_);
  for (std::size_t i = 0; i < force.size(); ++i)
    force[i] = (of_frame_[i] ? force[i] : Vec3(Vec3::Zero())) - frozen.pull[i];
  load(frame, force, moves);
  auto& surface = frame.supports.emplace_back();
  surface.name = "surface of the net";
  surface.fixed = {false, false, true, false, false, false};
  for (const int node : on_surface_)
    if (moves[static_cast<std::size_t>(node)]) surface.nodes.push_back(node);
  return frame;
}

bool Frame::stiffen_net() {
  if (precambered_ || stiffening_ + 1 == net_yields.size()) return false;
  ++stiffening_;
  return true;
}

double Frame::rest(const Context& context, const model::Model& structure) {
  return precambered_ ? find_precamber(structure) : yield(context, structure);
}

std::string Frame::moved_most(const assembly::System& system) const {
  const auto& state = system.state();
  std::size_t most = 0;
  double largest = 0;
  for (std::size_t i = 0; i < reference_.size(); ++i)
    if (const double way = (state.displacement[i] - motion_.displacement[i]).norm();
        of_frame_[i] && way > largest) {
      largest = way;
      most = i;
    }
  if (!(largest > 0)) return {};
  std::string group;
  model::for_each_kind(system.model(), [&](const auto& elements) {
    for (const auto& element : elements)
      for (const int node : element.nodes)
        if (node == static_cast<int>(most))
          group = system.model().groups[static_cast<std::size_t>(element.group)].name;
  });
  const Vec3 from = reference_[most] + motion_.displacement[most],
             to = reference_[most] + state.displacement[most];
  return fmt::format(
      ", where a node of \"{}\" has moved most, from ({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g})",
      group, from.x(), from.y(), from.z(), to.x(), to.y(), to.z());
}

double Frame::yield(const Context& context, const model::Model& structure) {
  assembly::System system(frame_with_net(structure));
  analysis::Workspace workspace{system.new_matrix(), {}};
  system.begin_stage({system.model().supports, system.model().loads});
  auto solver = context.deck.solver;
  solver.force_tolerance = std::min(solver.force_tolerance, tightness);
  if (stiffening_ + 1 < net_yields.size()) solver.min_step = std::max(solver.min_step, coarsest_step);
  const auto path = analysis::follow_path(system, workspace, solver);
  if (!path.reached)
    throw ModelError(fmt::format(
        "form-finding: the frame made as drawn finds no equilibrium under the net: it bears {:.3g} "
        "of the net's pull{}: {}. Make it stiffer, or let it be as drawn under the net (frame: "
        "precambered)",
        path.lambda(), moved_most(system), path.reason));
  const auto& state = system.state();
  double change = 0;
  for (std::size_t i = 0; i < reference_.size(); ++i) {
    if (!of_frame_[i]) continue;
    change = std::max(change, (state.displacement[i] - motion_.displacement[i]).norm());
    motion_.displacement[i] = state.displacement[i];
    motion_.rotation[i] = state.rotation[i];
  }
  return change;
}

void Frame::set_motion(const VecX& motion) {
  for (std::size_t i = 0; i < reference_.size(); ++i) {
    const auto at = motion.segment<6>(6 * static_cast<Eigen::Index>(i));
    motion_.displacement[i] = at.head<3>();
    motion_.rotation[i] = rotation_matrix(at.tail<3>());
    reference_[i] = drawn_[i] - motion_.displacement[i];
  }
}

double Frame::find_precamber(const model::Model& structure) {
  assembly::System stiff(loaded_frame(structure));
  analysis::Workspace workspace{stiff.new_matrix(), {}};
  stiff.begin_stage({stiff.model().supports, {}});
  stiff.tangent(workspace.tangent);
  if (!workspace.solver.factor(workspace.tangent))
    throw ModelError("form-finding: the frame without the net is a mechanism: " + workspace.solver.failure());
  la::Vector at_rest(stiff.layout()), force(stiff.layout()), step(stiff.layout());
  at_rest.set_zero();
  Anderson acceleration(anderson_depth);
  VecX motion = VecX::Zero(6 * static_cast<Eigen::Index>(reference_.size()));
  VecX best = motion;
  double change = 0, least = std::numeric_limits<double>::infinity();
  int since = 0;  // rounds since the least force
  for (int round = 0; round < most_rounds; ++round) {
    assembly::System loaded(loaded_frame(structure));
    loaded.begin_stage({loaded.model().supports, loaded.model().loads});
    loaded.set_lambda(1);
    loaded.residual(at_rest, force);
    if (const double left = force.norm(); left < least) {
      least = left;
      best = motion;
      since = 0;
    } else if (++since > patience && change < 1e-9 * stiff.size()) {
      set_motion(best);
      return 0;
    }
    workspace.solver.solve(force, step);
    const auto way = stiff.nodal(step);
    VecX next = motion;
    for (std::size_t i = 0; i < reference_.size(); ++i) {
      const auto at = 6 * static_cast<Eigen::Index>(i);
      next.segment<3>(at) -= way.displacement[i];
      next.segment<3>(at + 3) -= way.rotation[i];
    }
    change = (next - motion).cwiseAbs().maxCoeff();
    motion = acceleration.next(motion, next);
    set_motion(motion);
    if (change == 0) return 0;
  }
  throw ModelError(
      fmt::format("form-finding: the shape of the frame without stress still moves by {:.3g} m after "
                  "{} rounds: the frame is too slender for the net's pull",
                  change, most_rounds));
}

Points Frame::positions() const {
  if (precambered_) return drawn_;
  Points at = reference_;
  for (std::size_t i = 0; i < at.size(); ++i) at[i] += motion_.displacement[i];
  return at;
}

double Frame::largest_displacement() const {
  double largest = 0;
  for (const Vec3& u : motion_.displacement) largest = std::max(largest, u.norm());
  return largest;
}

/// Local axes and normals of the stress-free shape.
void Frame::orient(model::Model& structure) const {
  if (!precambered_) return;
  for (auto& beam : structure.beams)
    beam.frame = element::beam_frame(model::reference_nodes<2>(structure, beam.nodes),
                                     structure.groups[static_cast<std::size_t>(beam.group)].orientation);
  model::find_directors(structure);
}

void Frame::unload(model::Model& structure) const {
  const Points moved = structure.nodes;
  Points before = moved;
  for (std::size_t i = 0; i < before.size(); ++i)
    if (of_frame_[i]) before[i] = reference_[i];
  structure.initial = motion_;
  for (std::size_t i = 0; i < before.size(); ++i)
    if (!of_frame_[i]) structure.initial.displacement[i].setZero();
  structure.nodes = before;
  orient(structure);
  for (auto& cable : structure.cables) keep_unstressed_length(moved, before, cable);
  for (auto& membrane : structure.membranes)
    if (is_found(membrane.group))
      membrane.prestress = prestress_before(structure, membrane, corners_of(before, membrane.nodes),
                                            corners_of(moved, membrane.nodes));
}

}  // namespace tautline::steps
