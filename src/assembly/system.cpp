#include <tautline/assembly/system.hpp>

#include <algorithm>
#include <cmath>

#include <tautline/core/stopwatch.hpp>
#include <tautline/element/cable.hpp>
#include <tautline/la/session.hpp>
#include <tautline/model/element_data.hpp>

#include "assembly/rotation.hpp"

namespace tautline::assembly {

using element::Want;

namespace {

template <class Blocks, class Force>
void scatter(const Blocks& blocks, const Force& values, std::vector<double>& force,
             std::vector<double>& magnitude) {
  for (std::size_t b = 0; b < blocks.size(); ++b)
    for (int c = 0; c < 3; ++c) {
      const double value = values[3 * static_cast<int>(b) + c];
      force[3 * blocks[b] + c] += value;
      magnitude[3 * blocks[b] + c] += std::abs(value);
    }
}

/// Adds an element matrix without the rows and columns of held unknowns.
template <class Blocks, class Matrix>
void scatter(const Blocks& blocks, Matrix& values, const std::vector<bool>& held, la::SymmetricMatrix& to) {
  for (std::size_t b = 0; b < blocks.size(); ++b)
    for (int c = 0; c < 3; ++c)
      if (held[3 * blocks[b] + c]) {
        values.row(3 * static_cast<int>(b) + c).setZero();
        values.col(3 * static_cast<int>(b) + c).setZero();
      }
  to.add(blocks, values.data());
}

double bounding_size(const model::Model& model) {
  Vec3 low = model.nodes.front(), high = low;
  for (const auto& node : model.nodes) {
    low = low.cwiseMin(node);
    high = high.cwiseMax(node);
  }
  return (high - low).norm();
}

}  // namespace

System::System(model::Model model)
    : model_(std::move(model)),
      map_(make_dof_map(model_)),
      state_(model::State::reference(model_)),
      committed_(state_),
      size_(bounding_size(model_)) {
  const auto own = [&](int node) { return map_.node_rank[node] == la::rank(); };
  const auto mine = [&](const auto& elements, std::vector<int>& indices) {
    for (int i = 0; i < static_cast<int>(elements.size()); ++i)
      if (std::any_of(elements[i].nodes.begin(), elements[i].nodes.end(), own)) indices.push_back(i);
  };
  mine(model_.cables, share_.cables);
  mine(model_.beams, share_.beams);
  mine(model_.membranes, share_.membranes);
  for (const auto& cable : model_.cables) end_strain_.push_back(cable.initial_strain);
  start_strain_ = end_strain_;
  const auto unknowns = static_cast<std::size_t>(n_dofs());
  origin_.assign(unknowns, 0.0);
  held_.assign(unknowns, false);
  start_force_.assign(unknowns, 0.0);
  end_force_ = magnitude_ = start_force_;
  for (const auto& group : model_.groups)
    if (group.kind == model::ElementKind::cable)
      support_stiffness_ = std::max(support_stiffness_, group.cable.axial_stiffness / size_);
}

void System::set_state(const model::State& state) {
  state_ = committed_ = state;
  restart();
}

void System::set_state(const model::State& state, const std::vector<double>& strains) {
  set_state(state);
  for (std::size_t i = 0; i < strains.size(); ++i) model_.cables[i].initial_strain = strains[i];
  start_strain_ = end_strain_ = strains;
}

std::vector<double> System::strains() const {
  std::vector<double> result;
  for (const auto& cable : model_.cables) result.push_back(cable.initial_strain);
  return result;
}

void System::hold(const std::vector<model::Support>& supports) {
  held_.assign(held_.size(), false);
  for (const auto& support : supports)
    for (const int node : support.nodes)
      for (int c = 0; c < 6; ++c) {
        const int block = c < 3 ? map_.displacement_block[node] : map_.rotation_block[node];
        if (support.fixed[c] && block >= 0) held_[3 * block + c % 3] = true;
      }
}

OutOfBalance System::begin_stage(const Boundary& boundary) {
  hold(boundary.supports);
  start_force_ = internal_forces();
  end_force_ = dead_loads(boundary);
  for (std::size_t i = 0; i < model_.cables.size(); ++i) start_strain_[i] = model_.cables[i].initial_strain;
  end_strain_ = wanted_strain_ ? std::move(*wanted_strain_) : start_strain_;
  wanted_strain_.reset();
  OutOfBalance result;
  for (std::size_t node = 0; node < model_.nodes.size(); ++node) {
    const auto largest = [&](int block) {
      Vec3 value = Vec3::Zero();
      for (int c = 0; c < 3; ++c)
        if (!held_[3 * block + c]) value[c] = start_force_[3 * block + c] - end_force_[3 * block + c];
      return value.norm();
    };
    const double force = largest(map_.displacement_block[node]);
    if (force > result.force) result = {force, result.moment, static_cast<int>(node)};
    if (map_.rotation_block[node] >= 0)
      result.moment = std::max(result.moment, largest(map_.rotation_block[node]));
  }
  set_lambda(0);
  return result;
}

void System::set_target_strains(std::vector<double> strains) {
  wanted_strain_ = std::move(strains);
}

void System::set_lambda(double lambda) {
  lambda_ = lambda;
  apply_strains();
}

void System::apply_strains() {
  for (std::size_t i = 0; i < model_.cables.size(); ++i)
    model_.cables[i].initial_strain = (1 - lambda_) * start_strain_[i] + lambda_ * end_strain_[i];
}

void System::add_internal(const model::State& state, std::vector<double>& force,
                          std::vector<double>& magnitude) const {
  for (const int i : share_.cables) {
    const auto& cable = model_.cables[i];
    const auto data = model::cable_data(model_, cable);
    scatter(
        blocks_of(map_, cable),
        element::evaluate_cable(data.properties, data.x_ref, gather(state, cable.nodes), Want::force).force,
        force, magnitude);
  }
  for (const int i : share_.beams) {
    const auto& beam = model_.beams[i];
    scatter(blocks_of(map_, beam),
            element::evaluate_beam(model_.groups[beam.group].beam, model::beam_geometry(model_, beam),
                                   beam_motion(state, beam), Want::force)
                .force,
            force, magnitude);
  }
  for (const int i : share_.membranes) {
    const auto& membrane = model_.membranes[i];
    scatter(blocks_of(map_, membrane),
            element::evaluate_membrane(model_.groups[membrane.group].membrane, membrane.prestress,
                                       membrane_nodes(model_, membrane), gather(state, membrane.nodes),
                                       Want::force)
                .force,
            force, magnitude);
  }
}

std::span<const double> System::own_part(const std::vector<double>& all) const {
  return std::span(all).subspan(static_cast<std::size_t>(3 * map_.layout.first),
                                static_cast<std::size_t>(3 * map_.layout.local));
}

std::vector<double> System::internal_forces() const {
  std::vector<double> force(held_.size(), 0.0), magnitude(held_.size(), 0.0);
  add_internal(state_, force, magnitude);
  la::Vector own(map_.layout);
  own.write(own_part(force));
  own.gather(force);
  return force;
}

std::vector<double> System::dead_loads(const Boundary& boundary) const {
  std::vector<double> force(held_.size(), 0.0);
  const auto add = [&](int block, const Vec3& value) {
    for (int c = 0; c < 3 && block >= 0; ++c) force[3 * block + c] += value[c];
  };
  for (const auto& load : boundary.loads)
    for (const int node : load.nodes) {
      add(map_.displacement_block[node], load.force);
      add(map_.rotation_block[node], load.moment);
    }
  if (boundary.acceleration.isZero(0)) return force;
  la::Vector uniform(map_.layout), inertia(map_.layout);
  std::vector<double> field(held_.size(), 0.0), all;
  for (const int block : map_.displacement_block)
    for (int c = 0; c < 3; ++c) field[3 * block + c] = boundary.acceleration[c];
  uniform.write(own_part(field));
  assemble_mass(std::vector<bool>(held_.size(), false)).multiply(uniform, inertia);
  inertia.gather(all);
  for (std::size_t i = 0; i < force.size(); ++i) force[i] += all[i];
  return force;
}

model::State System::moved(const std::vector<double>& x) const {
  model::State state = state_;
  for (std::size_t node = 0; node < model_.nodes.size(); ++node) {
    const auto increment = [&](int block) -> Vec3 {
      return Eigen::Map<const Vec3>(&x[3 * block]) - Eigen::Map<const Vec3>(&origin_[3 * block]);
    };
    state.displacement[node] += increment(map_.displacement_block[node]);
    if (map_.rotation_block[node] >= 0)
      state.rotation[node] = rotation_of(increment(map_.rotation_block[node])) * state.rotation[node];
  }
  return state;
}

void System::residual(const la::Vector& x, la::Vector& f) {
  const Stopwatch watch(assembly_seconds_);
  std::vector<double> all;
  x.gather(all);
  std::vector<double> force(held_.size(), 0.0);
  magnitude_.assign(held_.size(), 0.0);
  add_internal(moved(all), force, magnitude_);
  for (std::size_t i = 0; i < force.size(); ++i) {
    force[i] -= (1 - lambda_) * start_force_[i] + lambda_ * end_force_[i];
    if (held_[i]) force[i] = 0;
  }
  f.write(own_part(force));
}

void System::accept(const la::Vector& x) {
  std::vector<double> all;
  x.gather(all);
  state_ = moved(all);
  origin_ = std::move(all);
}

void System::restart() {
  std::fill(origin_.begin(), origin_.end(), 0.0);
}

void System::commit() {
  committed_ = state_;
}

void System::roll_back() {
  state_ = committed_;
  restart();
}

void System::tangent(la::SymmetricMatrix& k) {
  const Stopwatch watch(assembly_seconds_);
  k.set_zero();
  for (const int i : share_.cables) {
    const auto& cable = model_.cables[i];
    const auto data = model::cable_data(model_, cable);
    auto response =
        element::evaluate_cable(data.properties, data.x_ref, gather(state_, cable.nodes), Want::tangent);
    scatter(blocks_of(map_, cable), response.tangent, held_, k);
  }
  for (const int i : share_.beams) {
    const auto& beam = model_.beams[i];
    auto response = element::evaluate_beam(model_.groups[beam.group].beam, model::beam_geometry(model_, beam),
                                           beam_motion(state_, beam), Want::tangent);
    scatter(blocks_of(map_, beam), response.tangent, held_, k);
  }
  for (const int i : share_.membranes) {
    const auto& membrane = model_.membranes[i];
    auto response = element::evaluate_membrane(model_.groups[membrane.group].membrane, membrane.prestress,
                                               membrane_nodes(model_, membrane),
                                               gather(state_, membrane.nodes), Want::tangent);
    scatter(blocks_of(map_, membrane), response.tangent, held_, k);
  }
  for (int block = map_.layout.first; block < map_.layout.first + map_.layout.local; ++block) {
    Mat3 identity = Mat3::Zero();
    for (int c = 0; c < 3; ++c)
      if (held_[3 * block + c]) identity(c, c) = support_stiffness_;
    k.add(std::array<int, 1>{block}, identity.data());
  }
  k.finish();
}

la::SymmetricMatrix System::assemble_mass(const std::vector<bool>& without) const {
  la::SymmetricMatrix m = new_matrix();
  for (const int i : share_.cables) {
    const auto& cable = model_.cables[i];
    auto values = element::cable_mass(model_.groups[cable.group].cable.mass_per_length,
                                      model::cable_data(model_, cable).x_ref);
    scatter(blocks_of(map_, cable), values, without, m);
  }
  for (const int i : share_.beams) {
    const auto& beam = model_.beams[i];
    const auto geometry = model::beam_geometry(model_, beam);
    const auto response = element::evaluate_beam(model_.groups[beam.group].beam, geometry,
                                                 beam_motion(state_, beam), Want::force);
    auto values = element::beam_mass(model_.groups[beam.group].beam,
                                     (geometry.x_ref.col(1) - geometry.x_ref.col(0)).norm(), response.frame);
    scatter(blocks_of(map_, beam), values, without, m);
  }
  for (const int i : share_.membranes) {
    const auto& membrane = model_.membranes[i];
    auto values = element::membrane_mass(model_.groups[membrane.group].membrane.mass_per_area,
                                         membrane_nodes(model_, membrane));
    scatter(blocks_of(map_, membrane), values, without, m);
  }
  const Mat3 zero = Mat3::Zero();
  for (int block = map_.layout.first; block < map_.layout.first + map_.layout.local; ++block)
    m.add(std::array<int, 1>{block}, zero.data());
  m.finish();
  return m;
}

double System::second_variation(const la::Vector& x) const {
  std::vector<double> all;
  x.gather(all);
  const auto first_is_own = [&](const auto& element) {
    return map_.node_rank[element.nodes[0]] == la::rank();
  };
  const auto at = [&](int block) { return Eigen::Map<const Vec3>(&all[3 * block]); };
  double sum = 0;
  for (const int i : share_.cables) {
    const auto& cable = model_.cables[i];
    if (!first_is_own(cable)) continue;
    const auto data = model::cable_data(model_, cable);
    const auto tangent =
        element::evaluate_cable(data.properties, data.x_ref, gather(state_, cable.nodes), Want::tangent)
            .tangent;
    const auto blocks = blocks_of(map_, cable);
    const Vec3 relative = at(blocks[1]) - at(blocks[0]);
    sum += relative.dot(tangent.topLeftCorner<3, 3>() * relative);
  }
  for (const int i : share_.beams) {
    const auto& beam = model_.beams[i];
    if (!first_is_own(beam)) continue;
    const auto blocks = blocks_of(map_, beam);
    Vec<12> v;
    v << at(blocks[0]), at(blocks[1]), at(blocks[2]), at(blocks[3]);
    sum += element::beam_second_variation(model_.groups[beam.group].beam, model::beam_geometry(model_, beam),
                                          beam_motion(state_, beam), v);
  }
  for (const int i : share_.membranes) {
    const auto& membrane = model_.membranes[i];
    if (!first_is_own(membrane)) continue;
    const auto blocks = blocks_of(map_, membrane);
    Vec<9> v;
    v << at(blocks[0]), at(blocks[1]), at(blocks[2]);
    const auto tangent = element::evaluate_membrane(model_.groups[membrane.group].membrane,
                                                    membrane.prestress, membrane_nodes(model_, membrane),
                                                    gather(state_, membrane.nodes), Want::tangent)
                             .tangent;
    sum += v.dot(tangent * v);
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
      for (int c = 0; c < 3; ++c) {
        const double value = own[static_cast<std::size_t>(3 * (block - map_.layout.first) + c)];
        residual += value * value;
        reference += std::pow(magnitude_[3 * block + c], 2);
      }
    };
    add(map_.displacement_block[node], sums[0], sums[2]);
    if (map_.rotation_block[node] >= 0) add(map_.rotation_block[node], sums[1], sums[3]);
  }
  for (double& sum : sums) sum = std::sqrt(la::sum_over_ranks(sum));
  // Where nothing bends yet there is no moment to compare with: force times size stands in, far below any
  // real moment. Where moments alone act there is no force to compare with: moment over size stands in, below
  // any shear force that makes such moments.
  return {sums[0], sums[1], std::max(sums[2], sums[3] / size_), std::max(sums[3], 1e-3 * sums[2] * size_)};
}

double System::relative_size(const la::Vector& increment) const {
  std::vector<double> own(static_cast<std::size_t>(3 * map_.layout.local));
  increment.read(own);
  double largest = 0;
  for (std::size_t node = 0; node < model_.nodes.size(); ++node)
    if (map_.node_rank[node] == la::rank()) {
      const auto at = static_cast<std::size_t>(3 * (map_.displacement_block[node] - map_.layout.first));
      largest = std::max(largest, Eigen::Map<const Vec3>(&own[at]).norm());
    }
  return la::max_over_ranks(largest) / size_;
}

System::Reactions System::reactions() {
  const auto internal = internal_forces();
  Reactions result{Points(model_.nodes.size(), Vec3::Zero()), Points(model_.nodes.size(), Vec3::Zero())};
  for (std::size_t node = 0; node < model_.nodes.size(); ++node)
    for (int c = 0; c < 3; ++c) {
      const int u = 3 * map_.displacement_block[node] + c;
      if (held_[u]) result.force[node][c] = internal[u] - end_force_[u];
      const int r = 3 * map_.rotation_block[node] + c;
      if (r >= 0 && held_[r]) result.moment[node][c] = internal[r] - end_force_[r];
    }
  return result;
}

System::NodalField System::nodal(const la::Vector& x) const {
  std::vector<double> all;
  x.gather(all);
  NodalField field{Points(model_.nodes.size(), Vec3::Zero()), Points(model_.nodes.size(), Vec3::Zero())};
  for (std::size_t node = 0; node < model_.nodes.size(); ++node) {
    field.displacement[node] = Eigen::Map<const Vec3>(&all[3 * map_.displacement_block[node]]);
    if (map_.rotation_block[node] >= 0)
      field.rotation[node] = Eigen::Map<const Vec3>(&all[3 * map_.rotation_block[node]]);
  }
  return field;
}

}  // namespace tautline::assembly
