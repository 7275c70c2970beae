// What is told of a system in its present state: norms, reactions, nodal fields, energies of small motions.
#include <algorithm>
#include <cmath>

#include <tautline/assembly/system.hpp>
#include <tautline/la/session.hpp>

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

analysis::ResidualNorms System::norms(const la::Vector& f) const {
  std::vector<double> own(static_cast<std::size_t>(3 * map_.layout.local));
  f.read(own);
  double sums[4] = {0, 0, 0, 0};
  for (std::size_t node = 0; node < model_.nodes.size(); ++node) {
    if (map_.node_rank[node] != la::rank()) continue;
    const auto add = [&](int block, double& residual, double& reference) {
      for (int c = 0; block >= 0 && c < 3; ++c) {
        const double value = own[static_cast<std::size_t>(3 * (block - map_.layout.first) + c)];
        residual += value * value;
        reference += std::pow(magnitude_[static_cast<std::size_t>(3 * block + c)], 2);
      }
    };
    add(map_.displacement_block[node], sums[0], sums[2]);
    add(map_.rotation_block[node], sums[1], sums[3]);
  }
  for (double& sum : sums) sum = std::sqrt(la::sum_over_ranks(sum));
  // Where nothing bends yet there is no moment to compare with: force times size stands in, far below any
  // real moment. Where moments alone act there is no force to compare with: moment over size stands in, below
  // any shear force that makes such moments.
  return {sums[0],
          sums[1],
          std::max(sums[2], sums[3] / size_),
          std::max(sums[3], 1e-3 * sums[2] * size_),
          rounding_force_,
          rounding_moment_};
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
  for (const auto& constraint : model_.constraints) {  // what holds it is no support
    const auto& first = constraint.terms.front();
    result.force[first.node][first.component] = 0;
  }
  return result;
}

System::NodalField System::nodal(const la::Vector& x) const {
  std::vector<double> all;
  x.gather(all);
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
