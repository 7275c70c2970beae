#include "steps/frame_balance.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

#include <tautline/core/anderson.hpp>
#include <tautline/core/error.hpp>
#include <tautline/model/element_data.hpp>

namespace tautline::steps {

namespace {

constexpr std::size_t anderson_depth = 8;
constexpr int most_rounds = 100;  // for the shape without stress
constexpr int patience = 6;       // rounds in which the force left does not fall: it is rounding

/// The same cable between ends elsewhere.
void keep_unstressed_length(const Points& from, const Points& to, model::Cable& cable) {
  const auto [a, b] = cable.nodes;
  const double unstressed = (from[b] - from[a]).norm() / (1 + cable.initial_strain);
  cable.initial_strain = (to[b] - to[a]).norm() / unstressed - 1;
}

/// What a triangle with Cauchy resultants N in its frame pulls its corners with.
std::array<Vec3, 3> corner_forces(const Points& x, const std::array<int, 3>& nodes, const Vec3& resultants) {
  const Vec3 a = x[nodes[0]], b = x[nodes[1]], c = x[nodes[2]];
  Mat3 corners;
  corners << a, b, c;
  const Mat<3, 2> axes = element::membrane_frame<3>(corners).leftCols<2>();
  const Vec3 normal = (b - a).cross(c - a).normalized();
  Mat<2> stress;
  stress << resultants[0], resultants[2], resultants[2], resultants[1];
  const Mat3 in_space = axes * stress * axes.transpose();
  // Half of what crosses the opposite side, whose outward normal in the plane is side x normal.
  std::array<Vec3, 3> force;
  for (int k = 0; k < 3; ++k) {
    const Vec3 side = corners.col((k + 2) % 3) - corners.col((k + 1) % 3);
    force[static_cast<std::size_t>(k)] = 0.5 * in_space * side.cross(normal);
  }
  return force;
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
             bool precambered)
    : drawn_(context.structure.nodes),
      reference_(drawn_),
      precambered_(precambered),
      found_(context.structure.groups.size(), false),
      free_(context.structure.nodes.size(), false),
      of_frame_(context.structure.nodes.size(), false) {
  const auto& structure = context.structure;
  for (const auto& name : found) found_[static_cast<std::size_t>(structure.find_group(name))] = true;
  for (std::size_t i = 0; i < net.nodes.size(); ++i) free_[net.nodes[i]] = !net.net.fixed[i];
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

Points Frame::pull(const model::Model& structure) const {
  Points force(structure.nodes.size(), Vec3::Zero());
  for (const auto& cable : structure.cables) {
    if (!is_found(cable.group)) continue;
    const auto [a, b] = cable.nodes;
    const double tension = structure.axial_stiffness(cable) * cable.initial_strain;
    const Vec3 along = tension * (structure.nodes[b] - structure.nodes[a]).normalized();
    force[a] += along;
    force[b] -= along;
  }
  for (const auto& membrane : structure.membranes) {
    if (!is_found(membrane.group)) continue;
    if (membrane.nodes.size() != 3)
      throw ModelError("form-finding: cloth on an elastic frame must be of triangles");
    const std::array<int, 3> nodes{membrane.nodes[0], membrane.nodes[1], membrane.nodes[2]};
    const auto forces = corner_forces(structure.nodes, nodes, membrane.prestress);
    for (std::size_t k = 0; k < 3; ++k) force[nodes[k]] += forces[k];
  }
  return force;
}

model::Model Frame::loaded_frame(const model::Model& structure) const {
  model::Model frame = structure;
  frame.nodes = reference_;
  frame.initial = motion_;
  orient(frame);
  model::for_each_kind(frame, [&](auto& elements) {
    std::erase_if(elements, [&](const auto& element) { return !is_frame(element); });
  });
  for (auto& cable : frame.cables) keep_unstressed_length(structure.nodes, reference_, cable);
  frame.selections.clear();
  frame.loads.clear();
  const Points force = pull(structure);
  auto& rest = frame.supports.emplace_back();
  rest.name = "no part of the frame";
  for (std::size_t i = 0; i < force.size(); ++i) {
    if (!of_frame_[i]) {
      rest.nodes.push_back(static_cast<int>(i));
      continue;
    }
    auto& load = frame.loads.emplace_back();
    load.nodes = {static_cast<int>(i)};
    load.force = force[i];
  }
  return frame;
}

double Frame::rest(const Context& context, const model::Model& structure) {
  return precambered_ ? find_precamber(structure) : yield(context, structure);
}

std::string Frame::moved_most(const assembly::System& system) const {
  const auto& state = system.state();
  std::size_t most = 0;
  double largest = 0;
  for (std::size_t i = 0; i < reference_.size(); ++i)
    if (const double way = (state.displacement[i] - motion_.displacement[i]).norm(); way > largest) {
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
  assembly::System system(loaded_frame(structure));
  analysis::Workspace workspace{system.new_matrix(), {}};
  system.begin_stage({system.model().supports, system.model().loads});
  const auto path = analysis::follow_path(system, workspace, context.deck.solver);
  if (!path.reached)
    throw ModelError(fmt::format(
        "form-finding: the frame made as drawn finds no equilibrium under the net: it bears {:.3g} "
        "of the net's pull{}: {}. Make it stiffer, or let it be as drawn under the net (frame: "
        "precambered)",
        path.lambda(), moved_most(system), path.reason));
  const auto& state = system.state();
  double change = 0;
  for (std::size_t i = 0; i < reference_.size(); ++i)
    change = std::max(change, (state.displacement[i] - motion_.displacement[i]).norm());
  motion_ = {state.displacement, state.rotation};
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
