#pragma once
/// @file
/// Minimal-norm least squares with a matrix known only by its products. Source: Paige & Saunders (1982), ACM
/// TOMS 8(1).

#include <cmath>
#include <tautline/core/types.hpp>
#include <vector>

namespace tautline::formfinding {

struct LeastSquares {
  VecX x;
  int iterations = 0;
  std::vector<double> alpha, beta;  ///< of the bidiagonal matrix: diagonal, and below it
};

/// @brief The x of smallest norm among those that minimise |A x - b|^2 + damping^2 |x|^2; undamped x = A^+ b.
///
/// Started from zero, every iterate lies in the row space of A; the limit is the Moore-Penrose solution
/// whatever the rank.
/// @param[in] A  has apply(x), apply_transposed(y), columns()
/// @param[in] tolerance  stops when |A x - b| <= tolerance |b|, or |A^T (A x - b)| <= tolerance |A| |A x - b|
template <class Operator>
LeastSquares least_squares(const Operator& A, const VecX& b, double tolerance, int max_iterations,
                           double damping = 0) {
  LeastSquares result;
  VecX& x = result.x;
  x = VecX::Zero(A.columns());
  double beta = b.norm();
  if (beta == 0) return result;
  VecX u = b / beta;
  VecX v = A.apply_transposed(u);
  double alpha = v.norm();
  if (alpha == 0) return result;
  v /= alpha;
  VecX w = v;
  double rho_bar = alpha, phi_bar = beta, damped_squares = 0, norm_squared = alpha * alpha;
  for (int k = 0; k < max_iterations; ++k) {
    result.alpha.push_back(alpha);
    u = A.apply(v) - alpha * u;
    beta = u.norm();
    result.beta.push_back(beta);
    if (beta > 0) u /= beta;
    v = A.apply_transposed(u) - beta * v;
    alpha = v.norm();
    if (alpha > 0) v /= alpha;
    ++result.iterations;

    const double rho_damped = std::hypot(rho_bar, damping);
    const double psi = damping / rho_damped * phi_bar;
    damped_squares += psi * psi;
    phi_bar *= rho_bar / rho_damped;
    const double rho = std::hypot(rho_damped, beta);
    const double c = rho_damped / rho, s = beta / rho;
    x += (c * phi_bar / rho) * w;
    w = v - (s * alpha / rho) * w;
    rho_bar = -c * alpha;
    phi_bar *= s;
    norm_squared += beta * beta + alpha * alpha + damping * damping;
    const double residual = std::sqrt(phi_bar * phi_bar + damped_squares);
    const double gradient = alpha * std::abs(c * phi_bar);  // |A^T r - damping^2 x|
    if (residual <= tolerance * b.norm() || gradient <= tolerance * std::sqrt(norm_squared) * residual) break;
  }
  return result;
}

}  // namespace tautline::formfinding
