#include "assembly/inertia_relief.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <fmt/format.h>

#include <tautline/assembly/bodies.hpp>
#include <tautline/core/error.hpp>
#include <tautline/core/rotation.hpp>
#include <tautline/la/session.hpp>

#include "assembly/contribution.hpp"

namespace tautline::assembly {

namespace {

/// Motion of a node for the six unit accelerations of its body: displacement, then rotation.
Mat<6> unit_fields(const Vec3& arm) {
  Mat<6> fields = Mat<6>::Identity();
  fields.topRightCorner<3, 3>() = -skew(arm);
  return fields;
}

/// Adds what the mass of one element makes of the six unit accelerations about `pole`.
template <class Element>
void add_inertia_of(const model::Model& model, const model::State& state, const Element& element,
                    const Vec3& pole, std::vector<Mat<6>>& to) {
  const ElementMatrix mass = mass_of(model, state, element, MassKind::consistent);
  const auto n = static_cast<Eigen::Index>(element.nodes.size()), stride = mass.rows() / n;
  MatX fields(mass.rows(), 6);
  Eigen::Index row = 0;
  for (const int node : element.nodes) {
    const Vec3 arm = model.nodes[node] + state.displacement[node] - pole;
    fields.middleRows(row, stride) = unit_fields(arm).topRows(stride);
    row += stride;
  }
  const MatX product = mass * fields;
  row = 0;
  for (const int node : element.nodes) {
    to[static_cast<std::size_t>(node)].topRows(stride) += product.middleRows(row, stride);
    row += stride;
  }
}

std::string place_text(const Vec3& at) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", at.x(), at.y(), at.z());
}

void refuse_ties(const model::Model& model) {
  const auto refuse = [](const std::string& what) { throw ModelError("support: free: " + what); };
  if (!model.constraints.empty())
    refuse("linear constraints tie displacements to fixed directions, which a free structure does not have");
  if (!model.cyclic_pairs.empty())
    refuse("one sector of a cyclic structure has no free motion of its own: describe the whole structure");
  for (const auto& support : model.supports)
    if (support.symmetry)
      refuse(
          fmt::format("support \"{}\" is a plane of symmetry: describe the whole structure", support.name));
  for (const auto& spring : model.springs)
    if (spring.grounded())
      refuse(fmt::format("the springs of group \"{}\" hold the structure: leave them out",
                         model.groups[static_cast<std::size_t>(spring.group)].name));
  for (const auto& cable : model.cables)
    if (const auto& group = model.groups[static_cast<std::size_t>(cable.group)];
        group.kind == model::ElementKind::catenary)
      refuse(fmt::format("catenaries (group \"{}\") sag under weight, not under inertia: use cables",
                         group.name));
}

}  // namespace

void refuse_motions(const std::vector<model::Load>& loads) {
  for (const auto& load : loads)
    if (load.moves())
      throw ModelError(fmt::format("load \"{}\" moves a support, and support: free has none", load.name));
}

InertiaRelief::InertiaRelief(const model::Model& model, const DofMap& map, const model::State& state)
    : model_(model),
      map_(map),
      weight_(model.nodes.size(), 0.0),
      body_of_(model.nodes.size(), 0),
      force_(model.nodes.size(), Vec<6>::Zero()) {
  refuse_ties(model);
  const auto reference = model::State::reference(model);
  inertia_.assign(model.nodes.size(), Mat<6>::Zero());
  model::for_each_kind(model, [&](const auto& elements) {
    for (const auto& element : elements) add_inertia_of(model, reference, element, Vec3::Zero(), inertia_);
  });
  for (std::size_t node = 0; node < weight_.size(); ++node) weight_[node] = inertia_[node](0, 0);
  for (auto& nodes : bodies_of(model)) {
    Body body;
    body.nodes = std::move(nodes);
    for (const int node : body.nodes) body.mass += weight_[static_cast<std::size_t>(node)];
    if (!(body.mass > 0))
      throw ModelError(fmt::format(
          "support: free: the body of {} node{} at {} has no mass that loads could accelerate: give its "
          "materials a `density`, its sections a mass, or add point masses",
          body.nodes.size(), body.nodes.size() == 1 ? "" : "s", place_text(model.nodes[body.nodes[0]])));
    body.centre = centre_of(body, reference);
    find_shape(body);
    for (const int node : body.nodes)
      body_of_[static_cast<std::size_t>(node)] = static_cast<int>(bodies_.size());
    bodies_.push_back(std::move(body));
  }
  take_masses(state);
}

void InertiaRelief::find_shape(Body& body) const {
  constexpr double flat = 1e-12;  // of squares
  Mat3 places = Mat3::Zero(), masses = Mat3::Zero();
  for (const int node : body.nodes) {
    const Vec3 arm = model_.nodes[node] - body.centre;
    places += arm * arm.transpose();
    masses += weight_[static_cast<std::size_t>(node)] * arm * arm.transpose();
  }
  const Eigen::JacobiSVD<Mat3> by_place(places, Eigen::ComputeFullU), by_mass(masses);
  const Vec3 &extent = by_place.singularValues(), &spread = by_mass.singularValues();
  if (extent[0] > 0) body.size = std::sqrt(extent[0] / static_cast<double>(body.nodes.size()));
  const bool straight = extent[1] <= flat * extent[0];
  if (straight && extent[0] > 0) body.line = by_place.matrixU().col(0);
  const int needed = straight ? 0 : 1;
  body.by_mass = spread[needed] > flat * body.mass * extent[0];
}

double InertiaRelief::weight_of(const Body& body, int node) const {
  return body.by_mass ? weight_[static_cast<std::size_t>(node)] : 1;
}

Vec3 InertiaRelief::centre_of(const Body& body, const model::State& state) const {
  Vec3 sum = Vec3::Zero();
  const Vec3 base = model_.nodes[body.nodes[0]];
  for (const int node : body.nodes) {
    const auto at = static_cast<std::size_t>(node);
    sum += weight_[at] * (model_.nodes[at] + state.displacement[at] - base);
  }
  return base + sum / body.mass;
}

void InertiaRelief::take_masses(const model::State& state) {
  pole_.clear();
  for (const Body& body : bodies_) pole_.push_back(centre_of(body, state));
  std::fill(inertia_.begin(), inertia_.end(), Mat<6>::Zero());
  model::for_each_kind(model_, [&](const auto& elements) {
    for (const auto& element : elements)
      add_inertia_of(model_, state, element,
                     pole_[static_cast<std::size_t>(body_of_[static_cast<std::size_t>(element.nodes[0])])],
                     inertia_);
  });
}

void InertiaRelief::balance(const Kinematics& kinematics, const model::State& state,
                            const std::vector<double>& residual) {
  std::vector<double> resultants(6 * bodies_.size(), 0.0);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Eigen::Map<Vec<6>> sum(&resultants[6 * i]);
    for (const int node : bodies_[i].nodes) {
      const auto at = static_cast<std::size_t>(node);
      const Mat<6> fields = unit_fields(model_.nodes[at] + state.displacement[at] - pole_[i]);
      const int link = kinematics.link_of(node);
      const bool hinge = link >= 0 && !model_.links[static_cast<std::size_t>(link)].hinge.empty();
      const auto add = [&](int block, const Mat<3, 6>& motion) {
        if (block < 0 || !map_.owns(block)) return;
        const Eigen::Map<const Vec3> force(&residual[static_cast<std::size_t>(3 * block)]);
        for (int k = 0; k < 6; ++k) sum[k] += force.dot(kinematics.unknown_of(block, motion.col(k)));
      };
      add(map_.displacement_block[at], fields.topRows<3>());
      if (!hinge) add(map_.rotation_block[at], fields.bottomRows<3>());
    }
  }
  la::sum_over_ranks(resultants);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Body& body = bodies_[i];
    Mat<6> mass = Mat<6>::Zero();
    for (const int node : body.nodes) {
      const auto at = static_cast<std::size_t>(node);
      mass += unit_fields(model_.nodes[at] + state.displacement[at] - pole_[i]).transpose() * inertia_[at];
    }
    Vec<6> scale;
    scale << Vec3::Constant(1), Vec3::Constant(1 / body.size);
    Eigen::CompleteOrthogonalDecomposition<Mat<6>> solver;
    solver.setThreshold(1e-10);  // turning a line of hinged bars about itself takes no force
    solver.compute(scale.asDiagonal() * mass * scale.asDiagonal());
    const Vec<6> right = scale.asDiagonal() * Eigen::Map<const Vec<6>>(&resultants[6 * i]);
    body.acceleration = -(scale.asDiagonal() * solver.solve(right));
    for (const int node : body.nodes)
      force_[static_cast<std::size_t>(node)] =
          -(inertia_[static_cast<std::size_t>(node)] * body.acceleration);
  }
}

Vec3 InertiaRelief::line_load(const model::Beam& beam, const model::State& state) const {
  const auto body = static_cast<std::size_t>(body_of_[static_cast<std::size_t>(beam.nodes[0])]);
  Vec3 middle = Vec3::Zero();
  for (const int node : beam.nodes) middle += (model_.nodes[node] + state.displacement[node]) / 2;
  const Vec<6>& a = bodies_[body].acceleration;
  return -model_.groups[static_cast<std::size_t>(beam.group)].beam.mass_per_length *
         (a.head<3>() + a.tail<3>().cross(middle - pole_[body]));
}

void InertiaRelief::clear() {
  std::fill(force_.begin(), force_.end(), Vec<6>::Zero());
  for (Body& body : bodies_) body.acceleration.setZero();
}

/// The rotation that fits the motion of the nodes best, weighed by mass; about the axis of a straight body
/// that which fits their rotations.
Mat3 InertiaRelief::mean_rotation(const Body& body, const model::State& state, const Vec3& centre) const {
  Mat3 moments = Mat3::Zero();
  for (const int node : body.nodes) {
    const auto at = static_cast<std::size_t>(node);
    moments += weight_of(body, node) * (model_.nodes[at] + state.displacement[at] - centre) *
               (model_.nodes[at] - body.centre).transpose();
  }
  if (body.straight()) {
    const Mat3 swing = Eigen::Quaterniond::FromTwoVectors(body.line, moments * body.line).toRotationMatrix();
    Mat3 turns = Mat3::Zero();
    for (const int node : body.nodes)
      if (map_.rotational[static_cast<std::size_t>(node)])
        turns += weight_of(body, node) * swing.transpose() * state.rotation[static_cast<std::size_t>(node)];
    const Vec3 axial(turns(2, 1) - turns(1, 2), turns(0, 2) - turns(2, 0), turns(1, 0) - turns(0, 1));
    const double sine = body.line.dot(axial), cosine = turns.trace() - body.line.dot(turns * body.line);
    return swing * rotation_of(std::atan2(sine, cosine) * body.line);
  }
  const Eigen::JacobiSVD<Mat3> svd(moments, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vec3 signs(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1);
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

model::State InertiaRelief::centred(model::State state) const {
  constexpr double in_place = 1e-12;  // rounding of the mean must not shake what is at rest
  for (const Body& body : bodies_) {
    const Vec3 centre = centre_of(body, state);
    const Mat3 back = mean_rotation(body, state, centre).transpose();
    if (rotation_vector(back).norm() <= in_place && (centre - body.centre).norm() <= in_place * body.size)
      continue;
    for (const int node : body.nodes) {
      const auto at = static_cast<std::size_t>(node);
      const Vec3 arm = model_.nodes[at] + state.displacement[at] - centre;
      // (back - 1) arm and not back arm - arm: small displacements keep their digits
      state.displacement[at] += (back - Mat3::Identity()) * arm - (centre - body.centre);
      if (map_.rotational[at]) state.rotation[at] = back * state.rotation[at];
    }
  }
  return state;
}

std::vector<BodyAcceleration> InertiaRelief::accelerations(const model::State& state) const {
  std::vector<BodyAcceleration> result;
  for (const Body& body : bodies_)
    result.push_back({body.acceleration.head<3>(), body.acceleration.tail<3>(), centre_of(body, state),
                      body.mass, static_cast<int>(body.nodes.size()), body.nodes[0]});
  return result;
}

model::Support InertiaRelief::hold(const std::string& name, int node, const Mat3& axes,
                                   const Vec<6>& fixed) const {
  model::Support support;
  support.name = name;
  support.nodes = {node};
  support.axes = axes;
  for (int c = 0; c < 6; ++c) support.fixed[static_cast<std::size_t>(c)] = fixed[c] != 0;
  return support;
}

/// Three nodes far from each other, those of beams and shells first: one held, one across the line between
/// them, one across their plane. All on one line: a node with its rotation, if there are any.
void InertiaRelief::add_holds(const Body& body, const Points& positions,
                              std::vector<model::Support>& supports) const {
  constexpr double flat = 1e-3;
  const auto farthest = [&](const std::vector<int>& nodes, const auto& distance) {
    return *std::max_element(nodes.begin(), nodes.end(),
                             [&](int a, int b) { return distance(a) < (1 - 1e-9) * distance(b); });
  };
  std::vector<int> own, stiff;
  for (const int node : body.nodes) {
    const auto at = static_cast<std::size_t>(node);
    if (map_.displacement_block[at] < 0) continue;
    own.push_back(node);
    if (map_.rotational[at]) stiff.push_back(node);
  }
  const std::string name = "free";
  for (const auto* nodes : {&stiff, &own}) {
    if (nodes->size() < 2) continue;
    const Vec3 middle = positions[nodes->front()];
    const int a = farthest(*nodes, [&](int n) { return (positions[n] - middle).norm(); });
    const int b = farthest(*nodes, [&](int n) { return (positions[n] - positions[a]).norm(); });
    const Vec3 line = (positions[b] - positions[a]).normalized();
    const auto off_line = [&](int n) { return line.cross(positions[n] - positions[a]).norm(); };
    const int c = farthest(*nodes, off_line);
    const bool on_line = off_line(c) < flat * (positions[b] - positions[a]).norm();
    if (on_line && nodes == &stiff) break;
    const Vec3 across = on_line ? line.unitOrthogonal() : Vec3(line.cross(positions[c] - positions[a]));
    Mat3 axes;
    axes << line, across.normalized().cross(line), across.normalized();
    supports.push_back(hold(name, a, axes, Vec<6>(1, 1, 1, 0, 0, 0)));
    supports.push_back(hold(name, b, axes, Vec<6>(0, 1, 1, 0, 0, 0)));
    if (!on_line) supports.push_back(hold(name, c, axes, Vec<6>(0, 0, 1, 0, 0, 0)));
    return;
  }
  if (own.empty()) return;
  const int node = stiff.empty() ? own[own.size() / 2] : stiff[stiff.size() / 2];
  supports.push_back(hold(name, node, Mat3::Identity(), Vec<6>::Ones()));
}

std::vector<model::Support> InertiaRelief::holds(const model::State& state) const {
  const auto positions = model::positions(model_, state);
  std::vector<model::Support> supports;
  for (const Body& body : bodies_) add_holds(body, positions, supports);
  return supports;
}

}  // namespace tautline::assembly
