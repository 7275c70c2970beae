#include <tautline/rod/cantilever_model.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <fmt/format.h>

#include <rod/newton.hpp>

namespace tautline::rod {

namespace {

template <class T>
using Vector = Eigen::Matrix<T, Eigen::Dynamic, 1>;
template <class T>
using Matrix = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;

/// c1 and c2 of u/a = -(6/5 v^2 - c1 v t + c2 t^2) / 2.
struct ShorteningCoefficients {
  double mixed, rotation;
};

ShorteningCoefficients coefficients(Shortening shortening) {
  if (shortening == Shortening::as_published) return {1.0 / 10, 1.0 / 15};
  return {1.0 / 5, 2.0 / 15};
}

/// Where deflections v = v_k/a_k and rotations t = theta_k - theta_(k-1) take the rod, eqs (2.2), (2.4).
template <class T>
struct Motion {
  Vector<T> v, t;
  Vector<T> p, q, u;      ///< du/dv, du/dt and u, all by a_k
  Vector<T> angle, x, y;  ///< of nodes 0..m
};

template <class T>
Motion<T> move(const Rod& rod, const ShorteningCoefficients& c, const Vector<T>& v, const Vector<T>& t) {
  using std::cos, std::sin;
  const int m = rod.links();
  Motion<T> out{v, t, -(1.2 * v - c.mixed / 2 * t), -(c.rotation * t - c.mixed / 2 * v), {}, {}, {}, {}};
  out.u = (out.p.cwiseProduct(v) + out.q.cwiseProduct(t)) / 2.0;
  for (Vector<T>* nodal : {&out.angle, &out.x, &out.y}) nodal->resize(m + 1);
  out.angle[0] = rod.root.angle;
  out.x[0] = rod.root.x;
  out.y[0] = rod.root.y;
  for (int k = 0; k < m; ++k) {
    const T cosine = cos(out.angle[k]), sine = sin(out.angle[k]);
    out.x[k + 1] = out.x[k] + rod.lengths[k] * ((1.0 + out.u[k]) * cosine - v[k] * sine);
    out.y[k + 1] = out.y[k] + rod.lengths[k] * ((1.0 + out.u[k]) * sine + v[k] * cosine);
    out.angle[k + 1] = out.angle[k] + t[k];
  }
  return out;
}

/// A and B of eq. (2.11), for links of any lengths: what reactions do to v and t.
template <class T>
struct Influence {
  Matrix<T> a, b;
};

template <class T>
Influence<T> influence(const Rod& rod, const Motion<T>& at) {
  using std::cos, std::sin;
  const int m = rod.links();
  Influence<T> out{Matrix<T>::Zero(m, m), Matrix<T>::Zero(m, m)};
  for (int k = 0; k < m; ++k) {
    const T cosine = cos(at.angle[k]), sine = sin(at.angle[k]);
    T arm = 0;  // sum of (a_j / a_k) eta_j for k < j <= i
    for (int i = k; i < m; ++i) {
      if (i > k) arm -= (at.y[i + 1] - at.y[i]) / rod.lengths[k];
      out.a(k, i) = cosine * at.p[k] - sine;
      out.b(k, i) = cosine * at.q[k] + arm;
    }
  }
  return out;
}

/// EI_k / a_k^2, the diagonal of G [N].
VecX bending(const Rod& rod) {
  return rod.bending_stiffness.cwiseQuotient(rod.lengths.cwiseAbs2());
}

/// Derivatives of the energy by (v, t), eq. (2.9) times a_k [N m].
template <class T>
Vector<T> gradient(const Rod& rod, const Motion<T>& at, const Vector<T>& reactions) {
  const int m = rod.links();
  const Influence<T> by = influence(rod, at);
  const VecX g = 12 * bending(rod);
  Vector<T> out(2 * m);
  out.head(m) = g.cwiseProduct(at.v - 0.5 * at.t) + by.a * reactions;
  out.tail(m) = g.cwiseProduct(at.t / 3.0 - 0.5 * at.v) + by.b * reactions;
  return out.cwiseProduct(rod.lengths.replicate(2, 1).template cast<T>());
}

/// Forces at the nodes that change with their radii by `slopes`; the values are those at radii x.
struct NodeForces {
  VecX x, values, slopes;
  template <class T>
  Vector<T> at(const Vector<T>& radii) const {
    return values + slopes.cwiseProduct(radii - x);
  }
};

/// One step of eqs (3.1)-(3.3) from rotations t: v that puts the nodes on the target, reactions, next t.
template <class T>
struct InverseStep {
  Vector<T> v, reactions, next;
};

template <class T>
InverseStep<T> inverse_step(const Umbrella& umbrella, const ShorteningCoefficients& c, const Vector<T>& t) {
  using std::cos, std::sin;
  const Rod& rod = umbrella.rod;
  InverseStep<T> out{Vector<T>(rod.links()), {}, {}};
  T angle = rod.root.angle;
  double x = rod.root.x, y = rod.root.y;
  for (int k = 0; k < rod.links(); ++k) {
    const double dx = umbrella.target_x[k] - x, dy = umbrella.target_y[k] - y;
    out.v[k] = (dy * cos(angle) - dx * sin(angle)) / rod.lengths[k];
    angle += t[k];
    x += dx;
    y += dy;
  }
  const Influence<T> by = influence(rod, move(rod, c, out.v, t));
  const VecX g = bending(rod);
  const Matrix<T> system = by.a / 3.0 + by.b / 2.0;
  out.reactions = -system.partialPivLu().solve(g.cwiseProduct(out.v).eval());
  out.next = -((by.a / 2.0 + by.b) * out.reactions).cwiseQuotient(g.template cast<T>());
  return out;
}

VecX rotations(const Rod& rod, const VecX& angles) {
  VecX t = angles;
  for (int k = rod.links() - 1; k > 0; --k) t[k] -= t[k - 1];
  t[0] -= rod.root.angle;
  return t;
}

constexpr int newton_iterations = 50;

SolveSummary invert_by_newton(const Umbrella& umbrella, const ShorteningCoefficients& c,
                              const CantileverOptions& options, VecX& t) {
  const auto residual = [&](const VecC& z) -> VecC { return z - inverse_step<Complex>(umbrella, c, z).next; };
  return solve_newton([&](const VecX& at) { return complex_step(residual, at); }, VecX::Ones(t.size()),
                      options.tolerance, std::min(options.max_iterations, newton_iterations), t);
}

/// By what the increments shrank from one to the next over the last ten.
double contraction(const std::vector<double>& increments) {
  const int n = static_cast<int>(increments.size()), span = std::min(10, n - 1);
  return span < 1 ? 0 : std::pow(increments[n - 1] / increments[n - 1 - span], 1.0 / span);
}

/// The paper's iteration t <- G^-1 P(t). It is given up when it no longer contracts.
SolveSummary invert_successively(const Umbrella& umbrella, const ShorteningCoefficients& c,
                                 const CantileverOptions& options, VecX& t) {
  constexpr int patience = 40;                      // iterations before the rate is judged
  constexpr double too_far = 2 * std::numbers::pi;  // no rod winds up like that
  SolveSummary summary;
  const auto end = [&](SolveStatus status, std::string reason) {
    summary.status = status;
    summary.reason = std::move(reason);
    summary.total_iterations = summary.iterations();
    return summary;
  };
  while (summary.iterations() < options.max_iterations) {
    const VecX next = inverse_step<double>(umbrella, c, t).next;
    if (!next.allFinite())
      return end(SolveStatus::singular,
                 fmt::format("A/3 + B/2 has no inverse in iteration {}", summary.iterations() + 1));
    const double increment = (next - t).cwiseAbs().maxCoeff();
    summary.increments.push_back(increment);
    summary.contraction_rate = contraction(summary.increments);
    t = next;
    if (increment <= options.tolerance)
      return end(SolveStatus::converged,
                 fmt::format("increment {:.3g} <= {:.3g} after {} iterations, each {:.3f} of the one before",
                             increment, options.tolerance, summary.iterations(), summary.contraction_rate));
    if (increment > too_far || (summary.iterations() > patience && summary.contraction_rate >= 1))
      return end(
          SolveStatus::diverging,
          fmt::format(
              "successive approximation diverges: increment {:.3g} in iteration {}, each {:.3f} of the "
              "one before; Newton's method does not need it to contract",
              increment, summary.iterations(), summary.contraction_rate));
  }
  return end(SolveStatus::too_many_iterations,
             fmt::format("increment {:.3g} > {:.3g} after {} iterations",
                         summary.increments.empty() ? 0 : summary.increments.back(), options.tolerance,
                         options.max_iterations));
}

/// EI dtheta/ds at the ends of link k, 2 EI/a (3 v - t) and 2 EI/a (2 t - 3 v) [N m].
double moment_at_start(const Rod& rod, const Motion<double>& at, int k) {
  return 2 * rod.bending_stiffness[k] / rod.lengths[k] * (3 * at.v[k] - at.t[k]);
}
double moment_at_end(const Rod& rod, const Motion<double>& at, int k) {
  return 2 * rod.bending_stiffness[k] / rod.lengths[k] * (2 * at.t[k] - 3 * at.v[k]);
}

/// The cubic of a link at part r of its length. Between the ends it is shortened by the integral of v'^2,
/// plus what the coefficients in use leave out, spread evenly.
RodPoint point_of_link(const Rod& rod, const Motion<double>& at, int k, double r) {
  const double c1 = 6 * at.v[k] - 2 * at.t[k], c2 = 3 * at.t[k] - 6 * at.v[k];  // v' = c1 r + c2 r^2
  const auto shortening = [&](double to) {
    return -(c1 * c1 / 3 + to * (c1 * c2 / 2 + to * c2 * c2 / 5)) * to * to * to / 2;
  };
  const double along = r + shortening(r) + r * (at.u[k] - shortening(1));
  const double across = r * r * (c1 / 2 + r * c2 / 3), a = rod.lengths[k];
  const double cosine = std::cos(at.angle[k]), sine = std::sin(at.angle[k]);
  return {.s = a * r,
          .x = at.x[k] + a * (along * cosine - across * sine),
          .y = at.y[k] + a * (along * sine + across * cosine),
          .angle = at.angle[k] + r * (c1 + r * c2),
          .moment = rod.bending_stiffness[k] / a * (c1 + 2 * c2 * r)};
}

/// @param y_moment Y of nodes 0..m for the moments by equilibrium [m]
RodShape make_shape(const Rod& rod, const Motion<double>& at, const VecX& reactions, const VecX& y_moment) {
  const int m = rod.links();
  RodShape shape{rod,       at.x.tail(m),      at.y.tail(m),      at.angle.tail(m),
                 reactions, VecX::Zero(m + 1), VecX::Zero(m + 1), {}};
  for (int k = 0; k <= m; ++k) {
    for (int i = k; i < m; ++i) shape.moment[k] += reactions[i] * (y_moment[i + 1] - y_moment[k]);
    if (k == 0)
      shape.moment_of_links[k] = moment_at_start(rod, at, 0);
    else if (k == m)
      shape.moment_of_links[k] = moment_at_end(rod, at, m - 1);
    else
      shape.moment_of_links[k] = (moment_at_end(rod, at, k - 1) + moment_at_start(rod, at, k)) / 2;
  }
  double s = 0;
  for (int k = 0; k < m; s += rod.lengths[k++]) {
    for (int i = k == 0 ? 0 : 1; i <= intervals_per_link; ++i) {
      shape.curve.push_back(point_of_link(rod, at, k, static_cast<double>(i) / intervals_per_link));
      shape.curve.back().s += s;
    }
  }
  return shape;
}

/// The second derivative of the energy against that of the bending energy alone.
void judge_stability(const ShorteningCoefficients& c, const VecX& slopes, CantileverSolution& solution) {
  const Rod& rod = solution.shape.rod;
  const int m = rod.links();
  const auto hessian = [&](const NodeForces& forces) {
    const auto derivative = [&](const VecC& z) -> VecC {
      const auto at = move<Complex>(rod, c, z.head(m), z.tail(m));
      return gradient<Complex>(rod, at, forces.at<Complex>(at.x.tail(m)));
    };
    VecX z(2 * m);
    z << solution.deflection, solution.rotation;
    return complex_step(derivative, z).jacobian;
  };
  const VecX none = VecX::Zero(m);
  const MatX whole = hessian({solution.shape.x, solution.shape.reaction, slopes});
  const MatX bent = hessian({solution.shape.x, none, none});
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatX> modes(
      (whole + whole.transpose()) / 2, (bent + bent.transpose()) / 2, Eigen::EigenvaluesOnly);
  solution.unstable = static_cast<int>((modes.eigenvalues().array() < 0).count());
  solution.stability = modes.eigenvalues()[0];
}

/// The solution in motion `at`, judged with cables whose forces change by `slopes`.
CantileverSolution finish(SolveSummary summary, const Rod& rod, const Motion<double>& at,
                          const VecX& reactions, const VecX& y_moment, const VecX& slopes,
                          const ShorteningCoefficients& c) {
  CantileverSolution solution{std::move(summary), make_shape(rod, at, reactions, y_moment), at.v, at.t};
  if (solution.summary.converged()) judge_stability(c, slopes, solution);
  return solution;
}

/// Newton's method for eq. (2.9) under forces that follow from the radii.
template <class Forces>
SolveSummary balance(const Rod& rod, const ShorteningCoefficients& c, const CantileverOptions& options,
                     const Forces& forces, VecX& z) {
  const int m = rod.links();
  const auto residual = [&](const VecC& at) -> VecC {
    const auto motion = move<Complex>(rod, c, at.head(m), at.tail(m));
    const VecC radii = motion.x.tail(m);
    return gradient<Complex>(rod, motion, forces(radii));
  };
  return solve_newton([&](const VecX& at) { return complex_step(residual, at); }, VecX::Ones(2 * m),
                      options.tolerance, newton_iterations, z);
}

/// The cables' pull at complex radii: their law is piecewise linear, so its tangent continues it.
VecC pull(const Cables& cables, const VecC& radii) {
  VecC reactions(radii.size());
  for (int k = 0; k < radii.size(); ++k) {
    const Force force = cables.reaction(k, radii[k].real());
    reactions[k] = Complex(force.value, force.slope * radii[k].imag());
  }
  return reactions;
}

}  // namespace

CantileverSolution design_cantilevers(const Umbrella& umbrella, const CantileverOptions& options,
                                      const std::optional<VecX>& start) {
  const Rod& rod = umbrella.rod;
  const int m = rod.links();
  const auto c = coefficients(options.shortening);
  VecX t = rotations(rod, start.value_or(umbrella.target_angle));
  SolveSummary summary = options.method == CantileverMethod::newton
                             ? invert_by_newton(umbrella, c, options, t)
                             : invert_successively(umbrella, c, options, t);
  const auto found = inverse_step<double>(umbrella, c, t);
  const auto at = move<double>(rod, c, found.v, t);
  VecX target_y(m + 1);
  target_y << rod.root.y, umbrella.target_y;
  return finish(std::move(summary), rod, at, found.reactions, target_y,
                umbrella.cables.slopes(at.x.tail(m), found.reactions), c);
}

CantileverSolution load_cantilevers(const Rod& rod, const VecX& reactions, const VecX& start,
                                    const CantileverOptions& options) {
  const int m = rod.links();
  const auto c = coefficients(options.shortening);
  const VecX t = rotations(rod, start);
  VecX z(2 * m);
  z << t / 2, t;
  SolveSummary summary = balance(
      rod, c, options, [&](const VecC&) -> VecC { return reactions.cast<Complex>(); }, z);
  const auto at = move<double>(rod, c, z.head(m), z.tail(m));
  return finish(std::move(summary), rod, at, reactions, at.y, VecX::Zero(m), c);
}

CantileverSolution turn_cantilevers(const Umbrella& umbrella, const VecX& stiffness,
                                    const CantileverOptions& options) {
  const int m = umbrella.rod.links();
  const auto c = coefficients(options.shortening);
  Cables cables = umbrella.cables;
  cables.stiffness = stiffness;
  Rod rod = umbrella.rod;
  const auto solve_at = [&](double turn, VecX& z) {
    rod.root = umbrella.root_at(turn);
    return balance(
        rod, c, options, [&](const VecC& radii) { return pull(cables, radii); }, z);
  };
  VecX z = VecX::Zero(2 * m);
  SolveSummary summary = follow_turning(solve_at, 1e-4, z);
  const auto at = move<double>(umbrella.rod, c, z.head(m), z.tail(m));
  VecX reactions(m), slopes(m);
  for (int k = 0; k < m; ++k) {
    const Force force = cables.reaction(k, at.x[k + 1]);
    reactions[k] = force.value;
    slopes[k] = force.slope;
  }
  return finish(std::move(summary), umbrella.rod, at, reactions, at.y, slopes, c);
}

}  // namespace tautline::rod
