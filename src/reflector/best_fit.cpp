#include <Eigen/Geometry>
#include <Eigen/QR>
#include <cmath>
#include <reflector/best_fit.hpp>

namespace tautline::reflector {

namespace {

constexpr int max_iterations = 200;
constexpr double orthogonal = 1e-9;  // part of the deviation that the motions could still take away
constexpr double rounding = 1e-14;   // of half the aperture
constexpr double null_direction =
    1e-9;                        // singular values below this part of the largest slide the surface in itself
constexpr int n_parameters = 7;  // displacement, rotation and change of curvature, each as a length [m]

/// A motion of the points, with the direction in which they are measured, and the surface
/// Z = curvature (X^2 + Y^2) of the parent frame.
struct Pose {
  Mat3 turn = Mat3::Identity();
  Vec3 shift = Vec3::Zero();
  double curvature = 0;  ///< 1/4F; zero is a plane [1/m]
};

/// Distance from the surface along `direction`, and its derivative with respect to the seven parameters. As
/// the direction turns with the points, sliding the surface in itself changes nothing at all.
struct Deviation {
  double value;
  Vec<n_parameters> slope;
};

Deviation evaluate(const Vec3& point, const Vec3& direction, const Vec3& centre, double curvature,
                   double lever) {
  // point + t direction on the surface: a t^2 + 2 b t + c = 0, the root that stays when it flattens.
  const double a = curvature * direction.head<2>().squaredNorm();
  const double b = curvature * point.head<2>().dot(direction.head<2>()) - direction.z() / 2;
  const double c = curvature * point.head<2>().squaredNorm() - point.z();
  const double t = c / (-b + std::sqrt(b * b - a * c));
  const Vec3 foot = point + t * direction;
  const Vec3 gradient(2 * curvature * foot.x(), 2 * curvature * foot.y(), -1);
  const double along = gradient.dot(direction);
  const Vec3 by_point = gradient / along;
  Deviation deviation{-t, {}};
  deviation.slope << by_point, (foot - centre).cross(by_point) / lever,
      foot.head<2>().squaredNorm() / (along * lever * lever);
  return deviation;
}

/// Least squares by rows: keeps only the triangle of the QR factorisation of all rows so far.
class RowReduction {
 public:
  void add(const Vec<n_parameters>& row, double right) {
    rows_.row(filled_) << row.transpose(), right;
    if (++filled_ == rows_.rows()) reduce();
  }
  void reduce() {
    const Eigen::HouseholderQR<MatX> qr(rows_.topRows(std::max(filled_, kept)));
    const MatX triangle = qr.matrixQR().topRows(kept).triangularView<Eigen::Upper>();
    rows_.setZero();
    rows_.topRows(kept) = triangle;
    filled_ = kept;
  }
  /// Solution of smallest norm. @pre reduced
  Vec<n_parameters> solve() const {
    Eigen::CompleteOrthogonalDecomposition<MatX> triangle;
    triangle.setThreshold(null_direction);
    triangle.compute(rows_.topLeftCorner(n_parameters, n_parameters));
    return triangle.solve(rows_.col(n_parameters).head(n_parameters));
  }
  /// Solution with damping^2 |x|^2 added to the sum of squares. @pre reduced
  Vec<n_parameters> solve_damped(double damping) const {
    MatX system = MatX::Zero(2 * n_parameters, n_parameters);
    system.topRows(n_parameters) = rows_.topLeftCorner(n_parameters, n_parameters);
    system.bottomRows(n_parameters).diagonal().setConstant(damping);
    VecX right = VecX::Zero(2 * n_parameters);
    right.head(n_parameters) = rows_.col(n_parameters).head(n_parameters);
    return Eigen::HouseholderQR<MatX>(system).solve(right);
  }
  /// By how much a step makes the linearised sum of squares smaller. @pre reduced
  double gain(const Vec<n_parameters>& x) const {
    const VecX change = rows_.topLeftCorner(n_parameters, n_parameters) * x;
    return change.dot(2 * rows_.col(n_parameters).head(n_parameters) - change);
  }
  double largest() const {
    return rows_.topLeftCorner(n_parameters, n_parameters).colwise().norm().maxCoeff();
  }

 private:
  static constexpr int kept = n_parameters + 1;
  MatX rows_ = MatX::Zero(256, kept);
  int filled_ = 0;
};

/// The sum of squares at a pose and its linearisation there.
struct Linearised {
  Pose pose;
  Vec3 centre;        ///< of rotations [m]
  double square = 0;  ///< mean by weight; not a number where a line misses the surface [m^2]
  RowReduction rows;
};

/// A weighted surface and what is looked for.
class Fit {
 public:
  Fit(const Paraboloid& surface, const std::vector<WeightedPoint>& points)
      : direction_(surface.to_parent(Vec3::UnitZ()) - surface.to_parent(Vec3::Zero())),
        lever_(surface.aperture() / 2) {
    for (const auto& [point, weight] : points) {
      points_.push_back({surface.to_parent(point), weight});
      middle_ += weight * points_.back().point;
      weights_ += weight;
    }
    middle_ /= weights_;
  }

  double lever() const { return lever_; }

  /// Unmoved but for the shift that takes the mean deviation away: never worse than the RMS about the mean.
  Pose start(double curvature) const {
    double mean = 0;
    for (const auto& [point, weight] : points_)
      mean += weight * evaluate(point, direction_, middle_, curvature, lever_).value / weights_;
    return {Mat3::Identity(), -mean * direction_, curvature};
  }

  /// Rotations about the centre of curvature over the middle of the surface: a dish is nearly a sphere, which
  /// they slide in itself, so that the valley of good fits is straight in them.
  Linearised linearise(const Pose& pose) const {
    Linearised result{pose, {}, 0, {}};
    const Vec3 direction = pose.turn * direction_, middle = pose.turn * middle_ + pose.shift;
    const double radius = 1 / std::max(2 * std::abs(pose.curvature), 0.01 / lever_);
    result.centre = middle + std::copysign(radius, pose.curvature) * direction;
    for (const auto& [point, weight] : points_) {
      const Deviation d =
          evaluate(pose.turn * point + pose.shift, direction, result.centre, pose.curvature, lever_);
      if (!std::isfinite(d.value)) {
        result.square = d.value;
        return result;
      }
      const double root = std::sqrt(weight / weights_);
      result.rows.add(root * d.slope, -root * d.value);
      result.square += root * root * d.value * d.value;
    }
    result.rows.reduce();
    return result;
  }

  Pose moved(const Linearised& from, const Vec<n_parameters>& change) const {
    const Vec3 rotation = change.segment<3>(3) / lever_;
    const Mat3 turn = Eigen::AngleAxisd(rotation.norm(), rotation.stableNormalized()).toRotationMatrix();
    return {turn * from.pose.turn, turn * (from.pose.shift - from.centre) + from.centre + change.head<3>(),
            from.pose.curvature + change[6] / (lever_ * lever_)};
  }

 private:
  std::vector<WeightedPoint> points_;
  Vec3 direction_, middle_ = Vec3::Zero();
  double lever_, weights_ = 0;
};

}  // namespace

BestFit fit_paraboloid(const Paraboloid& surface, const std::vector<WeightedPoint>& points) {
  const Fit fit(surface, points);
  Linearised now = fit.linearise(fit.start(1 / (4 * surface.focal_length())));
  double damping = 1e-3 * now.rows.largest(), growth = 2;
  bool converged = false;
  for (int iteration = 0; iteration < max_iterations && std::isfinite(now.square); ++iteration) {
    const double left = now.rows.gain(now.rows.solve());
    converged = left <= std::max(std::pow(orthogonal, 2) * now.square, std::pow(rounding * fit.lever(), 2));
    if (converged) break;
    const Vec<n_parameters> change = now.rows.solve_damped(damping);
    Linearised next = fit.linearise(fit.moved(now, change));
    const double agreement = (now.square - next.square) / now.rows.gain(change);
    if (next.square < now.square) {
      damping *= std::sqrt(std::max(1. / 9, 1 - std::pow(2 * agreement - 1, 3)));
      growth = 2;
      now = std::move(next);
    } else {
      damping *= growth;
      growth *= 2;
    }
  }
  return {std::sqrt(now.square), 1 / (4 * now.pose.curvature), converged};
}

}  // namespace tautline::reflector
