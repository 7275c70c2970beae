#include <tautline/rod/cantilever_model.hpp>

#include <algorithm>
#include <cmath>

#include <rod/cantilever.hpp>
#include <rod/newton.hpp>

namespace tautline::rod {

namespace {

constexpr double smallest_turn = 1e-4;  // of the root, as a part of its way to the stop

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
  for (int k = 0; k < m; ++k) {
    for (int i = k; i < m; ++i) shape.moment[k] += reactions[i] * (y_moment[i + 1] - y_moment[k]);
    shape.moment_of_links[k] += moment_at_start(rod, at, k) * (k == 0 ? 1 : 0.5);
    shape.moment_of_links[k + 1] += moment_at_end(rod, at, k) * (k == m - 1 ? 1 : 0.5);
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
Stability judge(const Rod& rod, const ShorteningCoefficients& c, const Motion<double>& at,
                const NodeForces& forces) {
  const int m = rod.links();
  VecX z(2 * m);
  z << at.v, at.t;
  const auto hessian = [&](const NodeForces& acting) -> MatX {
    const auto derivative = [&](const VecC& to) -> VecC {
      const auto motion = move<Complex>(rod, c, to.head(m), to.tail(m));
      return gradient<Complex>(rod, motion, acting.at<Complex>(motion.x.tail(m)));
    };
    const MatX jacobian = complex_step(derivative, z).jacobian;
    return (jacobian + jacobian.transpose()) / 2;  // symmetric but for rounding
  };
  return compare_forms(hessian(forces), hessian({forces.x, VecX::Zero(m), VecX::Zero(m)}));
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
                      options.tolerance, std::min(options.max_iterations, newton_iterations), z);
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

RodSolution make_solution(SolveSummary summary, const Rod& rod, const ShorteningCoefficients& c,
                          const Motion<double>& at, const VecX& reactions, const VecX& y_moment,
                          const VecX& slopes) {
  RodSolution solution{std::move(summary), make_shape(rod, at, reactions, y_moment), {}};
  if (solution.summary.converged())
    solution.stability = judge(rod, c, at, {solution.shape.x, reactions, slopes});
  return solution;
}

RodSolution load_cantilevers(const Rod& rod, const VecX& reactions, const VecX& start,
                             const CantileverOptions& options) {
  const int m = rod.links();
  const auto c = coefficients(options.shortening);
  const VecX t = rotations(rod, start);
  VecX z(2 * m);
  z << t / 2, t;
  SolveSummary summary = balance(
      rod, c, options, [&](const VecC&) -> VecC { return reactions.cast<Complex>(); }, z);
  const auto at = move<double>(rod, c, z.head(m), z.tail(m));
  return make_solution(std::move(summary), rod, c, at, reactions, at.y, VecX::Zero(m));
}

RodSolution turn_cantilevers(const Umbrella& umbrella, const VecX& stiffness,
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
  SolveSummary summary = follow_turning(stiffness, solve_at, smallest_turn, z);
  const auto at = move<double>(umbrella.rod, c, z.head(m), z.tail(m));
  VecX reactions(m), slopes(m);
  for (int k = 0; k < m; ++k) {
    const Force force = cables.reaction(k, at.x[k + 1]);
    reactions[k] = force.value;
    slopes[k] = force.slope;
  }
  return make_solution(std::move(summary), umbrella.rod, c, at, reactions, at.y, slopes);
}

}  // namespace tautline::rod
