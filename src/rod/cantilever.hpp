#pragma once
/// @file
/// Mechanics of the paper's model, for real numbers and for complex ones (whose small imaginary parts carry
/// derivatives). Source: Russkikh & Shklyarchuk (2021), eqs (2.1)-(3.3), corrected; docs/theory/rod.md

#include <cmath>
#include <complex>

#include <Eigen/LU>

#include <tautline/rod/solution.hpp>
#include <tautline/rod/umbrella.hpp>

namespace tautline::rod {

inline constexpr int newton_iterations = 50;  // at most

template <class T>
using Vector = Eigen::Matrix<T, Eigen::Dynamic, 1>;
template <class T>
using Matrix = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;

/// c1 and c2 of u/a = -(6/5 v^2 - c1 v t + c2 t^2) / 2.
struct ShorteningCoefficients {
  double mixed, rotation;
};

inline ShorteningCoefficients coefficients(Shortening shortening) {
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
inline VecX bending(const Rod& rod) {
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

/// Rotations of the links with which the nodes have these angles [rad].
inline VecX rotations(const Rod& rod, const VecX& angles) {
  VecX t = angles;
  for (int k = rod.links() - 1; k > 0; --k) t[k] -= t[k - 1];
  t[0] -= rod.root.angle;
  return t;
}

/// @brief Shape and, if the solve converged, stability of a rod in motion `at`.
/// @param y_moment Y of nodes 0..m for the moments by equilibrium [m]
/// @param slopes dR_k/dX_k [N/m]
RodSolution make_solution(SolveSummary summary, const Rod& rod, const ShorteningCoefficients& c,
                          const Motion<double>& at, const VecX& reactions, const VecX& y_moment,
                          const VecX& slopes);

}  // namespace tautline::rod
