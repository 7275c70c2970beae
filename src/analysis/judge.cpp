#include "analysis/judge.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/core/interrupt.hpp>
#include <tautline/la/session.hpp>

namespace tautline::analysis {

namespace {

constexpr double stagnation = 0.1;  // a residual that falls less than this is at its end

double ratio(double value, double reference) {
  if (value == 0) return 0;
  return reference > 0 ? value / reference : std::numeric_limits<double>::infinity();
}

}  // namespace

double relative_residual(const ResidualNorms& norms) {
  return std::max(ratio(norms.force, norms.reference_force), ratio(norms.moment, norms.reference_moment));
}

la::Verdict Judge::operator()(int iteration, const la::Vector& f, const la::Vector& increment) {
  if (la::true_on_any_rank(interrupt_requested())) throw Interrupted();
  NewtonIteration record{problem_.norms(f), iteration == 0 ? 0.0 : problem_.relative_size(increment), step};
  summary.iterations.push_back(record);
  const double residual = relative_residual(record.norms);
  if (callback_) callback_(iteration, residual);
  if (settled(record, residual, iteration)) return la::Verdict::converged;
  if (record.increment > 10) {
    summary.reason = fmt::format(
        "the increment is {:.2g} times the structure's size: the iteration runs away", record.increment);
    return la::Verdict::diverged;
  }
  if (iteration >= options_.max_iterations) {
    summary.status = NewtonStatus::too_many_iterations;
    summary.reason = fmt::format(
        "after {} iterations the out-of-balance is {:.2e} of the reference force, not below {:.0e}",
        iteration, residual, options_.force_tolerance);
    return la::Verdict::diverged;
  }
  return la::Verdict::go_on;
}

/// Forces in balance and, after the start, an increment that has died out; or an increment that has died
/// out with forces that fall no more, at the level that round-off of the stiffest element leaves, as where
/// a mechanism moves without force.
bool Judge::settled(const NewtonIteration& record, double residual, int iteration) {
  const bool balanced = residual <= options_.force_tolerance;
  const bool still = iteration > 0 && record.increment <= options_.increment_tolerance;
  const auto& norms = record.norms;
  const bool tiny = norms.force <= norms.rounding_force && norms.moment <= norms.rounding_moment &&
                    norms.force >= stagnation * last_force_ && norms.moment >= stagnation * last_moment_;
  last_force_ = norms.force;
  last_moment_ = norms.moment;
  const bool at_rounding =
      iteration > 0 && ((record.increment <= 1e-14 && residual <= 1e3 * options_.force_tolerance) ||
                        (record.increment <= 1e-9 && tiny));
  const bool at_rest = iteration == 0 && residual <= 1e-3 * options_.force_tolerance;
  if (!(balanced && still) && !at_rounding && !at_rest) return false;
  summary.status = NewtonStatus::converged;
  summary.reason = fmt::format(
      "out-of-balance {:.2e} of the reference force {:.3g} N <= {:.0e}, increment {:.2e} of the size",
      residual, record.norms.reference_force, options_.force_tolerance, record.increment);
  return true;
}

}  // namespace tautline::analysis
