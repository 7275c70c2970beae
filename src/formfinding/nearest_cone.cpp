#include <formfinding/nearest_cone.hpp>

#include <limits>
#include <vector>

#include <Eigen/QR>

namespace tautline::formfinding {

namespace {

/// Least squares with the columns of `passive` alone; the others are zero.
VecX solve_passive(const MatX& a, const VecX& b, const std::vector<bool>& passive) {
  std::vector<Eigen::Index> columns;
  for (Eigen::Index j = 0; j < a.cols(); ++j)
    if (passive[static_cast<std::size_t>(j)]) columns.push_back(j);
  MatX part(a.rows(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) part.col(static_cast<Eigen::Index>(k)) = a.col(columns[k]);
  const VecX values = part.colPivHouseholderQr().solve(b);
  VecX x = VecX::Zero(a.cols());
  for (std::size_t k = 0; k < columns.size(); ++k) x[columns[k]] = values[static_cast<Eigen::Index>(k)];
  return x;
}

}  // namespace

VecX nonnegative_least_squares(const MatX& a, const VecX& b) {
  const Eigen::Index n = a.cols();
  const double limit = 1e-12 * a.colwise().norm().maxCoeff() * b.norm();
  VecX x = VecX::Zero(n);
  std::vector<bool> passive(static_cast<std::size_t>(n), false);
  for (Eigen::Index round = 0; round < 3 * n; ++round) {
    const VecX slope = a.transpose() * (b - a * x);
    Eigen::Index best = -1;
    for (Eigen::Index j = 0; j < n; ++j)
      if (!passive[static_cast<std::size_t>(j)] && slope[j] > limit && (best < 0 || slope[j] > slope[best]))
        best = j;
    if (best < 0) return x;
    passive[static_cast<std::size_t>(best)] = true;
    for (Eigen::Index inner = 0; inner <= n; ++inner) {
      const VecX wanted = solve_passive(a, b, passive);
      double part = 1;
      for (Eigen::Index j = 0; j < n; ++j)
        if (passive[static_cast<std::size_t>(j)] && wanted[j] <= 0 && x[j] > wanted[j])
          part = std::min(part, x[j] / (x[j] - wanted[j]));
      x += part * (wanted - x);
      if (part >= 1) break;
      for (Eigen::Index j = 0; j < n; ++j)
        if (passive[static_cast<std::size_t>(j)] && x[j] <= 1e-15 * x.maxCoeff()) {
          passive[static_cast<std::size_t>(j)] = false;
          x[j] = 0;
        }
    }
  }
  return x;
}

std::optional<VecX> constrained_least_squares(const MatX& f, const VecX& g, const MatX& constraint,
                                              const VecX& h) {
  const Eigen::Index p = f.cols();
  const Eigen::HouseholderQR<MatX> qr(f);
  const MatX r = qr.matrixQR().topRows(p).triangularView<Eigen::Upper>();
  const VecX centre = (qr.householderQ().transpose() * g).head(p);
  // With z = R y - centre: the z of smallest length with C z >= d.
  const MatX inverse = r.triangularView<Eigen::Upper>().solve(MatX::Identity(p, p));
  const MatX c = constraint * inverse;
  const VecX d = h - c * centre;
  MatX a(p + 1, c.rows());
  a.topRows(p) = c.transpose();
  a.row(p) = d.transpose();
  const VecX b = VecX::Unit(p + 1, p);
  const VecX u = nonnegative_least_squares(a, b);
  const VecX rest = a * u - b;
  if (rest.norm() < 1e-9) return std::nullopt;
  const VecX z = -rest.head(p) / rest[p];
  return inverse * (z + centre);
}

}  // namespace tautline::formfinding
