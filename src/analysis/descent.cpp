#include <tautline/analysis/descent.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/core/interrupt.hpp>
#include <tautline/la/session.hpp>

#include "analysis/judge.hpp"

namespace tautline::analysis {

namespace {

constexpr int most_steps = 300;
constexpr int most_soft_steps = 100;   // with one limit of the stiffness
constexpr double softest = 10;         // first limit over the forces out of balance: strains of a tenth
constexpr double growth = 10;          // of the limit from one rest to the next
constexpr double at_rest = 1e-3;       // residual at which elements may become stiffer
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
    if (problem_.taut_stiffness(y_)) scale_.add(1, y_);
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

/// Goes downhill to `near_enough` of the reference force, or until damping is no longer needed near there.
/// @return a sentence if it does not arrive
std::string go_down(Body& body, NonlinearProblem& problem, double near_enough, double tolerance, int most,
                    DescentSummary& summary, const IterationCallback& callback) {
  double way = 0;
  for (const int first = summary.steps;; ++summary.steps) {
    if (la::true_on_any_rank(interrupt_requested())) throw Interrupted();
    summary.residual = relative_residual(problem.norms(body.force()));
    if (callback) callback(summary.steps, summary.residual);
    if (summary.residual <= (body.damped() ? tolerance : near_enough)) return {};
    const double step = summary.steps - first < most ? body.advance() : 0;
    way += step;
    if (step < 0) summary.newton.status = NewtonStatus::singular;
    if (step <= 0 || way > longest_way)
      return fmt::format(
          "going downhill in energy led {:.2g} times the structure's size away in {} steps and came to "
          "{:.2e} of the reference force",
          way, summary.steps - first, summary.residual);
  }
}

/// Elements have their own stiffness again at its end.
class Softening {
 public:
  explicit Softening(NonlinearProblem& problem) : problem_(problem) {}
  ~Softening() { problem_.soften(std::numeric_limits<double>::infinity()); }
  Softening(const Softening&) = delete;
  Softening& operator=(const Softening&) = delete;
  /// @return whether any element is softer than its own
  bool limit(double force) { return problem_.soften(force) > 1; }

 private:
  NonlinearProblem& problem_;
};

}  // namespace

DescentSummary descend(NonlinearProblem& problem, Workspace& workspace, const NewtonOptions& options,
                       const IterationCallback& callback) {
  DescentSummary summary;
  Body body(problem, workspace);
  summary.newton.reason =
      go_down(body, problem, near, options.force_tolerance, most_steps, summary, callback);
  if (!summary.newton.reason.empty()) return summary;
  body.rest();
  summary.newton = solve_newton(problem, workspace, options, callback);
  return summary;
}

DescentSummary descend_softly(NonlinearProblem& problem, Workspace& workspace, const NewtonOptions& options,
                              const IterationCallback& callback) {
  DescentSummary soft;
  {
    Softening softening(problem);
    la::Vector x(problem.layout()), f(problem.layout());
    problem.restart();
    problem.residual(x, f);
    for (double limit = softest * problem.norms(f).force; softening.limit(limit); limit *= growth) {
      Body body(problem, workspace);
      go_down(body, problem, at_rest, at_rest, most_soft_steps, soft, callback);
      body.rest();
    }
  }
  auto summary = descend(problem, workspace, options, callback);
  summary.steps += soft.steps;
  return summary;
}

bool gives_way(NonlinearProblem& problem, Workspace& workspace) {
  constexpr double small = 1e-6;  // of the stiffness when taut
  la::Vector taut(problem.layout());
  if (!problem.taut_stiffness(taut)) return false;
  problem.tangent(workspace.tangent);
  const auto is_singular = [&] {
    return !workspace.solver.factor(workspace.tangent) || workspace.solver.inertia().null > 0;
  };
  if (!is_singular()) return false;
  workspace.tangent.add_diagonal(small, taut);
  return !is_singular();
}

}  // namespace tautline::analysis
