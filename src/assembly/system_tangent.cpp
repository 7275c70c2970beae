// Tangents: in the present state, and with stresses of a linear response.
#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include <tautline/assembly/system.hpp>
#include <tautline/core/stopwatch.hpp>
#include <tautline/la/session.hpp>

#include "assembly/contribution.hpp"
#include "assembly/expansion.hpp"
#include "assembly/link_terms.hpp"
#include "assembly/own_elements.hpp"
#include "assembly/rotation.hpp"

namespace tautline::assembly {

using element::Want;

namespace {

/// A small motion of a body: displacement and rotation vector.
struct Motion {
  Vec3 displacement = Vec3::Zero(), rotation = Vec3::Zero();
};

/// Motions of an element's nodes without the rigid motion that fits them best. One node alone keeps its own.
/// Rotations of nodes settle only what their places leave open: the twist of a line.
template <class Nodes>
std::vector<Motion> deformation(const Points& places, const System::NodalField& field, const Nodes& nodes,
                                bool rotations, double& size) {
  constexpr double open = 1e-8;
  std::vector<Motion> motions;
  Vec3 centre = Vec3::Zero();
  Motion mean;
  for (const int node : nodes) {
    motions.push_back({field.displacement[node], rotations ? field.rotation[node] : Vec3(Vec3::Zero())});
    centre += places[node];
    mean.displacement += motions.back().displacement;
    mean.rotation += motions.back().rotation;
  }
  const auto n = static_cast<double>(motions.size());
  size = 0;
  if (motions.size() < 2) return motions;
  centre /= n;
  mean.displacement /= n;
  mean.rotation /= n;
  Mat3 inertia = Mat3::Zero();
  Vec3 turn = Vec3::Zero();
  std::size_t i = 0;
  for (const int node : nodes) {
    const Vec3 arm = places[node] - centre;
    inertia += arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose();
    turn += arm.cross(motions[i++].displacement - mean.displacement);
  }
  size = std::sqrt(inertia.trace());
  Vec3 rigid = mean.rotation;
  if (size > 0) {
    const double weak = open * size * size;
    rigid = (inertia + weak * Mat3::Identity()).inverse() * (turn + weak * mean.rotation);
  }
  i = 0;
  for (const int node : nodes) {
    motions[i].displacement -= mean.displacement + rigid.cross(places[node] - centre);
    if (rotations) motions[i].rotation -= rigid;
    ++i;
  }
  return motions;
}

}  // namespace

template <class StateOf, class Visit>
void System::for_each_stiffness(const StateOf& state_of, const Visit& visit) const {
  for_each_own([&](const auto& element) {
    auto c = contribution(model_, state_of(element), element, Want::tangent);
    visit(element.nodes, uses_rotations(model_, element), c.force, c.tangent);
  });
  for_each_pressed([&](const model::FacetNodes& nodes, double pressure) {
    auto c = pressure_contribution(model_, state_, nodes, pressure, Want::tangent);
    c.force = -c.force;
    c.tangent = -c.tangent;
    visit(nodes, false, c.force, c.tangent);
  });
  for (const auto& link : model_.links) {  // dead loads at the end of an arm
    const auto& [force, moment] = std::pair(now_.force[link.follower], now_.moment[link.follower]);
    if (force.isZero(0) && moment.isZero(0)) continue;
    const bool turns = map_.rotational[link.follower];
    Vec<6> load;
    load << -force, -moment;
    ElementMatrix none = ElementMatrix::Zero(turns ? 6 : 3, turns ? 6 : 3);
    visit(std::array<int, 1>{link.follower}, turns, load, none);
  }
}

template <class StateOf>
void System::assemble_tangent(la::SymmetricMatrix& k, const StateOf& state_of) {
  const Stopwatch watch(assembly_seconds_);
  kinematics_.linearise(state_);
  k.set_zero();
  for_each_stiffness(state_of, [&](const auto& nodes, bool rotations, const auto& force, auto& values) {
    const Expansion expansion(kinematics_, map_, nodes, rotations);
    if (expansion.plain()) return add_free(expansion.blocks(), values, held(), k);
    const MatX& b = expansion.matrix();
    MatX transformed = b.transpose() * values * b;
    LinkTerms(kinematics_, map_, model_, expansion, transformed).add(nodes, rotations, force);
    add_free(expansion.blocks(), transformed, held(), k);
  });
  for (int block = map_.layout.first; block < map_.layout.first + map_.layout.local; ++block) {
    Mat3 identity = Mat3::Zero();
    for (int c = 0; c < 3; ++c)
      if (held()[static_cast<std::size_t>(3 * block + c)]) identity(c, c) = support_stiffness_;
    k.add(std::array<int, 1>{block}, identity.data());
  }
  k.finish();
}

void System::tangent(la::SymmetricMatrix& k) {
  assemble_tangent(k, [&](const auto&) -> const model::State& { return state_; });
}

std::vector<double> System::stiffness_times(const std::vector<double>& increment) {
  kinematics_.linearise(state_);
  std::vector<double> product(origin_.size(), 0.0);
  const auto here = [&](const auto&) -> const model::State& { return state_; };
  for_each_stiffness(here, [&](const auto& nodes, bool rotations, const auto& force, const auto& values) {
    const Expansion expansion(kinematics_, map_, nodes, rotations);
    if (expansion.plain())
      return expansion.add((values * expansion.template rows_of<VecX>(increment)).eval(), product);
    const MatX& b = expansion.matrix();
    MatX transformed = b.transpose() * values * b;
    LinkTerms(kinematics_, map_, model_, expansion, transformed).add(nodes, rotations, force);
    expansion.add_product(transformed, increment, product);
  });
  return product;
}

la::SymmetricMatrix System::stressed_tangent(const la::Vector& response, double part) {
  const auto field = nodal(response);
  const auto places = model::positions(model_, state_);
  const double lambda = lambda_;
  apply(part);
  model::State stressed = state_;
  la::SymmetricMatrix k = new_matrix();
  assemble_tangent(k, [&](const auto& element) -> const model::State& {
    double size = 0;
    const auto motions = deformation(places, field, element.nodes, uses_rotations(model_, element), size);
    std::size_t i = 0;
    for (const int node : element.nodes) {
      stressed.displacement[node] = state_.displacement[node] + part * motions[i].displacement;
      stressed.rotation[node] = rotation_of(part * motions[i].rotation) * state_.rotation[node];
      ++i;
    }
    return stressed;
  });
  apply(lambda);
  return k;
}

double System::largest_deformation(const la::Vector& response) const {
  const auto field = nodal(response);
  const auto places = model::positions(model_, state_);
  double largest = 0;
  for_each_own([&](const auto& element) {
    double size = 0;
    for (const auto& motion :
         deformation(places, field, element.nodes, uses_rotations(model_, element), size)) {
      largest = std::max(largest, motion.rotation.norm());
      largest = std::max(largest, motion.displacement.norm() / (size > 0 ? size : size_));
    }
  });
  return la::max_over_ranks(largest);
}

}  // namespace tautline::assembly
