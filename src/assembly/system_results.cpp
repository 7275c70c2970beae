// What is told of a system in its present state: norms, reactions, nodal fields, energies of small motions.
#include <algorithm>
#include <cmath>

#include <tautline/assembly/system.hpp>
#include <tautline/la/session.hpp>
#include <tautline/model/rounding.hpp>

#include "assembly/contribution.hpp"
#include "assembly/expansion.hpp"
#include "assembly/link_terms.hpp"

namespace tautline::assembly {

using element::Want;

double System::second_variation(const la::Vector& x) const {
  std::vector<double> all;
  x.gather(all);
  double sum = 0;
  const auto add_links = [&](const Expansion& expansion, const auto& nodes, bool rotations,
                             const auto& force) {
    if (expansion.plain()) return;
    const auto list = expansion.blocks();
    const auto n = 3 * static_cast<Eigen::Index>(list.size());
    MatX terms = MatX::Zero(n, n);
    LinkTerms(kinematics_, map_, model_, expansion, terms).add(nodes, rotations, force);
    VecX v(n);
    for (std::size_t i = 0; i < list.size(); ++i)
      v.segment<3>(3 * static_cast<Eigen::Index>(i)) =
          Eigen::Map<const Vec3>(&all[static_cast<std::size_t>(3 * list[i])]);
    sum += v.dot(terms * v);
  };
  const auto is_mine = [&](const auto& nodes) {
    return map_.node_rank[static_cast<std::size_t>(*std::begin(nodes))] == la::rank();
  };
  const auto each = [&](const auto& elements) {
    for (const auto& element : elements) {
      if (!is_mine(element.nodes)) continue;
      const bool rotations = uses_rotations(model_, element);
      const Expansion expansion(kinematics_, map_, element.nodes, rotations);
      sum += assembly::second_variation(model_, state_, element, expansion.rows_of<ElementVector>(all));
      if (!expansion.plain())
        add_links(expansion, element.nodes, rotations,
                  contribution(model_, state_, element, Want::force).force);
    }
  };
  model::for_each_kind(model_, each);
  const auto add_pressure = [&](const auto& facets, std::size_t first) {
    for (std::size_t i = 0; i < facets.size(); ++i) {
      const double p = now_.pressure[first + i];
      if (p == 0 || !is_mine(facets[i].nodes)) continue;
      const Expansion expansion(kinematics_, map_, facets[i].nodes, false);
      const auto c = pressure_contribution(model_, state_, facets[i].nodes, p, Want::tangent);
      const auto v = expansion.rows_of<ElementVector>(all);
      sum -= v.dot(c.tangent * v);
      add_links(expansion, facets[i].nodes, false, (-c.force).eval());
    }
  };
  add_pressure(model_.membranes, 0);
  add_pressure(model_.shells, model_.membranes.size());
  for (int at = 0; at < static_cast<int>(model_.nodes.size()); ++at) {
    if (map_.node_rank[at] != la::rank() || !load_bends(at)) continue;
    const bool turns = map_.rotational[at];
    Vec<6> load;
    load << -now_.force[at], -now_.moment[at];
    const std::array<int, 1> node{at};
    add_links(Expansion(kinematics_, map_, node, turns), node, turns, load);
  }
  return la::sum_over_ranks(sum);
}

template <class Value>
Vec<2> System::norms_by_kind(const Value& value) const {
  Vec<2> squares = Vec<2>::Zero();
  for (std::size_t node = 0; node < model_.nodes.size(); ++node) {
    if (map_.node_rank[node] != la::rank()) continue;
    const auto add = [&](int block, double& sum) {
      for (int c = 0; block >= 0 && c < 3; ++c) sum += std::pow(value(block, c), 2);
    };
    add(map_.displacement_block[node], squares[0]);
    add(map_.rotation_block[node], squares[1]);
  }
  for (double& sum : squares) sum = la::sum_over_ranks(sum);
  return squares.cwiseSqrt();
}

model::Rounding System::rounding_beside(const Vec<2>& forces_and_moments) const {
  const auto digits = model::nodal_rounding(model_, state_);
  return {digits.force + model::last_digit * forces_and_moments[0],
          digits.moment + model::last_digit * forces_and_moments[1]};
}

model::Rounding System::rounding() const {
  std::vector<double> force(origin_.size(), 0.0), magnitude(origin_.size(), 0.0);
  add_forces(state_, kinematics_, force, magnitude);
  return rounding_beside(
      norms_by_kind([&](int block, int c) { return magnitude[static_cast<std::size_t>(3 * block + c)]; }));
}

analysis::ResidualNorms System::norms(const la::Vector& f) const {
  std::vector<double> own(static_cast<std::size_t>(3 * map_.layout.local));
  f.read(own);
  const auto residual = norms_by_kind(
      [&](int block, int c) { return own[static_cast<std::size_t>(3 * (block - map_.layout.first) + c)]; });
  const auto reference =
      norms_by_kind([&](int block, int c) { return magnitude_[static_cast<std::size_t>(3 * block + c)]; });
  const auto rounding = rounding_beside(reference);
  // Where nothing bends yet there is no moment to compare with: force times size stands in, far below any
  // real moment. Where moments alone act there is no force to compare with: moment over size stands in, below
  // any shear force that makes such moments.
  return {residual[0],
          residual[1],
          std::max(reference[0], reference[1] / size_),
          std::max(reference[1], 1e-3 * reference[0] * size_),
          rounding.force,
          rounding.moment};
}

double System::relative_size(const la::Vector& increment) const {
  std::vector<double> own(static_cast<std::size_t>(3 * map_.layout.local));
  increment.read(own);
  double largest = 0;
  for (std::size_t node = 0; node < model_.nodes.size(); ++node) {
    const int block = map_.displacement_block[node];
    if (block < 0 || map_.node_rank[node] != la::rank()) continue;
    const auto at = static_cast<std::size_t>(3 * (block - map_.layout.first));
    largest = std::max(largest, Eigen::Map<const Vec3>(&own[at]).norm());
  }
  return la::max_over_ranks(largest) / size_;
}

std::vector<double> System::nodal_imbalance() const {
  if (!kinematics_.any_charted()) return out_of_balance();
  std::vector<double> force(origin_.size(), 0.0), magnitude(origin_.size(), 0.0);
  add_forces(state_, kinematics_.in_nodal_spins(state_), force, magnitude);
  return gathered(force);
}

System::NodalForces System::reactions() const {
  const auto residual = nodal_imbalance();
  NodalForces result{Points(model_.nodes.size(), Vec3::Zero()), Points(model_.nodes.size(), Vec3::Zero())};
  const auto held_part = [&](int block) -> Vec3 {
    Vec3 value = Vec3::Zero();
    for (int c = 0; c < 3; ++c)
      if (held()[static_cast<std::size_t>(3 * block + c)])
        value[c] = residual[static_cast<std::size_t>(3 * block + c)];
    return kinematics_.frame(block) * value;
  };
  const auto moment_part = [&](int node, int block) -> Vec3 {
    const Mat3 axes = kinematics_.reaction_axes(node), frame = axes * kinematics_.frame(block);
    const Vec3 whole =
        kinematics_.frame(block) * Eigen::Map<const Vec3>(&residual[static_cast<std::size_t>(3 * block)]);
    Vec3 value = frame.transpose() * whole;
    for (int c = 0; c < 3; ++c)
      if (!held()[static_cast<std::size_t>(3 * block + c)]) value[c] = 0;
    return frame * value;
  };
  for (std::size_t node = 0; node < model_.nodes.size(); ++node) {
    if (map_.displacement_block[node] >= 0) result.force[node] = held_part(map_.displacement_block[node]);
    const int link = kinematics_.link_of(static_cast<int>(node));
    const bool is_hinge = link >= 0 && !model_.links[static_cast<std::size_t>(link)].rotation_free;
    if (map_.rotation_block[node] >= 0 && !is_hinge)
      result.moment[node] = moment_part(static_cast<int>(node), map_.rotation_block[node]);
  }
  for (const auto& first : kinematics_.constrained())  // what holds it is no support
    result.force[first.node][first.component] = 0;
  return result;
}

System::NodalForces System::nodal_residual() const {
  NodalForces result = external();
  for (std::size_t node = 0; node < model_.nodes.size(); ++node) {
    result.force[node] *= -1;
    result.moment[node] *= -1;
  }
  model::for_each_kind(model_, [&](const auto& elements) {
    for (const auto& element : elements) {
      const auto force = contribution(model_, state_, element, Want::force).force;
      const auto n = static_cast<Eigen::Index>(element.nodes.size()), stride = force.size() / n;
      for (Eigen::Index i = 0; i < n; ++i) {
        const auto node = static_cast<std::size_t>(element.nodes[static_cast<int>(i)]);
        result.force[node] += force.template segment<3>(stride * i);
        if (stride == 6) result.moment[node] += force.template segment<3>(stride * i + 3);
      }
    }
  });
  const auto order = model::links_in_order(model_);
  for (auto i = order.rbegin(); i != order.rend(); ++i) {
    const auto& link = model_.links[static_cast<std::size_t>(*i)];
    Vec3 &force = result.force[link.follower], &moment = result.moment[link.follower];
    result.force[link.leader] += force;
    result.moment[link.leader] += moment + kinematics_.lever(*i).cross(force);
    force = moment = Vec3::Zero();
  }
  return result;
}

System::NodalForces System::constraint_forces() const {
  NodalForces result{Points(model_.nodes.size(), Vec3::Zero()), Points(model_.nodes.size(), Vec3::Zero())};
  const auto residual = out_of_balance();
  for (std::size_t i = 0; i < model_.constraints.size(); ++i) {
    const auto& constraint = model_.constraints[i];
    const auto& first = kinematics_.constrained()[i];
    const int block = map_.displacement_block[first.node];
    const double multiplier =
        residual[static_cast<std::size_t>(3 * block + first.component)] / first.coefficient;
    for (const auto& term : constraint.terms)
      result.force[term.node][term.component] += multiplier * term.coefficient;
  }
  if (model_.cyclic_pairs.empty()) return result;
  const auto nodal = nodal_residual();
  for (const auto& pair : model_.cyclic_pairs) {
    const Vec3 &force = nodal.force[pair.follower], &moment = nodal.moment[pair.follower];
    result.force[pair.follower] += force;
    result.moment[pair.follower] += moment;
    result.force[pair.leader] -= pair.turn.transpose() * force;
    result.moment[pair.leader] -= pair.turn.transpose() * moment;
  }
  return result;
}

System::NodalField System::nodal(const la::Vector& x) const {
  std::vector<double> all;
  x.gather(all);
  return nodal(all);
}

System::NodalField System::nodal(const std::vector<double>& all) const {
  const auto sum = [&](const std::vector<Dependence>& list) {
    Vec3 value = Vec3::Zero();
    for (const auto& d : list)
      value += d.matrix * Eigen::Map<const Vec3>(&all[static_cast<std::size_t>(3 * d.block)]);
    return value;
  };
  NodalField field{Points(model_.nodes.size()), Points(model_.nodes.size())};
  for (std::size_t node = 0; node < model_.nodes.size(); ++node) {
    field.displacement[node] = sum(kinematics_.displacement(static_cast<int>(node)));
    field.rotation[node] = sum(kinematics_.rotation(static_cast<int>(node)));
  }
  return field;
}

}  // namespace tautline::assembly
