// What a path needs of a system beside residual and tangent: points to return to, rates, measures of motions.
#include <cmath>

#include <tautline/assembly/system.hpp>

#include "assembly/expansion.hpp"

namespace tautline::assembly {

std::shared_ptr<const analysis::PathProblem::Kept> System::keep() const {
  auto kept = std::make_shared<Place>();
  kept->state = state_;
  kept->lambda = lambda_;
  kept->driven_to = driven_to_;
  return kept;
}

void System::return_to(const Kept& kept) {
  const auto& point = static_cast<const Place&>(kept);
  state_ = point.state;
  driven_to_ = point.driven_to;
  kinematics_.linearise(state_);
  restart();
  apply(point.lambda);
}

/// The loads are linear in lambda, what temperatures and unstressed lengths do nearly so: a wide difference
/// keeps the digits.
void System::load_rate(la::Vector& q) {
  constexpr double h = 1e-2;
  const double lambda = lambda_;
  const auto residual_at = [&](double at) {
    apply(at);
    std::vector<double> force(origin_.size(), 0.0), magnitude(origin_.size(), 0.0);
    add_forces(state_, kinematics_, force, magnitude);
    for (std::size_t i = 0; i < force.size(); ++i) force[i] -= (1 - at) * start_residual_[i];
    return force;
  };
  kinematics_.linearise(state_);
  const auto ahead = residual_at(lambda + h), back = residual_at(lambda - h);
  apply(lambda);
  std::vector<double> rate(origin_.size(), 0.0), way(origin_.size(), 0.0);
  for (std::size_t i = 0; i < rate.size(); ++i) rate[i] = -(ahead[i] - back[i]) / (2 * h);
  if (!drives_.empty()) {
    for (const auto& drive : drives_)
      for (int c = 0; c < 3; ++c) way[static_cast<std::size_t>(3 * drive.block + c)] = drive.way[c];
    const auto pull = stiffness_times(way);
    for (std::size_t i = 0; i < rate.size(); ++i) rate[i] -= pull[i];
  }
  for (std::size_t i = 0; i < rate.size(); ++i)
    if (held()[i]) rate[i] = 0;
  q.write(own_part(rate));
}

void System::weights(double rotation_weight, la::Vector& d) const {
  std::vector<double> all(origin_.size(), 0.0);
  for (std::size_t node = 0; node < model_.nodes.size(); ++node) {
    const auto set = [&](int block, double value) {
      for (int c = 0; block >= 0 && c < 3; ++c) all[static_cast<std::size_t>(3 * block + c)] = value;
    };
    set(map_.displacement_block[node], 1 / (size_ * size_));
    set(map_.rotation_block[node], rotation_weight);
  }
  for (std::size_t i = 0; i < all.size(); ++i)
    if (held()[i]) all[i] = 0;
  d.write(own_part(all));
}

la::Vector System::mean_motion(const std::vector<int>& nodes, const Vec3& direction) const {
  std::vector<double> all(origin_.size(), 0.0);
  for (const int node : nodes)
    for (const auto& part : kinematics_.displacement(node))
      Eigen::Map<Vec3>(&all[static_cast<std::size_t>(3 * part.block)]) +=
          part.matrix.transpose() * direction / static_cast<double>(nodes.size());
  la::Vector c(map_.layout);
  c.write(own_part(all));
  return c;
}

void System::add_drives(la::Vector& x) const {
  std::vector<double> own(static_cast<std::size_t>(x.local_size()));
  x.read(own);
  for (const auto& drive : drives_)
    for (int c = 0; map_.owns(drive.block) && c < 3; ++c)
      own[static_cast<std::size_t>(3 * (drive.block - map_.layout.first) + c)] += drive.way[c];
  x.write(own);
}

Rest System::rest() const {
  Rest result{state_, now_, {}};
  for (const auto& cable : model_.cables) result.stiffness_factor.push_back(cable.stiffness_factor);
  return result;
}

void System::restore(const Rest& rest) {
  set_state(rest.state);
  set_stiffness_factors(rest.stiffness_factor);
  driven_to_ = committed_drive_ = 0;
  start_ = end_ = now_ = rest.acting;
  std::fill(start_residual_.begin(), start_residual_.end(), 0.0);
  apply(1);
}

void System::move(const la::Vector& increment) {
  restart();
  accept(increment);
  restart();
}

}  // namespace tautline::assembly
