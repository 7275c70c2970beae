#include <tautline/analysis/descent.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/core/interrupt.hpp>
#include <tautline/la/session.hpp>

#include "analysis/judge.hpp"

namespace tautline::analysis {

namespace {

constexpr int most_steps = 300;
constexpr double near = 1e-6;          // residual below which undamped steps are Newton's
constexpr double longest_step = 0.02;  // over the structure's size
constexpr double longest_way = 2;      // likewise, of all steps: what goes farther is not held
constexpr double least_damping = 1e-8, first_damping = 1e-7, most_damping = 1e3, change = 10;

/// A body that comes to rest without inertia. Steps are x - t y with (K + mu D) y = f.
class Body {
 public:
  Body(NonlinearProblem& problem, Workspace& workspace)
      : problem_(problem),
        workspace_(workspace),
        x_(problem.layout()),
        f_(problem.layout()),
        y_(problem.layout()),
        scale_(problem.layout()) {
    problem.restart();
    problem.residual(x_, f_);
  }

  /// @return how far it went over the structure's size; less than zero if no damping makes the tangent
  /// positive definite
  double advance() {
    problem_.accept(x_);
    problem_.tangent(workspace_.tangent);
    scale_.write(workspace_.tangent.absolute_row_sums_of_blocks());
    if (!factor()) return -1;
    workspace_.solver.solve(f_, y_);
    const double leap = problem_.relative_size(y_);
    const bool cut = leap > longest_step;
    if (cut) y_.scale(longest_step / leap);
    const double t = search();
    x_.add(-t, y_);
    problem_.residual(x_, f_);
    if (t == 1 && !cut) damping_ = damping_ / change < least_damping ? 0 : damping_ / change;
    if (t < 0.1) damping_ = std::max(change * damping_, first_damping);
    return t * std::min(leap, longest_step);
  }
  void rest() { problem_.accept(x_); }
  const la::Vector& force() const { return f_; }
  bool damped() const { return damping_ > 0; }

 private:
  bool factor() {
    for (double added = 0; damping_ <= most_damping;) {
      workspace_.tangent.add_diagonal(damping_ - added, scale_);
      added = damping_;
      if (workspace_.solver.factor(workspace_.tangent)) {
        const auto inertia = workspace_.solver.inertia();
        if (inertia.negative == 0 && inertia.null == 0) return true;
      }
      damping_ = std::max(change * damping_, first_damping);
    }
    return false;
  }

  /// -r(x - t y) . dx: what the energy falls by along the step.
  double slope(double t) {
    la::Vector x = la::Vector::like(x_), f = la::Vector::like(f_);
    x.copy(x_);
    x.add(-t, y_);
    problem_.residual(x, f);
    return f.dot(y_);
  }

  /// The whole step, or where along it the slope has fallen to half or is about to change its sign.
  double search() {
    constexpr int most = 30;
    const double start = f_.dot(y_), end = slope(1);
    if (std::isfinite(end) && end >= -0.9 * start) return 1;
    double left = 0, right = 1;
    for (int i = 0; i < most; ++i) {
      const double t = (left + right) / 2, here = slope(t);
      if (std::isfinite(here) && std::abs(here) <= 0.5 * start) return t;
      (std::isfinite(here) && here > 0 ? left : right) = t;
    }
    return left;
  }

  NonlinearProblem& problem_;
  Workspace& workspace_;
  la::Vector x_, f_, y_, scale_;
  double damping_ = 0;
};

}  // namespace

DescentSummary descend(NonlinearProblem& problem, Workspace& workspace, const NewtonOptions& options,
                       const IterationCallback& callback) {
  DescentSummary summary;
  Body body(problem, workspace);
  double way = 0;
  for (;; ++summary.steps) {
    if (la::true_on_any_rank(interrupt_requested())) throw Interrupted();
    summary.residual = relative_residual(problem.norms(body.force()));
    if (callback) callback(summary.steps, summary.residual);
    if (summary.residual <= (body.damped() ? options.force_tolerance : near)) break;
    const double step = summary.steps < most_steps ? body.advance() : 0;
    way += step;
    if (step < 0) summary.newton.status = NewtonStatus::singular;
    if (step <= 0 || way > longest_way) {
      summary.newton.reason = fmt::format(
          "going downhill in energy led {:.2g} times the structure's size away in {} steps and came to "
          "{:.2e} "
          "of the reference force",
          way, summary.steps, summary.residual);
      return summary;
    }
  }
  body.rest();
  summary.newton = solve_newton(problem, workspace, options, callback);
  return summary;
}

}  // namespace tautline::analysis
