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

/// Consistent weights of a straight part without cloth, by Simpson's rule, of half parts near the rim of the
/// circle.
void add_line_form(const Paraboloid& surface, const SurfaceSample& sample, const std::array<int, 2>& line,
                   const std::map<int, int>& local, SurfaceForm& form,
                   std::vector<Eigen::Triplet<double>>& entries) {
  const Vec3 &a = sample.positions[line[0]], &b = sample.positions[line[1]];
  for (const auto& [place, weight] : {std::pair{0.0, 1. / 6}, {0.5, 4. / 6}, {1.0, 1. / 6}}) {
    const Vec3 point = (1 - place) * a + place * b;
    if (!inside(sample, point)) continue;
    const double share[2] = {1 - place, place}, part = weight * (b - a).norm();
    for (int i = 0; i < 2; ++i) {
      form.load[local.at(line[i])] += part * share[i] * deviation(surface, point);
      for (int j = 0; j < 2; ++j)
        entries.emplace_back(local.at(line[i]), local.at(line[j]), part * share[i] * share[j]);
    }
  }
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
  for (const auto& line : sample.lines) add_line_form(surface, sample, line, local, form, entries);
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

/// Changes of length for changes of tension.
struct TensionInverse {
  MatX to_lengths;
  /// Takes from a vector of tensions the part that no change of length makes; empty if there is none.
  MatX unreachable;
};

/// Cords whose tensions obey equations of equilibrium among themselves, as those that alone hold a part of
/// the frame, cannot have all tensions: their matrix is singular and the least changes of length are taken.
TensionInverse invert(const MatX& tension) {
  constexpr double singular = 1e-9;
  const Eigen::PartialPivLU<MatX> lengths(tension);
  if (lengths.rcond() > singular) return {lengths.inverse(), {}};
  const Eigen::BDCSVD<MatX> parts(tension, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const VecX& values = parts.singularValues();
  const auto rank = (values.array() > singular * values[0]).count();
  const MatX reached = parts.matrixU().leftCols(rank);
  return {
      parts.matrixV().leftCols(rank) * values.head(rank).cwiseInverse().asDiagonal() * reached.transpose(),
      MatX::Identity(tension.rows(), tension.cols()) - reached * reached.transpose()};
}

/// x^T h x / 2 + g^T x
struct QuadraticForm {
  MatX h;
  VecX g;
};

/// The surface error for deviations d + j x. The mean shift is free: the weighted mean is taken out of the
/// form.
QuadraticForm about_the_mean(const SurfaceForm& form, const MatX& j) {
  const MatX weighted = form.weight * j;
  const VecX ones = form.weight * VecX::Ones(form.load.size());
  const VecX mean_row = j.transpose() * ones;
  return {j.transpose() * weighted - mean_row * mean_row.transpose() / ones.sum(),
          j.transpose() * form.load - mean_row * (form.load.sum() / ones.sum())};
}

/// Changes of length for the least error and `weight` times the squares of the tensions' changes, without
/// bounds. Where a length hardly changes any tension this is far less sensitive to rounding than to go by the
/// tensions.
VecX least_change(QuadraticForm in_lengths, const MatX& tension, double weight) {
  in_lengths.h += weight * tension.transpose() * tension;
  return -in_lengths.h.ldlt().solve(in_lengths.g);
}

/// To three digits in units of `scale`: a weight that rounding, which the inverse of the influence enlarges,
/// does not touch, nor the units of the deck.
double rounded(double value, double scale) {
  if (!(value > 0) || !(scale > 0)) return value;
  const double unit = scale * std::pow(10.0, std::floor(std::log10(value / scale)) - 2);
  return unit * std::round(value / unit);
}

}  // namespace

VecX sensitivity_change(const Paraboloid& surface, const SurfaceSample& sample, const TieInfluence& influence,
                        const TuningOptions& options) {
  const SurfaceForm form = options.objective == TuningObjective::nodes
                               ? nodal_form(surface, sample, influence.nodes)
                               : area_form(surface, sample, influence.nodes);
  const MatX j = deviation_influence(surface, sample, influence);
  // In tie tensions t: length changes are S^-1 t and deviations d + J S^-1 t.
  const TensionInverse inverse = invert(influence.tension);
  QuadraticForm in_tensions = about_the_mean(form, j * inverse.to_lengths);
  // Ties the measured surface hardly feels keep their tension, and tension does not run up for little gain.
  const QuadraticForm in_lengths = about_the_mean(form, j);
  const double mean_influence =
      rounded(in_tensions.h.diagonal().mean(), in_lengths.h.trace() / influence.tension.squaredNorm());
  const double weight = options.regularisation * mean_influence;
  const VecX lower = (options.tension_min - influence.present_tension.array()).matrix();
  const VecX upper = (options.tension_max - influence.present_tension.array()).matrix();
  const bool regular = inverse.unreachable.size() == 0;
  VecX change = least_change(in_lengths, influence.tension, weight);
  if (const VecX t = influence.tension * change;
      !regular || !t.allFinite() || (t.array() < lower.array()).any() || (t.array() > upper.array()).any()) {
    in_tensions.h.diagonal().array() += weight;
    if (!regular) in_tensions.h += mean_influence * inverse.unreachable;
    change = inverse.to_lengths * minimise_in_box(in_tensions.h, in_tensions.g, lower, upper);
  }
  const double largest = change.cwiseAbs().maxCoeff();
  return largest > options.max_change ? VecX(change * (options.max_change / largest)) : change;
}

namespace {

/// Primal active-set method from a feasible point: the free components go to their minimum or to the first
/// bound in the way, which then holds; at the minimum the bound that the gradient leaves most is let go. Each
/// set of held components comes once, so that it ends.
void settle_in_box(const MatX& h, const VecX& g, const VecX& lower, const VecX& upper, VecX& x) {
  const Eigen::Index n = g.size();
  const double tolerance = 1e-12 * g.cwiseAbs().maxCoeff();
  std::vector<bool> held(static_cast<std::size_t>(n));
  const auto leaves = [&](Eigen::Index i, double slope) {  // how much the gradient points into the box
    return x[i] <= lower[i] ? -slope : slope;
  };
  VecX gradient = h * x + g;
  for (Eigen::Index i = 0; i < n; ++i)
    held[i] = (x[i] <= lower[i] || x[i] >= upper[i]) && leaves(i, gradient[i]) <= 0;
  for (Eigen::Index iteration = 0; iteration < 10 * n; ++iteration) {
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0; i < n; ++i)
      if (!held[i]) free.push_back(i);
    const VecX step = -h(free, free).ldlt().solve(gradient(free));
    double part = 1;
    Eigen::Index stop = -1;
    for (std::size_t k = 0; k < free.size(); ++k) {
      const Eigen::Index i = free[k];
      const double room = (step[k] < 0 ? lower[i] : upper[i]) - x[i];
      if (step[k] == 0 || room / step[k] >= part) continue;
      part = std::max(0.0, room / step[k]);
      stop = i;
    }
    x(free) += part * step;
    if (stop >= 0)
      x[stop] =
          step[std::find(free.begin(), free.end(), stop) - free.begin()] < 0 ? lower[stop] : upper[stop];
    gradient = h * x + g;
    if (stop >= 0) {
      held[stop] = true;
      continue;
    }
    double most = tolerance;
    Eigen::Index let_go = -1;
    for (Eigen::Index i = 0; i < n; ++i)
      if (held[i] && leaves(i, gradient[i]) > most) {
        most = leaves(i, gradient[i]);
        let_go = i;
      }
    if (let_go < 0) return;
    held[let_go] = false;
  }
}

}  // namespace

VecX minimise_in_box(const MatX& h, const VecX& g, const VecX& lower, const VecX& upper) {
  VecX x = VecX::Zero(g.size()).cwiseMax(lower).cwiseMin(upper);
  const auto value = [&](const VecX& at) { return 0.5 * at.dot(h * at) + g.dot(at); };
  const double tolerance = 1e-12 * g.cwiseAbs().maxCoeff();
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
  settle_in_box(h, g, lower, upper, x);
  return x;
}

}  // namespace tautline::reflector
