#include <tautline/reflector/tuning.hpp>

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Dense>
#include <Eigen/Sparse>

#include <tautline/core/error.hpp>

namespace tautline::reflector {

VecX rule_change(const Paraboloid& surface, const Points& front_positions) {
  VecX change(front_positions.size());
  for (std::size_t i = 0; i < front_positions.size(); ++i)
    change[static_cast<Eigen::Index>(i)] = -deviation(surface, front_positions[i]);
  return change;
}

namespace {

/// Weighted squares of the deviation as a quadratic form in nodal values: W (symmetric) and b = W d by
/// quadrature.
struct SurfaceForm {
  Eigen::SparseMatrix<double> weight;
  VecX load;
};

bool inside(const SurfaceSample& sample, const Vec3& point) {
  return !(sample.radius > 0) || point.head<2>().norm() <= sample.radius;
}

SurfaceForm nodal_form(const Paraboloid& surface, const SurfaceSample& sample,
                       const std::vector<int>& nodes) {
  const auto n = static_cast<Eigen::Index>(nodes.size());
  SurfaceForm form{Eigen::SparseMatrix<double>(n, n), VecX::Zero(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vec3& point = sample.positions[nodes[static_cast<std::size_t>(i)]];
    if (!inside(sample, point)) continue;
    form.weight.insert(i, i) = 1;
    form.load[i] = deviation(surface, point);
  }
  return form;
}

/// Consistent weights: facets integrated at the middles of their sides, of quarter facets near the rim of the
/// circle.
SurfaceForm area_form(const Paraboloid& surface, const SurfaceSample& sample, const std::vector<int>& nodes) {
  std::map<int, int> local;
  for (std::size_t i = 0; i < nodes.size(); ++i) local[nodes[i]] = static_cast<int>(i);
  const auto n = static_cast<Eigen::Index>(nodes.size());
  SurfaceForm form{Eigen::SparseMatrix<double>(n, n), VecX::Zero(n)};
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& triangle : sample.triangles) {
    Mat3 x;
    for (int k = 0; k < 3; ++k) x.col(k) = sample.positions[triangle[k]];
    const double area = 0.5 * (x.col(1) - x.col(0)).cross(x.col(2) - x.col(0)).norm();
    for (int q = 0; q < 3; ++q) {
      const Vec3 shape = q == 0 ? Vec3(0.5, 0.5, 0) : q == 1 ? Vec3(0, 0.5, 0.5) : Vec3(0.5, 0, 0.5);
      const Vec3 point = x * shape;
      if (!inside(sample, point)) continue;
      const double error = deviation(surface, point);
      for (int i = 0; i < 3; ++i) {
        form.load[local.at(triangle[i])] += area / 3 * shape[i] * error;
        for (int j = 0; j < 3; ++j)
          entries.emplace_back(local.at(triangle[i]), local.at(triangle[j]), area / 3 * shape[i] * shape[j]);
      }
    }
  }
  form.weight.setFromTriplets(entries.begin(), entries.end());
  return form;
}

/// Change of each node's deviation along z for a unit change of each length: u_z - slope . (u_x, u_y).
MatX deviation_influence(const Paraboloid& surface, const SurfaceSample& sample,
                         const TieInfluence& influence) {
  const auto n = static_cast<Eigen::Index>(influence.nodes.size());
  MatX result(n, influence.displacement.cols());
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vec3& p = sample.positions[influence.nodes[static_cast<std::size_t>(i)]];
    const Vec3 height = surface.height_and_slope(p.x(), p.y());
    result.row(i) = influence.displacement.row(3 * i + 2) - height[1] * influence.displacement.row(3 * i) -
                    height[2] * influence.displacement.row(3 * i + 1);
  }
  return result;
}

}  // namespace

VecX sensitivity_change(const Paraboloid& surface, const SurfaceSample& sample, const TieInfluence& influence,
                        const TuningOptions& options) {
  const SurfaceForm form = options.objective == TuningObjective::nodes
                               ? nodal_form(surface, sample, influence.nodes)
                               : area_form(surface, sample, influence.nodes);
  // In tie tensions t: length changes are S^-1 t and deviations d + J S^-1 t.
  const Eigen::PartialPivLU<MatX> lengths(influence.tension);
  const MatX to_lengths = lengths.inverse();
  const MatX j = deviation_influence(surface, sample, influence) * to_lengths;
  const MatX weighted = form.weight * j;
  // The mean shift is free: take the weighted mean out of the form.
  const VecX ones = form.weight * VecX::Ones(form.load.size());
  const VecX mean_row = j.transpose() * ones;
  MatX h = j.transpose() * weighted - mean_row * mean_row.transpose() / ones.sum();
  const VecX g = j.transpose() * form.load - mean_row * (form.load.sum() / ones.sum());
  // Ties the measured surface hardly feels keep their tension, and tension does not run up for little gain.
  h.diagonal().array() += options.regularisation * h.diagonal().mean();
  const VecX lower = (options.tension_min - influence.present_tension.array()).matrix();
  const VecX upper = (options.tension_max - influence.present_tension.array()).matrix();
  const VecX change = to_lengths * minimise_in_box(h, g, lower, upper);
  const double largest = change.cwiseAbs().maxCoeff();
  return largest > options.max_change ? VecX(change * (options.max_change / largest)) : change;
}

VecX minimise_in_box(const MatX& h, const VecX& g, const VecX& lower, const VecX& upper) {
  VecX x = VecX::Zero(g.size()).cwiseMax(lower).cwiseMin(upper);
  const auto value = [&](const VecX& at) { return 0.5 * at.dot(h * at) + g.dot(at); };
  const double tolerance = 1e-12 * (1 + g.cwiseAbs().maxCoeff());
  for (int iteration = 0; iteration < 200; ++iteration) {
    const VecX gradient = h * x + g;
    std::vector<int> free;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const bool stuck = (x[i] <= lower[i] && gradient[i] > 0) || (x[i] >= upper[i] && gradient[i] < 0);
      if (!stuck) free.push_back(static_cast<int>(i));
    }
    if (free.empty() || gradient(free).cwiseAbs().maxCoeff() <= tolerance) break;
    const VecX step = -h(free, free).ldlt().solve(gradient(free));
    double factor = 1;
    VecX next = x;
    do {
      next(free) = x(free) + factor * step;
      next = next.cwiseMax(lower).cwiseMin(upper);
      factor /= 2;
    } while (value(next) > value(x) && factor > 1e-10);
    const bool moved = (next - x).cwiseAbs().maxCoeff() > 0;
    x = next;
    if (!moved) break;
  }
  return x;
}

}  // namespace tautline::reflector
