#include <formfinding/constraint_search.hpp>

#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>
#include <tautline/core/error.hpp>
#include <tautline/core/interrupt.hpp>
#include <utility>

namespace tautline::formfinding {

namespace {

constexpr double inner_tolerance = 1e-10;  // of the linear step: far below the quadratic error of Newton
constexpr int max_relaxations = 5;         // alpha = 1, 1/4, 1/64, 1/4096, 1/2^20
constexpr int worthwhile_relaxations = 2;  // alpha = 1, 1/4
constexpr int max_active_sets = 10;
/// A row's smallest reduction over one iteration that still counts as progress.
constexpr double progress = 1e-9;

}  // namespace

ConstraintSearch::Trial ConstraintSearch::evaluate(const VecX& force_density) {
  Trial trial;
  system_.factorise(force_density);
  trial.state = system_.equilibrium(force_density);
  trial.state.z_follows_surface = settings_.z_follows_surface;
  trial.rows = make_rows_(trial.state);
  trial.missing = trial.rows.missing();
  return trial;
}

VecX ConstraintSearch::within_bounds(VecX force_density) const {
  for (Eigen::Index b = 0; b < settings_.lower.size(); ++b)
    if (force_density[b] < settings_.lower[b]) force_density[b] = settings_.lower[b];
  for (Eigen::Index b = 0; b < settings_.upper.size(); ++b)
    if (force_density[b] > settings_.upper[b]) force_density[b] = settings_.upper[b];
  return force_density;
}

bool ConstraintSearch::take(const VecX& dq, double alpha) {
  try {
    Trial trial = evaluate(within_bounds(now_.state.force_density + alpha * dq));
    // Between a stable net and one with another number of unstable directions lies a singular one.
    if (!(trial.missing.norm() <= now_.missing.norm()) || system_.negative_pivots() != inertia_) return false;
    now_ = std::move(trial);
    relaxation_.push_back(alpha);
    return true;
  } catch (const ModelError&) {
    return false;  // the step led to a singular net or off the surface: too long
  }
}

bool ConstraintSearch::take_relaxed(const VecX& dq, int first, int last) {
  for (int i = first; i <= last; ++i)
    if (take(dq, std::ldexp(1.0, -i * (i - 1)))) return true;
  return false;
}

VecX ConstraintSearch::solve_step(const ConstraintJacobian& jacobian, double damping) {
  if (!settings_.dense) {
    const int max_inner = 2 * static_cast<int>(jacobian.rows() + jacobian.columns());
    last_ = least_squares(jacobian, now_.missing, inner_tolerance, max_inner, damping);
    inner_iterations_ += last_.iterations;
    return last_.x;
  }
  if (damping == 0) return Eigen::CompleteOrthogonalDecomposition<MatX>(jacobian.dense()).solve(now_.missing);
  MatX matrix(jacobian.rows() + jacobian.columns(), jacobian.columns());
  matrix << jacobian.dense(), damping * MatX::Identity(jacobian.columns(), jacobian.columns());
  VecX right = VecX::Zero(matrix.rows());
  right.head(jacobian.rows()) = now_.missing;
  return matrix.householderQr().solve(right);
}

VecX ConstraintSearch::step_within_bounds(ConstraintJacobian& jacobian, double damping) {
  // Branches at a bound that the step would leave are held, until no such branch is left. Each iteration of
  // Newton starts with all of them free again.
  std::vector<bool> held = settings_.held;
  held.resize(jacobian.columns(), false);
  VecX dq;
  for (int pass = 0; pass < max_active_sets; ++pass) {
    jacobian.hold(held);
    dq = solve_step(jacobian, damping);
    const VecX allowed = within_bounds(now_.state.force_density + dq) - now_.state.force_density;
    bool changed = false;
    for (Eigen::Index b = 0; b < dq.size(); ++b) {
      if (held[b] || dq[b] == 0 || allowed[b] != 0) continue;
      held[b] = changed = true;
    }
    if (!changed) break;
  }
  return dq;
}

bool ConstraintSearch::take_damped(ConstraintJacobian& jacobian) {
  const double size = jacobian.apply(jacobian.apply_transposed(now_.missing.normalized())).norm();
  for (double damping = 1e-4 * std::sqrt(size); damping < 1e4 * std::sqrt(size); damping *= 10) {
    system_.factorise(now_.state.force_density);  // a rejected step left another factor behind
    if (take(step_within_bounds(jacobian, damping), 1)) return true;
  }
  return false;
}

bool ConstraintSearch::take_step() {
  ConstraintJacobian G(system_, now_.state, now_.rows);
  const VecX dq = step_within_bounds(G, 0);
  if (take_relaxed(dq, 1, worthwhile_relaxations)) return true;
  // A step of which only a small part serves points along nearly singular directions, far away from the
  // start.
  if (take_damped(G)) return true;
  return take_relaxed(dq, worthwhile_relaxations + 1, max_relaxations);
}

ConstraintJacobian ConstraintSearch::jacobian() {
  system_.factorise(now_.state.force_density);
  return {system_, now_.state, now_.rows};
}

void ConstraintSearch::run(const VecX& start, const std::function<void()>& after_iteration) {
  now_ = evaluate(within_bounds(start));
  inertia_ = system_.negative_pivots();
  while (!met() && iterations_ < settings_.max_iterations) {
    if (interrupt_requested()) throw Interrupted();
    const double before = now_.missing.norm();
    stuck_ = !take_step();
    if (stuck_) break;
    ++iterations_;
    if (after_iteration) after_iteration();
    stuck_ = !met() && now_.missing.norm() > (1 - progress) * before;
    if (stuck_) break;
  }
}

bool ConstraintSearch::stationary(double limit) {
  ConstraintJacobian G = jacobian();
  std::vector<bool> held = settings_.held;
  held.resize(G.columns(), false);
  const VecX downhill = G.apply_transposed(now_.missing);
  const VecX& q = now_.state.force_density;
  for (Eigen::Index b = 0; b < q.size(); ++b) {
    const bool at_lower = b < settings_.lower.size() && q[b] <= settings_.lower[b];
    const bool at_upper = b < settings_.upper.size() && q[b] >= settings_.upper[b];
    if ((at_lower && downhill[b] < 0) || (at_upper && downhill[b] > 0)) held[b] = true;
  }
  G.hold(held);
  const VecX gradient = G.apply_transposed(now_.missing);
  const double size =
      G.apply_transposed(VecX::Random(G.rows()).normalized()).norm() * std::sqrt(double(G.rows()));
  return gradient.norm() <= limit * size * now_.missing.norm();
}

std::array<double, 2> ConstraintSearch::ritz_values() const {
  const auto k = static_cast<Eigen::Index>(std::min<std::size_t>(last_.alpha.size(), 500));
  if (k == 0) return {0, 0};
  MatX bidiagonal = MatX::Zero(k + 1, k);
  for (Eigen::Index i = 0; i < k; ++i) {
    bidiagonal(i, i) = last_.alpha[i];
    bidiagonal(i + 1, i) = last_.beta[i];
  }
  const VecX values = Eigen::BDCSVD<MatX>(bidiagonal).singularValues();
  return {values[k - 1], values[0]};
}

}  // namespace tautline::formfinding
