#include <tautline/analysis/gauss_newton.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tautline::analysis {

namespace {

enum class Side { free, lower, upper };

/// The active-set method's working data.
class ActiveSet {
 public:
  ActiveSet(const MatX& jacobian, const VecX& residual, const VecX& at, const VecX& preferred, const Box& box,
            double rank_tolerance)
      : jacobian_(jacobian),
        residual_(residual),
        at_(at),
        preferred_(preferred),
        box_(box),
        rank_tolerance_(rank_tolerance),
        point_(at),
        side_(static_cast<std::size_t>(at.size()), Side::free) {}

  VecX solve() {
    const int most = 10 + 4 * static_cast<int>(at_.size());
    for (int i = 0; i < most; ++i)
      if (go_to(minimiser()) && !release()) break;
    return point_;
  }

 private:
  /// Nearest to `preferred` among the minimisers with the bound parameters held.
  VecX minimiser() const {
    VecX wanted = point_;
    std::vector<Eigen::Index> free;
    for (Eigen::Index j = 0; j < at_.size(); ++j)
      if (side_[static_cast<std::size_t>(j)] == Side::free) free.push_back(j);
    if (free.empty()) return wanted;
    for (const auto j : free) wanted[j] = preferred_[j];
    const VecX left = -residual_ - jacobian_ * (wanted - at_);
    Eigen::CompleteOrthogonalDecomposition<MatX> factors;
    factors.setThreshold(rank_tolerance_);
    factors.compute(jacobian_(Eigen::all, free));
    const VecX more = factors.solve(left);
    for (std::size_t k = 0; k < free.size(); ++k) wanted[free[k]] += more[static_cast<Eigen::Index>(k)];
    return wanted;
  }

  /// As far towards `wanted` as the box allows. @return whether all the way
  bool go_to(const VecX& wanted) {
    double part = 1;
    Eigen::Index blocking = -1;
    for (Eigen::Index j = 0; j < at_.size(); ++j) {
      const double way = wanted[j] - point_[j];
      const double room = (way > 0 ? box_.upper[j] : box_.lower[j]) - point_[j];
      if (way == 0 || std::abs(way) <= std::abs(room) || std::abs(room) >= part * std::abs(way)) continue;
      part = std::abs(room) / std::abs(way);
      blocking = j;
    }
    if (blocking < 0) {
      point_ = wanted;
      return true;
    }
    const bool up = wanted[blocking] > point_[blocking];
    point_ += part * (wanted - point_);
    point_[blocking] = up ? box_.upper[blocking] : box_.lower[blocking];
    side_[static_cast<std::size_t>(blocking)] = up ? Side::upper : Side::lower;
    return false;
  }

  /// Frees the bound parameter that pulls inwards most. @return whether there is one
  bool release() {
    const VecX gradient = jacobian_.transpose() * (residual_ + jacobian_ * (point_ - at_));
    const double size = jacobian_.norm() * residual_.norm();
    double most = 1e-12 * size;
    Eigen::Index found = -1;
    for (Eigen::Index j = 0; j < at_.size(); ++j) {
      const Side side = side_[static_cast<std::size_t>(j)];
      const double inwards = side == Side::lower ? -gradient[j] : side == Side::upper ? gradient[j] : 0;
      if (inwards <= most) continue;
      most = inwards;
      found = j;
    }
    if (found >= 0) side_[static_cast<std::size_t>(found)] = Side::free;
    return found >= 0;
  }

  const MatX& jacobian_;
  const VecX &residual_, &at_, &preferred_;
  const Box& box_;
  double rank_tolerance_;
  VecX point_;
  std::vector<Side> side_;
};

double largest(const VecX& values) {
  return values.size() > 0 ? values.cwiseAbs().maxCoeff() : 0;
}

void note_rank(const MatX& jacobian, double rank_tolerance, GaussNewtonSummary& summary) {
  const VecX values = Eigen::BDCSVD<MatX>(jacobian).singularValues();
  summary.rank = 0;
  for (const double value : values)
    if (value > rank_tolerance * values[0]) ++summary.rank;
  summary.condition = summary.rank > 0 ? values[0] / values[summary.rank - 1] : 0;
  summary.influence = jacobian.rowwise().norm();
}

/// The whole step or the largest half, quarter, ... of it that makes the residuals smaller. @return zero if
/// none does
double search(InverseProblem& problem, const VecX& step, double tolerance, GaussNewtonSummary& summary) {
  constexpr double least = 1e-4;
  for (double part = 1; part >= least; part /= 2) {
    const VecX trial = summary.parameters + part * step;
    if (!problem.move_to(trial)) continue;
    const VecX residual = problem.residual();
    if (residual.norm() >= summary.residual.norm() && largest(residual) > tolerance) continue;
    problem.keep();
    summary.parameters = trial;
    summary.residual = residual;
    return part;
  }
  problem.restore();
  return 0;
}

bool finish(GaussNewtonSummary& summary, GaussNewtonStatus status, const std::string& reason) {
  summary.status = status;
  summary.reason = reason;
  return true;
}

/// Whether the iteration ends where it is.
/// @param left part of the residuals that the step would leave if all were linear
bool judge(double left, const GaussNewtonOptions& options, GaussNewtonSummary& summary) {
  constexpr double hardly = 0.9;
  const auto& points = summary.iterations;
  const auto& point = points.back();
  const bool small = point.change <= options.step_tolerance;
  if (point.largest <= options.tolerance) {
    // What still changes but does not shrink is rounding.
    const bool settled = points.size() > 1 && point.change > 0.5 * points[points.size() - 2].change &&
                         points[points.size() - 2].largest <= options.tolerance;
    if (small || settled)
      return finish(summary, GaussNewtonStatus::met,
                    fmt::format("all targets are met: no miss is larger than the tolerance of {:.2e}",
                                options.tolerance));
  } else if (small && left > hardly) {
    return finish(
        summary, GaussNewtonStatus::least_squares,
        fmt::format("the sum of squares of the misses has its minimum; the largest miss left is {:.4e}",
                    point.largest));
  }
  if (static_cast<int>(points.size()) <= options.max_iterations) return false;
  return finish(
      summary, GaussNewtonStatus::too_many_iterations,
      fmt::format("after {} iterations the largest miss is {:.3e}, and the next step would change an "
                  "unknown by {:.2e} of its start",
                  options.max_iterations, point.largest, point.change));
}

/// What it means that no part of the step could be taken.
void judge_stuck(double left, const GaussNewtonOptions& options, GaussNewtonSummary& summary) {
  const double miss = summary.iterations.back().largest;
  if (miss <= options.tolerance)
    finish(summary, GaussNewtonStatus::met,
           fmt::format("all targets are met: no miss is larger than the tolerance of {:.2e}",
                       options.tolerance));
  else if (left > 1 - 1e-6)
    finish(summary, GaussNewtonStatus::least_squares,
           fmt::format("no step makes the misses smaller; the largest miss left is {:.4e}", miss));
  else
    finish(summary, GaussNewtonStatus::stuck,
           fmt::format("no part of the step makes the misses smaller or leads to an equilibrium; the largest "
                       "miss is {:.4e}",
                       miss));
}

}  // namespace

VecX bounded_least_squares(const MatX& jacobian, const VecX& residual, const VecX& at, const VecX& preferred,
                           const Box& box, double rank_tolerance) {
  return ActiveSet(jacobian, residual, at, preferred, box, rank_tolerance).solve();
}

GaussNewtonSummary solve_inverse(InverseProblem& problem, const VecX& start, const Box& box,
                                 const GaussNewtonOptions& options,
                                 const std::function<void(const GaussNewtonIteration&)>& told) {
  GaussNewtonSummary summary;
  summary.parameters = start;
  summary.residual = problem.residual();
  problem.keep();
  while (true) {
    const MatX jacobian = problem.jacobian();
    note_rank(jacobian, options.rank_tolerance, summary);
    const VecX step = bounded_least_squares(jacobian, summary.residual, summary.parameters, start, box,
                                            options.rank_tolerance) -
                      summary.parameters;
    auto& points = summary.iterations;
    const double n = std::max<double>(1, static_cast<double>(summary.residual.size()));
    points.push_back({largest(summary.residual), summary.residual.norm() / std::sqrt(n), largest(step), 0});
    const double left = (summary.residual + jacobian * step).norm() / summary.residual.norm();
    if (judge(left, options, summary)) break;
    points.back().step = search(problem, step, options.tolerance, summary);
    if (told) told(points.back());
    if (points.back().step > 0) continue;
    judge_stuck(left, options, summary);
    break;
  }
  return summary;
}

}  // namespace tautline::analysis
