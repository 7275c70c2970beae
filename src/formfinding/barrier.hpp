#pragma once
/// @file
/// Bounds of force densities in a search from inside.

#include <cmath>
#include <utility>

#include <tautline/core/types.hpp>

namespace tautline::formfinding {

/// Logarithmic barrier that keeps force densities inside their bounds, with its multipliers (primal-dual).
class Barrier {
 public:
  /// @param[in] lower, upper  dimensionless bounds; NaN or infinite: none
  Barrier(VecX lower, VecX upper) : lower_(std::move(lower)), upper_(std::move(upper)) {}

  bool active() const noexcept { return weight_ > 0; }
  double weight() const noexcept { return weight_; }
  bool empty() const { return lower_.array().isNaN().all() && upper_.array().isNaN().all(); }
  /// Moves q inside its bounds and sets the multipliers there.
  void begin(double weight, VecX& q);
  void lower_to(double weight) { weight_ = weight; }
  void end() { weight_ = 0; }
  double value(const VecX& q) const;
  VecX gradient(const VecX& q) const;
  /// Diagonal of the second derivative.
  VecX curvature(const VecX& q) const;
  /// The multipliers after a step.
  void follow(const VecX& q, const VecX& step);
  /// A new q no nearer to a bound than a part of the old one.
  VecX keep_inside(const VecX& q, VecX next) const;
  /// q at its bounds where the barrier holds it there.
  VecX settle(VecX q) const;

 private:
  /// Calls f(b, distance from a bound, sign of q in it, multiplier) for every bound.
  template <class Function>
  void for_each(const VecX& q, const Function& f) const {
    for (Eigen::Index b = 0; b < q.size(); ++b) {
      if (!std::isnan(lower_[b])) f(b, q[b] - lower_[b], 1.0, lower_multiplier_[b]);
      if (!std::isnan(upper_[b])) f(b, upper_[b] - q[b], -1.0, upper_multiplier_[b]);
    }
  }

  VecX lower_, upper_;
  mutable VecX lower_multiplier_, upper_multiplier_;
  double weight_ = 0;
};

}  // namespace tautline::formfinding
