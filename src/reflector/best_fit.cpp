#include <Eigen/Geometry>
#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <reflector/best_fit.hpp>

namespace tautline::reflector {

namespace {

constexpr int max_iterations = 30;
constexpr double converged_step = 1e-12;  // of half the aperture
constexpr double null_direction =
    1e-9;  // singular values below this fraction of the largest slide the surface in itself
constexpr int n_parameters = 7;  // displacement, rotation times half the aperture, change of focal length [m]

/// Distance from the paraboloid of focal length f along `direction`, and its derivative with respect to the
/// seven parameters of a motion about `centre` that carries point and direction along. Everything in the
/// parent frame, where the surface is X^2 + Y^2 = 4 f Z. As the direction moves too, sliding the surface in
/// itself changes nothing at all.
struct Deviation {
  double value;
  Vec<n_parameters> slope;
};

Deviation evaluate(const Vec3& point, const Vec3& direction, const Vec3& centre, double f, double lever) {
  // point + t direction on the surface: a t^2 + 2 b t + c = 0, smaller root; the deviation is -t.
  const double a = direction.head<2>().squaredNorm();
  const double b = point.head<2>().dot(direction.head<2>()) - 2 * f * direction.z();
  const double c = point.head<2>().squaredNorm() - 4 * f * point.z();
  const double t = c / (-b + std::sqrt(b * b - a * c));
  const Vec3 foot = point + t * direction;
  const Vec3 gradient(2 * foot.x(), 2 * foot.y(), -4 * f);
  const Vec3 by_point = gradient / gradient.dot(direction);
  Deviation deviation{-t, {}};
  deviation.slope << by_point, (foot - centre).cross(by_point) / lever,
      -4 * foot.z() / gradient.dot(direction);
  return deviation;
}

/// Least squares by rows: keeps only the triangle of the QR factorisation of all rows so far.
class RowReduction {
 public:
  void add(const Vec<n_parameters>& row, double right) {
    rows_.row(filled_) << row.transpose(), right;
    if (++filled_ == rows_.rows()) reduce();
  }
  /// Solution of smallest norm.
  Vec<n_parameters> solve() {
    reduce();
    Eigen::CompleteOrthogonalDecomposition<MatX> triangle;
    triangle.setThreshold(null_direction);
    triangle.compute(rows_.topLeftCorner(n_parameters, n_parameters));
    return triangle.solve(rows_.col(n_parameters).head(n_parameters));
  }

 private:
  void reduce() {
    const Eigen::HouseholderQR<MatX> qr(rows_.topRows(std::max(filled_, kept)));
    const MatX triangle = qr.matrixQR().topRows(kept).triangularView<Eigen::Upper>();
    rows_.setZero();
    rows_.topRows(kept) = triangle;
    filled_ = kept;
  }

  static constexpr int kept = n_parameters + 1;
  MatX rows_ = MatX::Zero(256, kept);
  int filled_ = 0;
};

}  // namespace

BestFit fit_paraboloid(const Paraboloid& surface, const std::vector<WeightedPoint>& points) {
  Vec3 direction = surface.to_parent(Vec3::UnitZ()) - surface.to_parent(Vec3::Zero());
  const double lever = surface.aperture() / 2;
  std::vector<WeightedPoint> moved;
  Vec3 centre = Vec3::Zero();
  double weights = 0;
  for (const auto& [point, weight] : points) {
    moved.push_back({surface.to_parent(point), weight});
    centre += weight * moved.back().point;
    weights += weight;
  }
  centre /= weights;

  BestFit best{std::numeric_limits<double>::infinity(), surface.focal_length()};
  double focal_length = surface.focal_length();
  for (int iteration = 0;; ++iteration) {
    RowReduction reduction;
    double square = 0;
    for (const auto& [point, weight] : moved) {
      const Deviation d = evaluate(point, direction, centre, focal_length, lever);
      reduction.add(std::sqrt(weight) * d.slope, -std::sqrt(weight) * d.value);
      square += weight * d.value * d.value / weights;
    }
    if (!(std::sqrt(square) < best.rms))
      return best;  // at the minimum, or where Gauss-Newton leads no further
    best = {std::sqrt(square), focal_length};

    const Vec<n_parameters> change = reduction.solve();
    if (change.norm() <= converged_step * lever || iteration == max_iterations) return best;
    const Vec3 rotation = change.segment<3>(3) / lever;
    const Mat3 turn = Eigen::AngleAxisd(rotation.norm(), rotation.stableNormalized()).toRotationMatrix();
    direction = turn * direction;
    for (auto& [point, weight] : moved) point = centre + turn * (point - centre) + change.head<3>();
    focal_length += change[6];
  }
}

}  // namespace tautline::reflector
