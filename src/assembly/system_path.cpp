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
  last_motion_.reset();
  take_state();
  restart();
  apply(point.lambda);
}

/// The loads are linear in lambda, what temperatures and unstressed lengths do nearly so: a wide difference
/// keeps the digits.
std::vector<double> System::force_rate() {
  constexpr double h = 1e-2;
  const double lambda = lambda_;
  const auto residual_at_lambda = [&](double at) {
    apply(at);
    std::vector<double> force(origin_.size(), 0.0), magnitude(origin_.size(), 0.0);
    add_forces(state_, kinematics_, force, magnitude);
    for (std::size_t i = 0; i < force.size(); ++i) force[i] -= (1 - at) * start_residual_[i];
    return force;
  };
  kinematics_.linearise(state_);
  auto rate = residual_at_lambda(lambda - h);
  const auto ahead = residual_at_lambda(lambda + h);
  apply(lambda);
  for (std::size_t i = 0; i < rate.size(); ++i) rate[i] = (rate[i] - ahead[i]) / (2 * h);
  return rate;
}

void System::load_rate(la::Vector& q) {
  auto rate = force_rate();
  if (!drives_.empty()) {
    const auto pull = stiffness_times(drive_rates());
    for (std::size_t i = 0; i < rate.size(); ++i) rate[i] -= pull[i];
  }
  for (std::size_t i = 0; i < rate.size(); ++i)
    if (held()[i]) rate[i] = 0;
  q.write(own_part(rate));
}

bool System::changes_at_rest() {
  constexpr double nothing = 1e-12;  // of the forces that are there
  if (!drives_.empty()) return true;
  la::Vector zero(map_.layout), rate(map_.layout);
  residual(zero, rate);  // for the forces that are there
  rate.write(own_part(force_rate()));
  const auto norms = this->norms(rate);
  return norms.force > nothing * norms.reference_force || norms.moment > nothing * norms.reference_moment;
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

std::vector<double> System::drive_rates() const {
  std::vector<double> rates(origin_.size(), 0.0);
  for (const auto& drive : drives_)
    for (int c = 0; c < 3; ++c) rates[static_cast<std::size_t>(3 * drive.block + c)] = drive.way[c];
  return rates;
}

void System::drive_rate(la::Vector& w) const {
  w.write(own_part(drive_rates()));
}

void System::add_drives(la::Vector& x) const {
  la::Vector w(map_.layout);
  drive_rate(w);
  x.add(1, w);
}

double System::drive_size(double rotation_weight) const {
  std::vector<bool> turns(static_cast<std::size_t>(map_.layout.total), false);
  for (const int block : map_.rotation_block)
    if (block >= 0) turns[static_cast<std::size_t>(block)] = true;
  double sum = 0;
  for (const auto& drive : drives_)
    sum += drive.way.squaredNorm() *
           (turns[static_cast<std::size_t>(drive.block)] ? rotation_weight : 1 / (size_ * size_));
  return sum;
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
