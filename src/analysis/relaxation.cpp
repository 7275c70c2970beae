#include <tautline/analysis/relaxation.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <tautline/core/error.hpp>
#include <tautline/core/interrupt.hpp>
#include <tautline/la/session.hpp>

namespace tautline::analysis {

namespace {

constexpr int most_between_peaks = 200;  // then masses are renewed all the same
constexpr double longest_push = 0.02;    // over the structure's size, in the first step from rest
constexpr double safety = 1.2;           // over the least mass: the tangent changes between renewals

double share(double value, double reference) {
  return reference > 0 ? value / reference : (value > 0 ? 1 : 0);
}

/// A body in motion.
class Motion {
 public:
  Motion(PathProblem& problem, Workspace& workspace)
      : problem_(problem),
        workspace_(workspace),
        x_(problem.layout()),
        force_(problem.layout()),
        mass_(problem.layout()),
        velocity_(problem.layout()) {
    begin();
  }

  /// At rest where it is, with masses of the tangent there.
  void begin() {
    problem_.accept(x_);
    problem_.restart();
    x_.set_zero();
    velocity_.set_zero();
    energy_ = 0;
    since_ = 0;
    problem_.tangent(workspace_.tangent);
    mass_.write(masses());
    if (la::Vector taut(problem_.layout()); problem_.taut_stiffness(taut)) mass_.add(safety / 2, taut);
    problem_.residual(x_, force_);
    la::Vector push = la::Vector::like(force_);
    push.copy(force_);
    divide(push);
    if (const double leap = problem_.relative_size(push); leap > longest_push)  // soft here, stiff elsewhere
      mass_.scale(leap / longest_push);
  }

  /// One step. @return whether the kinetic energy has passed a peak
  bool advance() {
    la::Vector push = la::Vector::like(force_);
    push.copy(force_);
    divide(push);
    velocity_.add(-1, push);
    x_.add(1, velocity_);
    problem_.residual(x_, force_);
    la::Vector momentum = la::Vector::like(velocity_);
    momentum.copy(velocity_);
    momentum.multiply_entries(mass_);
    const double energy = momentum.dot(velocity_);
    const bool peak = energy < energy_ || !std::isfinite(energy);
    if (peak) x_.add(-1.5, velocity_);  // the peak lay some one and a half steps back
    energy_ = energy;
    return peak || ++since_ >= most_between_peaks;
  }

  double residual() const {
    const auto norms = problem_.norms(force_);
    const double left =
        std::max(share(norms.force, norms.reference_force), share(norms.moment, norms.reference_moment));
    return std::isfinite(force_.norm()) ? left : std::numeric_limits<double>::infinity();  // ran away
  }

 private:
  /// One mass for all directions of a block: what is soft across may turn into the stiff direction.
  std::vector<double> masses() const {
    auto sums = workspace_.tangent.absolute_row_sums_of_blocks();
    for (double& sum : sums) sum *= safety / 2;
    return sums;
  }
  void divide(la::Vector& v) const {
    std::vector<double> a(static_cast<std::size_t>(v.local_size())), m(a.size());
    v.read(a);
    mass_.read(m);
    for (std::size_t i = 0; i < a.size(); ++i) a[i] /= m[i];
    v.write(a);
  }

  PathProblem& problem_;
  Workspace& workspace_;
  la::Vector x_, force_, mass_, velocity_;
  double energy_ = 0;
  int since_ = 0;
};

}  // namespace

RelaxationSummary relax(PathProblem& problem, Workspace& workspace, const RelaxationOptions& options,
                        const std::function<void(int, double)>& callback) {
  RelaxationSummary summary;
  problem.restart();
  Motion motion(problem, workspace);
  for (; summary.steps < options.max_steps; ++summary.steps) {
    if (la::true_on_any_rank(interrupt_requested())) throw Interrupted();
    if (motion.advance()) {
      ++summary.peaks;
      motion.begin();
    }
    summary.residual = motion.residual();
    if (callback && summary.steps % 50 == 0) callback(summary.steps, summary.residual);
    if (summary.residual <= options.tolerance) break;
  }
  motion.begin();
  summary.residual = motion.residual();
  summary.settled = summary.residual <= 10 * options.tolerance;
  return summary;
}

}  // namespace tautline::analysis
