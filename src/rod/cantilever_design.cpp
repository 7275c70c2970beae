#include <tautline/rod/cantilever_model.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include <rod/cantilever.hpp>
#include <rod/newton.hpp>

namespace tautline::rod {

namespace {

/// t - G^-1 P(t) and its derivative, eq. (3.2).
Linearised residual(const Umbrella& umbrella, const ShorteningCoefficients& c, const VecX& t) {
  return complex_step([&](const VecC& z) -> VecC { return z - inverse_step<Complex>(umbrella, c, z).next; },
                      t);
}

SolveSummary invert_by_newton(const Umbrella& umbrella, const ShorteningCoefficients& c,
                              const CantileverOptions& options, VecX& t) {
  return solve_newton([&](const VecX& at) { return residual(umbrella, c, at); }, VecX::Ones(t.size()),
                      options.tolerance, std::min(options.max_iterations, newton_iterations), t);
}

/// Judges the increments of an iteration by the largest of a hundred and of the hundred before: the errors
/// may turn in the plane of a complex pair of eigenvalues, so that single increments rise and fall.
struct Trend {
  static constexpr int window = 100;
  bool known = false;
  double rate = 0;  ///< mean factor from one increment to the next

  explicit Trend(const std::vector<double>& increments) {
    const auto end = increments.end();
    if (increments.size() < 2 * window) return;
    known = true;
    rate = std::pow(*std::max_element(end - window, end) / *std::max_element(end - 2 * window, end - window),
                    1.0 / window);
  }
};

/// The paper's iteration t <- G^-1 P(t). It is given up when it no longer contracts.
SolveSummary invert_successively(const Umbrella& umbrella, const ShorteningCoefficients& c,
                                 const CantileverOptions& options, VecX& t) {
  constexpr double too_far = 2 * std::numbers::pi;  // no link bends like that
  SolveSummary summary;
  while (summary.iterations() < options.max_iterations) {
    const VecX next = inverse_step<double>(umbrella, c, t).next;
    const int iteration = summary.iterations() + 1;
    if (!next.allFinite())
      return ended(summary, SolveStatus::singular,
                   fmt::format("A/3 + B/2 has no inverse in iteration {}", iteration));
    const double increment = (next - t).cwiseAbs().maxCoeff();
    const double growth = summary.increments.empty() ? 0 : increment / summary.increments.back();
    summary.increments.push_back(increment);
    t = next;
    if (increment <= options.tolerance)
      return ended(summary, SolveStatus::converged,
                   fmt::format("increment {:.3g} <= {:.3g} after {} iterations", increment, options.tolerance,
                               iteration));
    const Trend trend(summary.increments);
    const bool is_far = increment > too_far;
    if (is_far || (iteration % Trend::window == 0 && trend.known && trend.rate >= 1)) {
      summary.contraction_rate = is_far ? growth : trend.rate;
      return ended(
          summary, SolveStatus::diverging,
          fmt::format("successive approximation diverges: an increment of {:.3g} rad in iteration {}, each "
                      "{:.4f} of the one before{}; Newton's method does not need it to contract",
                      increment, iteration, summary.contraction_rate,
                      is_far ? "" : fmt::format(" over the last {}", Trend::window)));
    }
  }
  return ended(summary, SolveStatus::too_many_iterations,
               fmt::format("increment {:.3g} > {:.3g} after {} iterations",
                           summary.increments.empty() ? 0 : summary.increments.back(), options.tolerance,
                           options.max_iterations));
}

/// Spectral radius of the derivative of t -> G^-1 P(t).
double contraction_rate(const Umbrella& umbrella, const ShorteningCoefficients& c, const VecX& t) {
  const MatX identity = MatX::Identity(t.size(), t.size());
  return (identity - residual(umbrella, c, t).jacobian).eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace

RodSolution design_cantilevers(const Umbrella& umbrella, const CantileverOptions& options,
                               const std::optional<VecX>& start) {
  const Rod& rod = umbrella.rod;
  const int m = rod.links();
  const auto c = coefficients(options.shortening);
  VecX t = rotations(rod, start.value_or(umbrella.target_angle));
  SolveSummary summary = options.method == CantileverMethod::newton
                             ? invert_by_newton(umbrella, c, options, t)
                             : invert_successively(umbrella, c, options, t);
  if (summary.converged()) summary.contraction_rate = contraction_rate(umbrella, c, t);
  const auto found = inverse_step<double>(umbrella, c, t);
  const auto at = move<double>(rod, c, found.v, t);
  VecX target_y(m + 1);
  target_y << rod.root.y, umbrella.target_y;
  const VecX slopes = umbrella.cables.slopes(at.x.tail(m), found.reactions);
  return make_solution(std::move(summary), rod, c, at, found.reactions, target_y, slopes);
}

}  // namespace tautline::rod
