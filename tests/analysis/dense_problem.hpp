#pragma once
// A nonlinear problem given by two functions of a few unknowns: Newton and the path driver without any
// elements.

#include <functional>
#include <tautline/analysis/path.hpp>

#include "la/chain.hpp"

namespace tautline::analysis::testing_problem {

using la::testing_chain::dense_of;
using la::testing_chain::fill;
using la::testing_chain::full_pattern;
using la::testing_chain::layout_of;
using la::testing_chain::vector_of;

/// gradient(x, lambda) = 0 for x of two blocks of three unknowns.
class DenseProblem : public PathProblem {
 public:
  static constexpr int n = 6;
  using Gradient = std::function<VecX(const VecX& x, double lambda)>;
  using Hessian = std::function<MatX(const VecX& x)>;

  DenseProblem(Gradient gradient, Hessian hessian)
      : gradient_(std::move(gradient)), hessian_(std::move(hessian)) {}

  VecX point = VecX::Zero(n);      ///< where the problem is
  VecX committed = VecX::Zero(n);  ///< where it was when it was kept last
  double lambda = 1;
  double reference = 1;  ///< force the residual is compared with
  double size = 1;       ///< what an increment is compared with

  const Gradient& gradient() const { return gradient_; }
  const Hessian& hessian() const { return hessian_; }
  /// Residual at the present point and lambda.
  double out_of_balance() const { return gradient_(point, lambda).norm(); }

  const la::BlockLayout& layout() const override { return layout_; }
  void residual(const la::Vector& x, la::Vector& f) override {
    const VecX value = gradient_(origin_ + dense_of(x), lambda);
    f.write(std::span(value.data() + 3 * layout_.first, static_cast<std::size_t>(3 * layout_.local)));
  }
  void tangent(la::SymmetricMatrix& k) override { fill(k, hessian_(point)); }
  void accept(const la::Vector& x) override { point = origin_ + dense_of(x); }
  void restart() override { origin_ = point; }
  ResidualNorms norms(const la::Vector& f) const override { return {f.norm(), 0, reference, 0}; }
  double relative_size(const la::Vector& increment) const override {
    return dense_of(increment).lpNorm<Eigen::Infinity>() / size;
  }
  void set_lambda(double value) override { lambda = value; }
  void commit() override { committed = point; }
  void roll_back() override {
    point = committed;
    restart();
  }
  struct Place : Kept {
    VecX point;
    double lambda = 0;
  };
  std::shared_ptr<const Kept> keep() const override {
    auto place = std::make_shared<Place>();
    place->point = point;
    place->lambda = lambda;
    return place;
  }
  void return_to(const Kept& kept) override {
    point = static_cast<const Place&>(kept).point;
    lambda = static_cast<const Place&>(kept).lambda;
    restart();
  }
  void load_rate(la::Vector& q) override {
    const double h = 1e-3;
    const VecX rate = -(gradient_(point, lambda + h) - gradient_(point, lambda - h)) / (2 * h);
    q.write(std::span(rate.data() + 3 * layout_.first, static_cast<std::size_t>(3 * layout_.local)));
  }
  void weights(double, la::Vector& d) const override {
    const std::vector<double> ones(static_cast<std::size_t>(3 * layout_.local), 1 / (size * size));
    d.write(ones);
  }

 private:
  Gradient gradient_;
  Hessian hessian_;
  la::BlockLayout layout_ = layout_of(n / 3);
  VecX origin_ = VecX::Zero(n);
};

/// x + x^3 = (pull) lambda + x5 of five equal unknowns, where x5 = 2 lambda is prescribed.
class DrivenProblem : public DenseProblem {
 public:
  static constexpr double way = 2;
  explicit DrivenProblem(double pull)
      : DenseProblem(
            [pull](const VecX& x, double part) {
              VecX f(n);
              for (int i = 0; i < 5; ++i) f[i] = x[i] + x[i] * x[i] * x[i] - (pull + way) * part;
              f[5] = 0;
              return f;
            },
            [](const VecX& x) {
              MatX k = MatX::Identity(n, n);
              for (int i = 0; i < 5; ++i) k(i, i) += 3 * x[i] * x[i];
              return k;
            }) {}

  void accept(const la::Vector& x) override {
    DenseProblem::accept(x);
    point[5] = way * lambda;
  }
  void weights(double, la::Vector& d) const override {
    VecX all = VecX::Constant(n, weight);
    all[5] = 0;
    d.write(std::span(all.data() + 3 * layout().first, static_cast<std::size_t>(3 * layout().local)));
  }
  void drive_rate(la::Vector& w) const override { w = vector_of(way * VecX::Unit(n, 5)); }
  double drive_size(double) const override { return drive_weight * way * way; }
  bool changes_at_rest() override { return true; }

  double weight = 1, drive_weight = 1;
};

inline Workspace workspace() {
  const auto layout = layout_of(DenseProblem::n / 3);
  return {la::SymmetricMatrix(layout, full_pattern(layout)), la::DirectSolver()};
}

/// Six equal and independent unknowns, each with gradient(x, lambda) and slope(x).
inline DenseProblem six_times(const std::function<double(double, double)>& gradient,
                              const std::function<double(double)>& slope) {
  return {[=](const VecX& x, double lambda) {
            VecX f(x.size());
            for (int i = 0; i < f.size(); ++i) f[i] = gradient(x[i], lambda);
            return f;
          },
          [=](const VecX& x) {
            MatX k = MatX::Zero(x.size(), x.size());
            for (int i = 0; i < x.size(); ++i) k(i, i) = slope(x[i]);
            return k;
          }};
}

}  // namespace tautline::analysis::testing_problem
