#include <formfinding/equilibrium_matrix.hpp>

#include <algorithm>
#include <cmath>

#include <Eigen/OrderingMethods>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <Eigen/SparseQR>

namespace tautline::formfinding {

namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;

/// Directions in which a guided node may move.
MatX free_directions(const Guide& guide) {
  const Vec3 along = guide.direction.normalized();
  if (guide.kind == GuideKind::line) return along;
  MatX plane(3, 2);
  plane.col(0) = along.unitOrthogonal();
  plane.col(1) = along.cross(plane.col(0).head<3>());
  return plane;
}

MatX orthonormal(const MatX& columns) {
  if (columns.cols() == 0) return columns;
  const Eigen::HouseholderQR<MatX> qr(columns);
  return qr.householderQ() * MatX::Identity(columns.rows(), columns.cols());
}

template <class Svd>
NullSpaces by_singular_values(const MatX& a, double tolerance) {
  const Svd svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const VecX& values = svd.singularValues();
  NullSpaces result;
  Eigen::Index rank = 0;
  const double largest = values.size() > 0 ? values[0] : 0;
  while (rank < values.size() && values[rank] > tolerance * largest) ++rank;
  result.right = svd.matrixV().rightCols(a.cols() - rank);
  result.left = svd.matrixU().rightCols(a.rows() - rank);
  if (rank > 0) result.smallest = values[rank - 1] / largest;
  if (rank < values.size() && largest > 0) result.dropped = values[rank] / largest;
  return result;
}

NullSpaces dense(const Sparse& a, double tolerance) {
  constexpr Eigen::Index small = 60;
  const MatX whole(a);
  return std::max(a.rows(), a.cols()) <= small ? by_singular_values<Eigen::JacobiSVD<MatX>>(whole, tolerance)
                                               : by_singular_values<Eigen::BDCSVD<MatX>>(whole, tolerance);
}

VecX start_vector(Eigen::Index n) {
  VecX x(n);
  for (Eigen::Index i = 0; i < n; ++i) x[i] = 1 + 0.5 * std::sin(12.9898 * static_cast<double>(i + 1));
  return x.normalized();
}

double largest_singular_value(const Sparse& a) {
  VecX x = start_vector(a.cols());
  double value = 0;
  for (int i = 0; i < 30; ++i) {
    x = a.transpose() * (a * x);
    value = x.norm();
    if (!(value > 0)) return 0;
    x /= value;
  }
  return std::sqrt(value);
}

/// Of an upper triangular matrix, by inverse iteration.
double smallest_singular_value(const Sparse& triangle) {
  VecX x = start_vector(triangle.cols());
  double value = 0;
  for (int i = 0; i < 30; ++i) {
    const VecX y = triangle.transpose().triangularView<Eigen::Lower>().solve(x);
    x = triangle.triangularView<Eigen::Upper>().solve(y);
    value = x.norm();
    x /= value;
  }
  return 1 / std::sqrt(value);
}

}  // namespace

EquilibriumMatrix::EquilibriumMatrix(const Net& net)
    : net_(net), directions_(net.nodes.size(), MatX::Identity(3, 3)), first_(net.nodes.size(), 0) {
  for (const auto& guide : net.guides)
    directions_[static_cast<std::size_t>(guide.node)] = free_directions(guide);
  for (std::size_t i = 0; i < net.nodes.size(); ++i) {
    if (net.fixed[i]) directions_[i] = MatX(3, 0);
    first_[i] = equations_;
    equations_ += static_cast<int>(directions_[i].cols());
  }
  Triplets entries;
  for (std::size_t b = 0; b < net.branches.size(); ++b) {
    const auto& [i, j] = net.branches[b];
    const Vec3 along =
        (net.nodes[static_cast<std::size_t>(j)] - net.nodes[static_cast<std::size_t>(i)]).normalized();
    for (const auto& [node, sign] : {std::pair{i, 1.0}, std::pair{j, -1.0}}) {
      const auto at = static_cast<std::size_t>(node);
      const VecX parts = sign * directions_[at].transpose() * along;
      for (Eigen::Index k = 0; k < parts.size(); ++k)
        entries.emplace_back(first_[at] + static_cast<int>(k), static_cast<int>(b), parts[k]);
    }
  }
  matrix_.resize(equations_, static_cast<Eigen::Index>(net.branches.size()));
  matrix_.setFromTriplets(entries.begin(), entries.end());
  matrix_.makeCompressed();
}

Sparse EquilibriumMatrix::geometric(const VecX& force_density) const {
  Triplets entries;
  for (std::size_t b = 0; b < net_.branches.size(); ++b) {
    const auto& [i, j] = net_.branches[b];
    for (const auto& [n, m, sign] : {std::tuple{i, i, 1.0}, {j, j, 1.0}, {i, j, -1.0}, {j, i, -1.0}}) {
      const auto row = static_cast<std::size_t>(n), column = static_cast<std::size_t>(m);
      const MatX part = sign * force_density[static_cast<Eigen::Index>(b)] * directions_[row].transpose() *
                        directions_[column];
      for (Eigen::Index r = 0; r < part.rows(); ++r)
        for (Eigen::Index c = 0; c < part.cols(); ++c)
          entries.emplace_back(first_[row] + static_cast<int>(r), first_[column] + static_cast<int>(c),
                               part(r, c));
    }
  }
  Sparse result(equations_, equations_);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

Points EquilibriumMatrix::displacements(const VecX& x) const {
  Points result(net_.nodes.size(), Vec3::Zero());
  for (std::size_t i = 0; i < result.size(); ++i)
    if (directions_[i].cols() > 0) result[i] = directions_[i] * x.segment(first_[i], directions_[i].cols());
  return result;
}

MatX EquilibriumMatrix::rigid_motions() const {
  constexpr double nothing = 1e-9;  // of a unit motion
  Vec3 centre = Vec3::Zero();
  for (const Vec3& node : net_.nodes) centre += node / static_cast<double>(net_.nodes.size());
  double size = 0;
  for (const Vec3& node : net_.nodes) size = std::max(size, (node - centre).norm());
  MatX motion(equations_, 6), missed(3 * static_cast<Eigen::Index>(net_.nodes.size()), 6);
  for (std::size_t i = 0; i < net_.nodes.size(); ++i) {
    Mat<3, 6> unit;
    for (int k = 0; k < 3; ++k) {
      unit.col(k) = Vec3::Unit(k);
      unit.col(3 + k) = Vec3::Unit(k).cross(net_.nodes[i] - centre) / (size > 0 ? size : 1);
    }
    const MatX free = directions_[i].transpose() * unit;
    motion.middleRows(first_[i], free.rows()) = free;
    missed.middleRows<3>(3 * static_cast<Eigen::Index>(i)) = unit - directions_[i] * free;
  }
  const Eigen::JacobiSVD<Mat<6>> left((missed.transpose() * missed).eval(), Eigen::ComputeFullV);
  int held = 0;
  while (held < 6 && left.singularValues()[held] > nothing) ++held;
  const MatX allowed = motion * left.matrixV().rightCols(6 - held);
  if (allowed.cols() == 0 || equations_ == 0) return MatX(equations_, 0);
  const Eigen::JacobiSVD<MatX> svd(allowed, Eigen::ComputeThinU);
  Eigen::Index count = 0;
  while (count < svd.singularValues().size() && svd.singularValues()[count] > nothing) ++count;
  return svd.matrixU().leftCols(count);
}

NullSpaces null_spaces(const Sparse& a, double tolerance, int dense_limit) {
  constexpr Eigen::Index never_dense = 3000;
  const Eigen::Index m = a.rows(), n = a.cols(), most = std::max(m, n);
  if (m == 0 || n == 0) return {MatX::Identity(n, n), MatX::Identity(m, m)};
  if (most <= dense_limit) return dense(a, tolerance);
  const double largest = largest_singular_value(a);
  Eigen::SparseQR<Sparse, Eigen::COLAMDOrdering<int>> qr;
  qr.setPivotThreshold(tolerance * largest);
  qr.compute(a);
  const Eigen::Index rank = qr.rank();
  const Sparse r = qr.matrixR();
  const Sparse triangle = r.topLeftCorner(rank, rank);
  NullSpaces result;
  result.smallest = smallest_singular_value(triangle) / largest;
  if (!(result.smallest > tolerance) && most <= never_dense) return dense(a, tolerance);
  MatX basis(n, n - rank);
  const Sparse rest = r.topRightCorner(rank, n - rank);
  basis.topRows(rank) = -triangle.triangularView<Eigen::Upper>().solve(MatX(rest));
  basis.bottomRows(n - rank).setIdentity();
  result.right = orthonormal(qr.colsPermutation() * basis);
  if (n > rank) result.dropped = (a * result.right).colwise().norm().maxCoeff() / largest;
  MatX last = MatX::Zero(m, m - rank);
  last.bottomRows(m - rank).setIdentity();
  result.left = qr.matrixQ() * last;
  return result;
}

}  // namespace tautline::formfinding
