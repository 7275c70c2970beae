#pragma once
/// @file
/// Minimal-norm least squares with a matrix known only by its products. Source: Paige & Saunders (1982), ACM
/// TOMS 8(1).

#include <cmath>
#include <tautline/core/types.hpp>

namespace tautline::formfinding {

/// @brief The x of smallest norm among those that minimise |A x - b|: x = A^+ b.
///
/// Started from zero, every iterate lies in the row space of A; the limit is the Moore-Penrose solution
/// whatever the rank.
/// @param[in] A  has apply(x), apply_transposed(y), columns()
/// @param[in] tolerance  stops when |A x - b| <= tolerance |b|, or |A^T (A x - b)| <= tolerance |A| |A x - b|
template <class Operator>
VecX least_squares(const Operator& A, const VecX& b, double tolerance, int max_iterations) {
  VecX x = VecX::Zero(A.columns());
  double beta = b.norm();
  if (beta == 0) return x;
  VecX u = b / beta;
  VecX v = A.apply_transposed(u);
  double alpha = v.norm();
  if (alpha == 0) return x;
  v /= alpha;
  VecX w = v;
  double rho_bar = alpha, residual = beta, norm_squared = alpha * alpha;
  for (int k = 0; k < max_iterations; ++k) {
    u = A.apply(v) - alpha * u;
    beta = u.norm();
    if (beta > 0) u /= beta;
    v = A.apply_transposed(u) - beta * v;
    alpha = v.norm();
    if (alpha > 0) v /= alpha;

    const double rho = std::hypot(rho_bar, beta);
    const double c = rho_bar / rho, s = beta / rho;
    x += (c * residual / rho) * w;
    w = v - (s * alpha / rho) * w;
    rho_bar = -c * alpha;
    residual *= s;
    norm_squared += beta * beta + alpha * alpha;
    const double gradient = alpha * std::abs(c);  // |A^T r| / |r|
    if (residual <= tolerance * b.norm() || gradient <= tolerance * std::sqrt(norm_squared)) break;
  }
  return x;
}

}  // namespace tautline::formfinding
