#include <tautline/analysis/path.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <tautline/analysis/descent.hpp>
#include <tautline/analysis/relaxation.hpp>
#include <tautline/analysis/stability.hpp>
#include <tautline/core/error.hpp>
#include <tautline/core/interrupt.hpp>
#include <tautline/la/session.hpp>

#include "analysis/judge.hpp"

namespace tautline::analysis {

namespace {

constexpr int easy_iterations = 6;  // a step that took no more may be followed by a longer one

/// One step on, but not past the next of the points k / increments, nor past the end.
double next_point(double reached, double step, int increments) {
  const double slack = 1e-12, next = (std::floor(reached * increments + 1e-9) + 1) / increments;
  const double aim = std::min(reached + step, next);
  if (aim > 1 - slack) return 1;
  return aim > next - slack ? next : aim;
}

NewtonSummary solve_point(PathProblem& problem, Workspace& workspace, const NewtonOptions& options,
                          const IterationCallback& callback, Stability stability = Stability::any) {
  if (problem.predict(workspace)) return solve_newton(problem, workspace, options, callback, stability);
  NewtonSummary summary;
  summary.status = NewtonStatus::singular;
  summary.reason = "the tangent stiffness is singular where the supports begin to move";
  return summary;
}

/// Starts a search at `lambda` that keeps to no path: from where the tangent leads, or from where only the
/// prescribed unknowns have moved, whichever is nearer to balance.
void approach(PathProblem& problem, Workspace& workspace, double lambda) {
  problem.set_lambda(lambda);
  const auto here = problem.keep();
  const auto imbalance = [&] {
    la::Vector x(problem.layout()), f(problem.layout());
    problem.restart();
    problem.residual(x, f);
    return std::isfinite(f.norm()) ? relative_residual(problem.norms(f)) : HUGE_VAL;
  };
  const double before = imbalance();
  if (problem.predict(workspace) && imbalance() < before) return;
  problem.return_to(*here);
  problem.set_lambda(lambda);
}

const char* name_of(LastResort method) {
  return method == LastResort::descent ? "descent in energy" : "dynamic relaxation";
}

/// One run from lambda = 0 to 1.
class Driver {
 public:
  Driver(PathProblem& problem, Workspace& workspace, const NewtonOptions& options,
         const PathCallback& callback, const PathStart& start)
      : problem_(problem),
        workspace_(workspace),
        options_(options),
        callback_(callback),
        last_resort_(start.last_resort),
        reached_(start.lambda),
        lost_(start.unknown) {}

  PathSummary run() {
    problem_.set_lambda(reached_);
    problem_.commit();
    here_ = problem_.keep();
    try {
      while (reached_ < 1 && advance()) {
      }
      if (reached_ < 1 && last_resort_ != LastResort::none) leave_path();
    } catch (...) {
      problem_.roll_back();
      problem_.set_lambda(reached_);
      throw;
    }
    summary_.reached = reached_ >= 1;
    if (!summary_.reached) return std::move(summary_);
    summary_.inertia = inertia_;
    if (inertia_.negative > 0) summary_.inertia.negative = count_firmly_negative(problem_, workspace_);
    if (!summary_.last_resort)
      summary_.reason = fmt::format("lambda = 1 reached in {} step{}", summary_.points.size(),
                                    summary_.points.size() == 1 ? "" : "s");
    return std::move(summary_);
  }

 private:
  IterationCallback teller(double aim) const {
    return [this, aim](int iteration, double residual) {
      if (callback_.iteration) callback_.iteration(aim, iteration, residual);
    };
  }

  /// One step or one attempt at it. @return false if the path ends here
  bool advance() {
    if (la::true_on_any_rank(interrupt_requested())) throw Interrupted();
    const double aim = next_point(reached_, step_, options_.increments);
    problem_.set_lambda(aim);
    const bool far = !plain_ && !lost_ && aim - reached_ > shortest;
    auto newton =
        solve_point(problem_, workspace_, options_, teller(aim), far ? Stability::kept : Stability::any);
    summary_.newton_iterations += newton.newton_iterations();
    bool lost = std::exchange(lost_, false);
    const bool first = summary_.points.empty() && summary_.failed_attempts == 0;
    const bool unstable = lost && newton.converged() && workspace_.solver.inertia().negative > 0;
    const bool slack = first && !newton.converged() && starts_slack();
    if ((lost && !newton.converged()) || unstable || slack)
      newton = go_downhill(aim, slack, std::move(newton));
    lost = lost || slack;
    if (!newton.converged()) return shorten(aim, newton.status, newton.reason);
    const bool easy = newton.newton_iterations() <= easy_iterations;
    if (!arrive(aim, std::move(newton), !lost))
      return shorten(aim, NewtonStatus::diverged, "the step leapt to an unstable equilibrium off the path");
    if (easy) step_ = std::min(2 * step_, 1.0 / options_.increments);
    return true;
  }

  /// Takes the equilibrium in which the problem stands as the path's point at `aim`, whoever found it.
  /// @param followed  whether a path led here, on which critical points may lie
  /// @return false if it is not the path that leads here, which a shorter step would show
  bool arrive(double aim, NewtonSummary newton, bool followed) {
    note_inertia(newton);
    if (!followed) negative_ = inertia_.negative;
    auto critical = look_between(aim);
    if (leapt(critical, aim)) return false;
    for (auto& point : critical) {
      summary_.critical.push_back(std::move(point));
      if (callback_.critical) callback_.critical(summary_.critical.back());
    }
    negative_ = inertia_.negative;
    problem_.commit();
    here_ = problem_.keep();
    reached_ = aim;
    summary_.points.push_back({aim, std::move(newton), inertia_.negative, {}});
    if (callback_.converged) callback_.converged(summary_.points.back());
    return true;
  }

  /// A path becomes unstable at points where an eigenvalue vanishes. If none does, the step has come to
  /// another equilibrium, e.g. of a part turned far in one step.
  bool leapt(const std::vector<CriticalPoint>& critical, double aim) const {
    constexpr double vanished = 1e-3;
    if (negative_ < 0 || inertia_.negative <= negative_ || aim - reached_ <= shortest) return false;
    return std::none_of(critical.begin(), critical.end(),
                        [](const CriticalPoint& point) { return std::abs(point.eigenvalue) < vanished; });
  }

  /// Ways to an equilibrium without a path.
  enum class Way { soft, stiff, relaxed };

  /// From where no equilibrium is known and Newton's method found none, or an unstable one, which is taken if
  /// nothing better is found.
  /// @param slack  whether elements that only pull give way at the start; else softness is tried last
  NewtonSummary go_downhill(double aim, bool slack, NewtonSummary newton) {
    auto there = problem_.keep();
    NewtonSummary found;
    for (const Way way :
         slack ? std::vector{Way::soft, Way::stiff, Way::relaxed} : std::vector{Way::stiff, Way::soft}) {
      problem_.roll_back();
      approach(problem_, workspace_, aim);
      found = go(way, aim);
      summary_.newton_iterations += found.newton_iterations();
      if (!found.converged()) continue;
      if (is_stable()) return found;
      if (newton.converged()) continue;
      newton = std::move(found);
      there = problem_.keep();
    }
    if (!newton.converged()) return found;
    problem_.return_to(*there);
    count_negative(problem_, workspace_);
    return newton;
  }

  NewtonSummary go(Way way, double aim) {
    if (way == Way::relaxed) {
      summary_.descent_steps += relax(problem_, workspace_, {}, teller(aim)).steps;
      return solve_newton(problem_, workspace_, options_, teller(aim));
    }
    auto descent = (way == Way::soft ? descend_softly : descend)(problem_, workspace_, options_, teller(aim));
    summary_.descent_steps += descent.steps;
    return std::move(descent.newton);
  }

  /// Whether the equilibrium just found is, within rounding. The tangent is factored afterwards.
  bool is_stable() {
    if (workspace_.solver.inertia().negative == 0) return true;
    const bool result = count_firmly_negative(problem_, workspace_) == 0;
    count_negative(problem_, workspace_);
    return result;
  }

  /// Whether there is no path from the start, because what is slack there would fall.
  bool starts_slack() {
    const auto there = problem_.keep();
    problem_.roll_back();
    problem_.set_lambda(reached_);  // pressure that acts already has a part in the tangent
    const bool result = gives_way(problem_, workspace_);
    problem_.return_to(*there);
    return result;
  }

  /// From the last point of a path that gave up to an equilibrium at its end that the path does not lead to.
  void leave_path() {
    LastResortSummary told;
    told.method = last_resort_;
    told.gave_up = summary_.reason;
    told.gave_up_at = reached_;
    if (callback_.gave_up) callback_.gave_up(told);
    approach(problem_, workspace_, 1);
    auto newton = search(told);
    told.newton_iterations = newton.newton_iterations();
    summary_.newton_iterations += told.newton_iterations;
    if (newton.converged()) {
      summary_.reason = fmt::format("reached by {} in {} steps and {} Newton iterations",
                                    name_of(last_resort_), told.steps, told.newton_iterations);
      arrive(1, std::move(newton), false);
    } else {
      summary_.reason +=
          fmt::format("; {} then came to {:.1e} of the reference force in {} steps, from where {}",
                      name_of(last_resort_), told.residual, told.steps, newton.reason);
      problem_.roll_back();
      problem_.set_lambda(reached_);
    }
    summary_.last_resort = std::move(told);
  }

  NewtonSummary search(LastResortSummary& told) {
    auto polish = options_;
    polish.max_iterations = std::max(polish.max_iterations, NewtonOptions{}.max_iterations);
    if (last_resort_ == LastResort::descent) {
      auto descent = descend(problem_, workspace_, polish, teller(1));
      told.steps = descent.steps;
      told.residual = descent.residual;
      return std::move(descent.newton);
    }
    const auto relaxed = relax(problem_, workspace_, {}, teller(1));
    told.steps = relaxed.steps;
    told.peaks = relaxed.peaks;
    told.residual = relaxed.residual;
    return solve_newton(problem_, workspace_, polish, teller(1));
  }

  bool shorten(double aim, NewtonStatus status, const std::string& why) {
    problem_.roll_back();
    ++summary_.failed_attempts;
    summary_.singular = status == NewtonStatus::singular;
    step_ = std::min(step_, aim - reached_) / 2;
    if (step_ >= options_.min_step) return true;
    if (summary_.points.empty() &&
        !std::exchange(plain_, true)) {  // once more as if nothing were known better
      step_ = 1.0 / options_.increments;
      return true;
    }
    problem_.set_lambda(reached_);
    summary_.reason = fmt::format(
        "stopped at lambda = {:.4g}: the step {:.2e} fell below min_step = {:.2e}; the last attempt "
        "failed because {}",
        reached_, step_, options_.min_step, why);
    return false;
  }

  /// The last iteration factored the tangent; where there was none it is done here.
  void note_inertia(const NewtonSummary& newton) {
    if (newton.newton_iterations() == 0) count_negative(problem_, workspace_);
    inertia_ = workspace_.solver.inertia();
  }

  /// Where the number of negative pivots has changed since the last point, the points at which it did. The
  /// problem stays where it is.
  std::vector<CriticalPoint> look_between(double aim) {
    std::vector<CriticalPoint> critical;
    const auto there = problem_.keep();
    const int after = inertia_.negative;
    if (negative_ < 0 && after == 0)
      negative_ = 0;  // a start that was unstable is past when the end is stable
    if (negative_ < 0) {
      problem_.return_to(*here_);
      negative_ = count_negative(problem_, workspace_);
      problem_.return_to(*there);
    }
    if (negative_ == after) return critical;
    Workspace search{workspace_.tangent.shifted(0), la::DirectSolver()};  // what it does is not counted
    double low = reached_;
    for (int round = 0, before = negative_; round < most_critical && before != after; ++round) {
      const auto go = [&](double t) -> std::optional<double> {
        const double lambda = low + t * (aim - low);
        problem_.return_to(*here_);
        problem_.set_lambda(lambda);
        if (!solve_point(problem_, search, options_, {}).converged()) return std::nullopt;
        return lambda;
      };
      problem_.return_to(*here_);
      if (low > reached_) go(0);
      double behind = 1;
      auto found = find_critical_point(problem_, search, {go, before, after, low}, behind);
      if (!found) break;
      before = found->negative_after;
      low += behind * (aim - low);
      critical.push_back(std::move(*found));
    }
    problem_.return_to(*there);
    return critical;
  }

  static constexpr int most_critical = 8;
  static constexpr double shortest = 1.0 / 64;  // step, which is not taken for a leap
  PathProblem& problem_;
  Workspace& workspace_;
  const NewtonOptions& options_;
  const PathCallback& callback_;
  PathSummary summary_;
  std::shared_ptr<const PathProblem::Kept> here_;
  la::Inertia inertia_;
  LastResort last_resort_;
  double reached_, step_ = 1.0 / options_.increments;
  bool lost_;           // no equilibrium is known
  bool plain_ = false;  // far steps as short ones, with the true tangent whatever its inertia
  int negative_ = -1;   // at the last point; not known at the start
};

}  // namespace

PathSummary follow_path(PathProblem& problem, Workspace& workspace, const NewtonOptions& options,
                        const PathCallback& callback, const PathStart& start) {
  return Driver(problem, workspace, options, callback, start).run();
}

}  // namespace tautline::analysis
