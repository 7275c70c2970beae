#pragma once
/// @file
/// GMRES for a matrix known only by its products. Source: Saad & Schultz (1986), SIAM J. Sci. Stat.
/// Comput. 7.

#include <cmath>
#include <tautline/core/types.hpp>
#include <vector>

namespace tautline::formfinding {

struct KrylovResult {
  VecX x;
  int iterations = 0;
  double residual = 0;  ///< |b - A x|
};

/// x with |b - A x| <= tolerance |b|, or the best after `max_iterations` products; started from zero, no
/// restart.
template <class Product>
KrylovResult gmres(const Product& A, const VecX& b, double tolerance, int max_iterations) {
  KrylovResult result;
  result.x = VecX::Zero(b.size());
  result.residual = b.norm();
  if (result.residual == 0) return result;
  const double target = tolerance * result.residual;
  std::vector<VecX> basis{b / result.residual};
  MatX H = MatX::Zero(max_iterations + 1, max_iterations);
  VecX g = VecX::Zero(max_iterations + 1);
  std::vector<double> cosine, sine;
  g[0] = result.residual;
  int k = 0;
  while (k < max_iterations && result.residual > target) {
    VecX w = A(basis[k]);
    for (int i = 0; i <= k; ++i) {
      H(i, k) = basis[i].dot(w);
      w -= H(i, k) * basis[i];
    }
    const double next = w.norm();
    for (int i = 0; i < k; ++i) {
      const double upper = cosine[i] * H(i, k) + sine[i] * H(i + 1, k);
      H(i + 1, k) = -sine[i] * H(i, k) + cosine[i] * H(i + 1, k);
      H(i, k) = upper;
    }
    const double r = std::hypot(H(k, k), next);
    if (r == 0) break;
    cosine.push_back(H(k, k) / r);
    sine.push_back(next / r);
    H(k, k) = r;
    g[k + 1] = -sine[k] * g[k];
    g[k] *= cosine[k];
    result.residual = std::abs(g[++k]);
    if (next == 0) break;
    basis.push_back(w / next);
  }
  const VecX y = H.topLeftCorner(k, k).triangularView<Eigen::Upper>().solve(g.head(k));
  for (int i = 0; i < k; ++i) result.x += y[i] * basis[i];
  result.iterations = k;
  return result;
}

}  // namespace tautline::formfinding
