#include <tautline/assembly/system.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/core/stopwatch.hpp>
#include <tautline/la/session.hpp>

#include "assembly/contribution.hpp"
#include "assembly/expansion.hpp"
#include "assembly/inertia_relief.hpp"
#include "assembly/load_audit.hpp"
#include "assembly/own_elements.hpp"

namespace tautline::assembly {

using element::Want;

namespace {

double bounding_size(const model::Model& model) {
  Vec3 low = model.nodes.front(), high = low;
  for (const auto& node : model.nodes) {
    low = low.cwiseMin(node);
    high = high.cwiseMax(node);
  }
  const double size = (high - low).norm();
  return size > 0 ? size : 1;
}

}  // namespace

Acting Acting::blended(const Acting& other, double t) const {
  const auto blend = [t](const auto& a, const auto& b) {
    auto result = a;
    for (std::size_t i = 0; i < a.size(); ++i) result[i] = (1 - t) * a[i] + t * b[i];
    return result;
  };
  return {blend(force, other.force),
          blend(moment, other.moment),
          blend(line, other.line),
          blend(pressure, other.pressure),
          blend(temperature, other.temperature),
          blend(temperature_gradient, other.temperature_gradient),
          blend(strain, other.strain),
          (1 - t) * acceleration + t * other.acceleration};
}

System::System(model::Model model)
    : model_(std::move(model)),
      map_(make_dof_map(model_)),
      kinematics_(model_, map_),
      state_(model::State::initial(model_)),
      committed_(state_),
      size_(bounding_size(model_)) {
  const auto mine = [&](const auto& elements, std::vector<int>& indices) {
    for (int i = 0; i < static_cast<int>(elements.size()); ++i) {
      const auto blocks = unknowns_of(model_, map_, elements[i]);
      if (std::any_of(blocks.begin(), blocks.end(), [&](int block) { return map_.owns(block); }))
        indices.push_back(i);
    }
  };
  mine(model_.cables, share_.cables);
  mine(model_.beams, share_.beams);
  mine(model_.membranes, share_.membranes);
  mine(model_.shells, share_.shells);
  mine(model_.springs, share_.springs);
  mine(model_.masses, share_.masses);
  origin_.assign(static_cast<std::size_t>(n_dofs()), 0.0);
  magnitude_ = start_residual_ = origin_;
  for (const auto& cable : model_.cables) now_.strain.push_back(cable.initial_strain);
  end_ = start_ = now_ = acting({}, now_.strain);
  for (const auto& group : model_.groups)
    if (model::is_cable_like(group.kind))
      support_stiffness_ = std::max(support_stiffness_, group.cable.axial_stiffness / size_);
}

System::~System() = default;

void System::set_state(const model::State& state) {
  state_ = committed_ = state;
  drives_.clear();
  prescribed_.clear();
  last_motion_.reset();
  kinematics_.linearise(state_);
  restart();
}

void System::set_state(const model::State& state, const std::vector<double>& strains) {
  set_state(state);
  for (std::size_t i = 0; i < strains.size(); ++i) model_.cables[i].initial_strain = strains[i];
  start_.strain = end_.strain = now_.strain = strains;
}

void System::reset() {
  set_state(model::State::initial(model_));
  start_ = end_ = now_ = acting({}, now_.strain);
}

std::vector<double> System::strains() const {
  return now_.strain;
}

OutOfBalance System::begin_stage(const Boundary& boundary) {
  last_motion_.reset();
  relief_.reset();
  if (boundary.free) {
    refuse_motions(boundary.loads);
    relief_ = std::make_unique<InertiaRelief>(model_, map_, state_);
    state_ = relief_->centred(state_);
  }
  kinematics_.hold(relief_ ? relief_->holds(state_) : boundary.supports, turned_nodes(boundary));
  kinematics_.settle(state_);
  kinematics_.linearise(state_);
  start_ = now_;
  end_ = acting(boundary, wanted_strain_.value_or(start_.strain));
  wanted_strain_.reset();
  audit_loads(boundary, end_.strain);
  check_motions(model_, boundary, map_, kinematics_);
  find_drives(boundary);
  note_prescribed(boundary);
  driven_to_ = committed_drive_ = 0;
  apply(0);
  start_residual_ = out_of_balance();
  // What meets the eye: the imbalance once the loads of the stage act in full.
  apply(1);
  const auto imbalance = out_of_balance();
  apply(0);
  OutOfBalance result;
  for (std::size_t node = 0; node < model_.nodes.size(); ++node) {
    const auto size_of = [&](const std::vector<double>& forces, int block) {
      Vec3 value = Vec3::Zero();
      for (int c = 0; block >= 0 && c < 3; ++c)
        if (!held()[static_cast<std::size_t>(3 * block + c)])
          value[c] = forces[static_cast<std::size_t>(3 * block + c)];
      return value.norm();
    };
    const double force = size_of(imbalance, map_.displacement_block[node]);
    if (force > result.force) {
      result.force = force;
      result.node = static_cast<int>(node);
    }
    result.moment = std::max(result.moment, size_of(imbalance, map_.rotation_block[node]));
    result.before = std::max(result.before, size_of(start_residual_, map_.displacement_block[node]));
  }
  return result;
}

void System::set_target_strains(std::vector<double> strains) {
  wanted_strain_ = std::move(strains);
}

void System::set_stiffness_factors(const std::vector<double>& factors) {
  for (std::size_t i = 0; i < factors.size(); ++i) model_.cables[i].stiffness_factor = factors[i];
}

void System::set_lambda(double lambda) {
  apply(lambda);
}

void System::apply(double lambda) {
  lambda_ = lambda;
  now_ = start_.blended(end_, lambda);
  for (std::size_t i = 0; i < model_.cables.size(); ++i) model_.cables[i].initial_strain = now_.strain[i];
  for (std::size_t i = 0; i < model_.cables.size(); ++i) model_.cables[i].line_load = now_.line[i];
  std::size_t next = 0;
  const auto warm = [&](auto& elements) {
    for (auto& element : elements) element.temperature_change = now_.temperature[next++];
  };
  warm(model_.cables);
  warm(model_.beams);
  warm(model_.membranes);
  warm(model_.shells);
  for (std::size_t i = 0; i < model_.beams.size(); ++i) {
    auto& beam = model_.beams[i];
    beam.line_load = now_.line[model_.cables.size() + i];
    beam.temperature_gradient = beam.frame.rightCols<2>().transpose() * now_.temperature_gradient[i];
  }
  model_.acceleration = now_.acceleration;
}

void System::add_forces(const model::State& state, const Kinematics& at, std::vector<double>& force,
                        std::vector<double>& magnitude) const {
  const auto add = [&](const auto& nodes, bool rotations, const auto& values) {
    const Expansion expansion(at, map_, nodes, rotations);
    expansion.add(values, force);
    expansion.add(values.cwiseAbs(), magnitude);
  };
  for_each_own([&](const auto& element) {
    add(element.nodes, uses_rotations(model_, element), answer(state, element, Want::force).force);
  });
  for_each_pressed([&](const model::FacetNodes& nodes, double pressure) {
    const Expansion expansion(at, map_, nodes, false);
    expansion.add(-pressure_contribution(model_, state, nodes, pressure, Want::force).force, force);
  });
  for (int node = 0; node < static_cast<int>(model_.nodes.size()); ++node) {
    const bool turns = map_.rotational[static_cast<std::size_t>(node)];
    const Vec<6> load = dead_load(node);
    if (load.head(turns ? 6 : 3).isZero(0)) continue;
    const Expansion expansion(at, map_, std::array<int, 1>{node}, turns);
    expansion.add(-load.head(turns ? 6 : 3), force);
  }
}

Vec<6> System::dead_load(int node) const {
  const auto at = static_cast<std::size_t>(node);
  Vec<6> load;
  load << now_.force[at], now_.moment[at];
  if (relief_) load += relief_->force(node);
  return load;
}

void System::add_inertia(const model::State& state, std::vector<double>& force) {
  relief_->balance(kinematics_, state, force);
  for (int node = 0; node < static_cast<int>(model_.nodes.size()); ++node) {
    const bool turns = map_.rotational[static_cast<std::size_t>(node)];
    const Expansion expansion(kinematics_, map_, std::array<int, 1>{node}, turns);
    expansion.add(-relief_->force(node).head(turns ? 6 : 3), force);
  }
}

model::State System::centred(model::State state) const {
  return relief_ ? relief_->centred(std::move(state)) : state;
}

void System::take_state() {
  kinematics_.linearise(state_);
  if (!relief_) return;
  relief_->take_masses(state_);
  for (std::size_t i = 0; i < model_.beams.size(); ++i)
    model_.beams[i].line_load =
        now_.line[model_.cables.size() + i] + relief_->line_load(model_.beams[i], state_);
}

std::span<const double> System::own_part(const std::vector<double>& all) const {
  return std::span(all).subspan(static_cast<std::size_t>(3 * map_.layout.first),
                                static_cast<std::size_t>(3 * map_.layout.local));
}

std::vector<double> System::gathered(const std::vector<double>& own_complete) const {
  std::vector<double> all;
  la::Vector own(map_.layout);
  own.write(own_part(own_complete));
  own.gather(all);
  return all;
}

std::vector<double> System::out_of_balance() const {
  std::vector<double> force(origin_.size(), 0.0), magnitude(origin_.size(), 0.0);
  add_forces(state_, kinematics_, force, magnitude);
  return gathered(force);
}

std::vector<double> System::increments_to(const la::Vector& x) const {
  std::vector<double> all;
  x.gather(all);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] -= origin_[i];
  for (const auto& drive : drives_)
    for (int c = 0; c < 3; ++c)
      if (const auto unknown = static_cast<std::size_t>(3 * drive.block + c); held()[unknown])
        all[unknown] = (lambda_ - driven_to_) * drive.way[c];
  return all;
}

void System::residual(const la::Vector& x, la::Vector& f) {
  const Stopwatch watch(assembly_seconds_);
  residual_at(centred(kinematics_.moved(state_, increments_to(x))), f);
}

void System::residual_at(const model::State& state, la::Vector& f) {
  kinematics_.linearise(state);
  std::vector<double> force(origin_.size(), 0.0);
  magnitude_.assign(origin_.size(), 0.0);
  if (relief_) relief_->clear();
  add_forces(state, kinematics_, force, magnitude_);
  for (std::size_t i = 0; i < force.size(); ++i) force[i] -= (1 - lambda_) * start_residual_[i];
  if (relief_) add_inertia(state, force);
  for (std::size_t i = 0; i < force.size(); ++i)
    if (held()[i]) force[i] = 0;
  f.write(own_part(force));
}

void System::accept(const la::Vector& x) {
  const auto increments = increments_to(x);
  if (std::any_of(increments.begin(), increments.end(), [](double part) { return part != 0; }))
    last_motion_.emplace(LastMotion{state_, nodal(increments)});
  state_ = centred(kinematics_.moved(state_, increments));
  driven_to_ = lambda_;
  take_state();
  x.gather(origin_);
}

void System::restart() {
  std::fill(origin_.begin(), origin_.end(), 0.0);
}

void System::commit() {
  committed_ = state_;
  committed_drive_ = driven_to_;
}

void System::roll_back() {
  state_ = committed_;
  driven_to_ = committed_drive_;
  last_motion_.reset();
  take_state();
  restart();
}

la::SymmetricMatrix System::mass(MassKind kind) const {
  la::SymmetricMatrix m = new_matrix();
  for_each_own([&](const auto& element) {
    const Expansion expansion(kinematics_, map_, element.nodes, uses_rotations(model_, element));
    auto values = mass_of(model_, state_, element, kind);
    if (expansion.plain()) return add_free(expansion.blocks(), values, held(), m);
    const MatX& b = expansion.matrix();
    MatX transformed = b.transpose() * values * b;
    add_free(expansion.blocks(), transformed, held(), m);
  });
  const Mat3 zero = Mat3::Zero();
  for (int block = map_.layout.first; block < map_.layout.first + map_.layout.local; ++block)
    m.add(std::array<int, 1>{block}, zero.data());
  m.finish();
  return m;
}

}  // namespace tautline::assembly
