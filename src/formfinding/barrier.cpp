#include <algorithm>
#include <formfinding/barrier.hpp>

namespace tautline::formfinding {

namespace {

constexpr double inside = 1e-2;  // distance from their bounds at which force densities start, dimensionless
constexpr double boundary_part = 0.01;  // of that distance, which one step leaves
constexpr double at_bound = 1e-5;       // distance from its bound of a force density that ends there

}  // namespace

void Barrier::begin(double weight, VecX& q) {
  weight_ = weight;
  lower_multiplier_ = upper_multiplier_ = VecX::Zero(q.size());
  for (Eigen::Index b = 0; b < q.size(); ++b) {
    const bool both = !std::isnan(lower_[b]) && !std::isnan(upper_[b]);
    const double least = both ? std::min(inside, 0.1 * (upper_[b] - lower_[b])) : inside;
    if (!std::isnan(lower_[b])) q[b] = std::max(q[b], lower_[b] + least);
    if (!std::isnan(upper_[b])) q[b] = std::min(q[b], upper_[b] - least);
  }
  for_each(
      q, [&](Eigen::Index, double distance, double, double& multiplier) { multiplier = weight / distance; });
}

double Barrier::value(const VecX& q) const {
  double sum = 0;
  if (active())
    for_each(q, [&](Eigen::Index, double distance, double, double) { sum -= weight_ * std::log(distance); });
  return sum;
}

VecX Barrier::gradient(const VecX& q) const {
  VecX gradient = VecX::Zero(q.size());
  if (active())
    for_each(q, [&](Eigen::Index b, double distance, double sign, double) {
      gradient[b] -= sign * weight_ / distance;
    });
  return gradient;
}

VecX Barrier::curvature(const VecX& q) const {
  VecX curvature = VecX::Zero(q.size());
  if (active())
    for_each(q, [&](Eigen::Index b, double distance, double, double multiplier) {
      curvature[b] += multiplier / distance;
    });
  return curvature;
}

void Barrier::follow(const VecX& q, const VecX& step) {
  constexpr double most = 1e8;  // times the multiplier of the barrier alone
  for_each(q, [&](Eigen::Index b, double distance, double sign, double& multiplier) {
    const double next = (weight_ - multiplier * sign * step[b]) / distance, alone = weight_ / distance;
    multiplier = std::clamp(std::max(next, boundary_part * multiplier), alone / most, alone * most);
  });
}

VecX Barrier::keep_inside(const VecX& q, VecX next) const {
  for (Eigen::Index b = 0; b < q.size(); ++b) {
    if (!std::isnan(lower_[b])) next[b] = std::max(next[b], lower_[b] + boundary_part * (q[b] - lower_[b]));
    if (!std::isnan(upper_[b])) next[b] = std::min(next[b], upper_[b] - boundary_part * (upper_[b] - q[b]));
  }
  return next;
}

VecX Barrier::settle(VecX q) const {
  const VecX from = q;
  for_each(from, [&](Eigen::Index b, double distance, double sign, double multiplier) {
    if (distance < at_bound && multiplier > distance) q[b] = sign > 0 ? lower_[b] : upper_[b];
  });
  return q;
}

}  // namespace tautline::formfinding
