#include <tautline/analysis/arc_length.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <tautline/analysis/stability.hpp>
#include <tautline/core/error.hpp>
#include <tautline/core/interrupt.hpp>
#include <tautline/la/session.hpp>

#include "analysis/bordered.hpp"

namespace tautline::analysis {

namespace {

constexpr double nothing = 1e-12;  // a load below this part of the forces that are there
constexpr double blind = 1e-12;    // a metric that sees less than this part of the squared size of a motion

Increment copy_of(const Increment& other) {
  Increment result{la::Vector::like(other.x), other.lambda};
  result.x.copy(other.x);
  return result;
}

/// One run along the path.
class Walk {
 public:
  Walk(PathProblem& problem, Workspace& workspace, const NewtonOptions& newton,
       const ArcLengthOptions& options, const std::optional<Watch>& watch, const PathCallback& callback,
       const PathStart& start)
      : problem_(problem),
        workspace_(workspace),
        newton_(newton),
        options_(options),
        watch_(watch),
        callback_(callback),
        weights_(problem.layout()),
        drive_(problem.layout()),
        tangent_{la::Vector(problem.layout()), 1},
        start_(start),
        lambda_(start.lambda) {}

  PathSummary run() {
    weigh(options_.rotation_weight);
    problem_.drive_rate(drive_);
    problem_.set_lambda(lambda_);
    problem_.commit();
    here_ = problem_.keep();
    if (watch_) watched_ = watch_->measure();
    try {
      if (start_.arc ? go_on(*start_.arc) : begin())
        while (!ended_) advance();
    } catch (...) {
      problem_.return_to(*here_);
      throw;
    }
    problem_.return_to(*here_);
    problem_.commit();
    if (!summary_.points.empty()) count_negative(problem_, workspace_);
    summary_.inertia = workspace_.solver.inertia();
    return std::move(summary_);
  }

 private:
  double size_squared(const Increment& step) const {
    la::Vector weighed = la::Vector::like(step.x);
    weighed.copy(step.x);
    weighed.multiply_entries(weights_);
    return step.x.dot(weighed) + psi2_ * step.lambda * step.lambda;
  }
  double along(const Increment& a, const Increment& b) const {
    la::Vector weighed = la::Vector::like(a.x);
    weighed.copy(a.x);
    weighed.multiply_entries(weights_);
    return b.x.dot(weighed) + psi2_ * a.lambda * b.lambda;
  }

  void end(bool reached, const std::string& reason) {
    ended_ = true;
    summary_.reached = reached;
    summary_.reason = reason;
  }

  /// Direction of the path at the present point, with a unit of lambda, and its inertia.
  bool find_tangent() {
    negative_ = count_negative(problem_, workspace_);
    la::Vector q = la::Vector::like(weights_);
    problem_.load_rate(q);
    la::solve(workspace_.solver, problem_.skew_part(), q, tangent_.x);
    tangent_.lambda = 1;
    return std::isfinite(tangent_.x.norm()) && workspace_.solver.failure().empty();
  }

  /// Whether the load of the path is no more than rounding of the forces that are there.
  bool is_nothing() {
    la::Vector zero = la::Vector::like(weights_), residual = la::Vector::like(weights_);
    problem_.residual(zero, residual);
    problem_.load_rate(residual);
    const auto norms = problem_.norms(residual);
    return norms.force <= nothing * norms.reference_force && norms.moment <= nothing * norms.reference_moment;
  }

  void weigh(double rotation_weight) {
    rotation_weight_ = rotation_weight;
    problem_.weights(rotation_weight, weights_);
    psi2_ = problem_.drive_size(rotation_weight);
  }

  /// What steps are measured in: the motion of free and of prescribed unknowns, and lambda if asked for. A
  /// path that turns only, where rotations are not to count, is measured in rotations all the same; one on
  /// which nothing moves, in lambda.
  void choose_metric() {
    if (is_nothing() && problem_.drive_size(1) == 0) {
      psi2_ = 1;
      return;
    }
    const double seen = size_squared(tangent_);
    weigh(1);
    if (seen > blind * size_squared(tangent_)) weigh(options_.rotation_weight);
    if (options_.constraint == ArcConstraint::spherical) psi2_ += size_squared(tangent_);
  }

  bool begin() {
    const bool regular = find_tangent();
    if (!regular || (is_nothing() && !problem_.changes_at_rest())) {
      end(false, regular ? "the loads of the path move nothing"
                         : "the tangent stiffness is singular at the start: " + workspace_.solver.failure());
      summary_.singular = true;
      return false;
    }
    choose_metric();
    length_ = first_length_ = options_.first_step * std::sqrt(size_squared(tangent_));
    return true;
  }

  bool go_on(const ArcPlace& place) {
    weigh(place.rotation_weight);
    psi2_ = place.lambda_weight;
    length_ = place.length;
    first_length_ = place.first_length;
    bifurcations_ = place.bifurcations;
    direction_ = place.direction;
    if (find_tangent()) return true;
    end(false, "the tangent stiffness is singular at the point kept: " + workspace_.solver.failure());
    return false;
  }

  int points() const {
    return (start_.arc ? start_.arc->points : 0) + static_cast<int>(summary_.points.size());
  }
  int critical_points() const {
    return (start_.arc ? start_.arc->critical : 0) + static_cast<int>(summary_.critical.size());
  }

  /// The first guess of a step of this length from the present point, in the direction of travel.
  Increment guess(double length) const {
    Increment step = copy_of(tangent_);
    const double scale = direction_ * length / std::sqrt(size_squared(tangent_));
    step.x.scale(scale);
    step.lambda *= scale;
    return step;
  }

  NewtonSummary solve(const Condition& condition, Increment& step) {
    const double aim = lambda_ + step.lambda;
    const auto tell = [&](int iteration, double residual) {
      if (callback_.iteration) callback_.iteration(aim, iteration, residual);
    };
    auto newton = solve_bordered(problem_, *active_, condition, lambda_, step, newton_, tell);
    if (active_ == &workspace_) summary_.newton_iterations += newton.newton_iterations();
    return newton;
  }

  /// A step of this length from the point kept; the problem stands at its end if it converged.
  NewtonSummary step_of(double length, Increment& step) {
    problem_.return_to(*here_);
    step = guess(length);
    auto newton = solve(SphereCondition(weights_, psi2_, length), step);
    if (newton.converged() && along(step, guess(length)) <= 0) {
      newton.status = NewtonStatus::diverged;
      newton.reason = "the step turned back on itself";
    }
    return newton;
  }

  void advance() {
    if (la::true_on_any_rank(interrupt_requested())) throw Interrupted();
    if (points() >= options_.max_points)
      return end(true, fmt::format("{} points were found, as many as max_points allows", points()));
    Increment step = copy_of(tangent_);
    auto newton = step_of(length_, step);
    const bool landed = newton.converged() && land(step, newton);
    if (!newton.converged()) return shorten(newton);
    const int before = negative_;
    const auto from = here_;
    const double length = std::sqrt(size_squared(step)), lambda_from = lambda_;
    const Increment tangent_from = copy_of(tangent_);
    const int direction_from = direction_;
    arrive(step);
    if (negative_ != before && left_between(from, lambda_from, tangent_from, direction_from, length, before))
      return;
    adapt(newton);
    note(newton);
    if (landed) end(true, landing_);
  }

  void shorten(const NewtonSummary& newton) {
    ++summary_.failed_attempts;
    summary_.singular = newton.status == NewtonStatus::singular;
    length_ /= 2;
    problem_.return_to(*here_);
    if (!(length_ > options_.smallest_step * first_length_))  // also where a length is zero or no number
      end(false, fmt::format("stopped at lambda = {:.6g} after {} points: the step fell below {:.0e} of the "
                             "first; the last attempt failed because {}",
                             lambda_, points(), options_.smallest_step, newton.reason));
  }

  void adapt(const NewtonSummary& newton) {
    const double iterations = std::max(1, newton.newton_iterations());
    length_ *= std::clamp(std::sqrt(options_.target_iterations / iterations), 0.5, 2.0);
    length_ = std::min(length_, options_.largest_step * first_length_);
  }

  /// Where the step has passed an end of the path, the step is made anew so that it ends there. @return
  /// whether it did
  bool land(Increment& step, NewtonSummary& newton) {
    const double lambda = lambda_ + step.lambda;
    la::Vector c = la::Vector::like(step.x);
    for (const double end : {options_.load_factor, options_.least_load_factor}) {
      if ((lambda_ - end) * (lambda - end) > 0 || lambda_ == end) continue;
      const double part = (end - lambda_) / step.lambda;
      if (!step_anew(step, newton, PlaneCondition(c, 1, end - lambda_), part)) return false;
      landing_ = fmt::format("lambda = {:.6g} reached after {} points", end, points() + 1);
      return true;
    }
    if (!watch_ || !options_.displacement) return false;
    const double driven = watch_->c.dot(drive_), left = *options_.displacement - watched_;
    const double way = watch_->c.dot(step.x) + driven * step.lambda;
    if (left * (left - way) > 0 || left == 0) return false;
    if (!step_anew(step, newton, PlaneCondition(watch_->c, driven, left), left / way)) return false;
    landing_ = fmt::format("the displacement {:.6g} m was reached at lambda = {:.6g} after {} points",
                           *options_.displacement, lambda_ + step.lambda, points() + 1);
    return true;
  }

  /// `newton` and `step` stay as they are, and the problem where it was, if the solve fails.
  bool step_anew(Increment& step, NewtonSummary& newton, const Condition& condition, double part) {
    const auto there = problem_.keep();
    problem_.return_to(*here_);
    Increment shorter = copy_of(step);
    shorter.x.scale(part);
    shorter.lambda *= part;
    auto attempt = solve(condition, shorter);
    if (!attempt.converged()) {
      problem_.return_to(*there);
      return false;
    }
    newton = std::move(attempt);
    step = std::move(shorter);
    return true;
  }

  /// Takes the point at which the problem stands as the present one.
  void arrive(const Increment& step) {
    lambda_ += step.lambda;
    if (watch_) watched_ = watch_->measure();
    problem_.commit();
    here_ = problem_.keep();
    find_tangent();
    direction_ = along(tangent_, step) < 0 ? -1 : 1;
  }

  void note(const NewtonSummary& newton) {
    const ArcPlace place{length_,      first_length_,     psi2_,        rotation_weight_, direction_,
                         points() + 1, critical_points(), bifurcations_};
    summary_.points.push_back({lambda_, newton, negative_, place});
    if (callback_.converged) callback_.converged(summary_.points.back());
  }

  /// Finds every critical point of the last step; leaves the problem where it was, or on a branch, or at the
  /// point the path was asked to stop at. @return whether the path was left
  bool left_between(const std::shared_ptr<const PathProblem::Kept>& from, double lambda_from,
                    const Increment& tangent_from, int direction_from, double length, int before) {
    const auto there = here_;
    const Increment tangent_there = copy_of(tangent_);
    const double lambda_there = lambda_;
    const int after = negative_, direction_there = direction_;
    const auto stand_before = [&] {
      here_ = from;
      lambda_ = lambda_from;
      tangent_ = copy_of(tangent_from);
      direction_ = direction_from;
    };
    Workspace search{workspace_.tangent.shifted(0), la::DirectSolver()};  // what it does is not counted
    active_ = &search;
    double start = 0;
    for (int round = 0, negative = before; round < 4 && negative != after && start < 1; ++round) {
      stand_before();
      Increment step = copy_of(tangent_from);
      const auto go = [&](double t) -> std::optional<double> {
        const double part = start + t * (1 - start);
        if (!step_of(part * length, step).converged()) return std::nullopt;
        return lambda_ + step.lambda;
      };
      if (start > 0)
        go(0);
      else
        problem_.return_to(*from);
      double behind = 1;
      auto found = find_critical_point(problem_, search, {go, negative, after, lambda_from}, behind);
      if (!found) break;
      start += behind * (1 - start);
      negative = found->negative_after;
      summary_.critical.push_back(std::move(*found));
      if (callback_.critical) callback_.critical(summary_.critical.back());
      active_ = &workspace_;
      if (leave_at(summary_.critical.back())) return true;
      active_ = &search;
    }
    active_ = &workspace_;
    here_ = there;
    lambda_ = lambda_there;
    tangent_ = copy_of(tangent_there);
    direction_ = direction_there;
    negative_ = after;
    problem_.return_to(*there);
    return false;
  }

  /// At a critical point: whether the path ends here or turns onto a branch.
  bool leave_at(const CriticalPoint& point) {
    if (critical_points() == options_.stop_at_critical) {
      stand_at(point);
      note({NewtonStatus::converged, "critical point", {}});
      end(true,
          fmt::format("stopped at critical point {}, lambda = {:.6g}", critical_points(), point.lambda));
      return true;
    }
    if (point.kind != CriticalPoint::Kind::bifurcation || ++bifurcations_ != options_.branch) return false;
    stand_at(point);
    if (branch_off(point)) return true;
    end(false,
        fmt::format("no branch was found at the bifurcation at lambda = {:.6g}: try another branch_step",
                    point.lambda));
    return true;
  }

  void stand_at(const CriticalPoint& point) {
    here_ = point.kept;
    lambda_ = point.lambda;
    negative_ = point.negative_after;
    problem_.return_to(*here_);
    if (watch_) watched_ = watch_->measure();
    problem_.commit();
  }

  /// A step along the critical mode, in which the mode's amplitude is prescribed; the lengths of the steps
  /// that follow are measured by it.
  bool branch_off(const CriticalPoint& point) {
    la::Vector along_mode = la::Vector::like(point.mode);
    along_mode.copy(point.mode);
    along_mode.multiply_entries(weights_);
    const double size = along_mode.dot(point.mode);
    const double full = options_.branch_step / problem_.relative_size(point.mode);
    for (const double amplitude : {full, full / 4, 4 * full}) {
      problem_.return_to(*here_);
      Increment step{la::Vector::like(point.mode), 0};
      step.x.copy(point.mode);
      step.x.scale(amplitude);
      const auto newton = solve(PlaneCondition(along_mode, 0, amplitude * size), step);
      if (!newton.converged()) continue;
      if (options_.constraint == ArcConstraint::cylindrical) weigh(rotation_weight_);
      length_ = first_length_ = std::abs(amplitude) * std::sqrt(size);
      arrive(step);
      note(newton);
      return true;
    }
    return false;
  }

  PathProblem& problem_;
  Workspace& workspace_;
  Workspace* active_ = &workspace_;  // another one during a search
  const NewtonOptions& newton_;
  const ArcLengthOptions& options_;
  const std::optional<Watch>& watch_;
  const PathCallback& callback_;
  PathSummary summary_;
  la::Vector weights_, drive_;  // drive_: what prescribed unknowns go in a unit of lambda
  Increment tangent_;           // the direction of the path for a unit of lambda
  const PathStart& start_;
  std::shared_ptr<const PathProblem::Kept> here_;
  double lambda_, rotation_weight_ = 1, psi2_ = 0, length_ = 0, first_length_ = 0, watched_ = 0;
  int negative_ = 0, bifurcations_ = 0;
  int direction_ = 1;  // in which the next step goes along the tangent
  bool ended_ = false;
  std::string landing_;
};

}  // namespace

PathSummary follow_arc(PathProblem& problem, Workspace& workspace, const NewtonOptions& newton,
                       const ArcLengthOptions& options, const std::optional<Watch>& watch,
                       const PathCallback& callback, const PathStart& start) {
  return Walk(problem, workspace, newton, options, watch, callback, start).run();
}

}  // namespace tautline::analysis
