#include <tautline/formfinding/tolerance.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <formfinding/elastic_tangent.hpp>
#include <random>
#include <tautline/core/error.hpp>

namespace tautline::formfinding {

namespace {

/// The net linearised in equilibrium.
class Linearised {
 public:
  explicit Linearised(const ElasticNet& net)
      : net_(net), tangent_(net), vectors_(branch_vectors(net.net, to_coordinates(net.net.nodes))) {
    if (!net.film.empty() || !net.net.guides.empty())
      throw ModelError("the tolerance analysis knows neither films nor guides");
    if (!tangent_.factorise(to_coordinates(net.net.nodes), 0))
      throw ModelError("the tolerance analysis needs a stable net: its tangent is not positive definite");
    by_length_ = VecX::Zero(vectors_.rows());
    for (int b = 0; b < vectors_.rows(); ++b) {
      const double length = vectors_.row(b).norm();
      const BranchForce force = branch_force(net, b, length);
      vectors_.row(b) /= length;
      stiffness_.push_back(force.stiffness);
      if (is_elastic(net, b) && !force.slack)  // dT/dL0
        by_length_[b] = -net.axial_stiffness[b] * length / std::pow(net.unstressed_length[b], 2);
    }
  }

  LengthEffect effect(const VecX& error) const {
    Coordinates force = Coordinates::Zero(static_cast<Eigen::Index>(net_.net.nodes.size()), 3);
    LengthEffect result;
    result.tension = by_length_.cwiseProduct(error);
    for (int b = 0; b < vectors_.rows(); ++b) {
      force.row(net_.net.branches[b][0]) += result.tension[b] * vectors_.row(b);
      force.row(net_.net.branches[b][1]) -= result.tension[b] * vectors_.row(b);
    }
    const Coordinates moved = tangent_.solve(force(tangent_.free_nodes(), Eigen::all));
    result.displacement.assign(net_.net.nodes.size(), Vec3::Zero());
    for (int i = 0; i < tangent_.n_free(); ++i) result.displacement[tangent_.free_nodes()[i]] = moved.row(i);
    for (int b = 0; b < vectors_.rows(); ++b) {
      const auto [i, j] = net_.net.branches[b];
      result.tension[b] +=
          stiffness_[b] * vectors_.row(b).dot(result.displacement[j] - result.displacement[i]);
    }
    return result;
  }

 private:
  const ElasticNet& net_;
  ElasticTangent tangent_;
  Coordinates vectors_;  ///< unit vectors
  VecX by_length_;
  std::vector<double> stiffness_;
};

const ElasticNet& checked(const ElasticNet& net) {
  check(net);
  return net;
}

double mean_square(const LengthEffect& effect, const std::vector<Deviation1d>& deviations) {
  double sum = 0;
  for (const auto& [node, direction] : deviations)
    sum += std::pow(direction.dot(effect.displacement[node]), 2);
  return deviations.empty() ? 0 : sum / static_cast<double>(deviations.size());
}

void check_statistics(const ElasticNet& net, const VecX& sigma, const std::vector<Deviation1d>& deviations) {
  if (sigma.size() != static_cast<Eigen::Index>(net.net.branches.size()))
    throw ModelError(fmt::format("the net has {} branches, but {} standard deviations",
                                 net.net.branches.size(), sigma.size()));
  if (!(sigma.minCoeff() >= 0) || !(sigma.maxCoeff() > 0))
    throw ModelError(
        "standard deviations of unstressed lengths must not be negative, and some must be positive");
  for (const auto& deviation : deviations)
    if (deviation.node < 0 || deviation.node >= static_cast<int>(net.net.nodes.size()))
      throw ModelError(fmt::format("a deviation names node {}, but the net has {} nodes", deviation.node,
                                   net.net.nodes.size()));
}

}  // namespace

double ToleranceResult::rms_quantile(double p) const {
  const double at = std::clamp(p, 0.0, 1.0) * static_cast<double>(rms.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const std::size_t high = std::min(low + 1, rms.size() - 1);
  return rms[low] + (at - static_cast<double>(low)) * (rms[high] - rms[low]);
}

LengthEffect find_length_effect(const ElasticNet& net, const VecX& error) {
  if (error.size() != static_cast<Eigen::Index>(net.net.branches.size()))
    throw ModelError(fmt::format("the net has {} branches, but {} errors of length", net.net.branches.size(),
                                 error.size()));
  return Linearised(checked(net)).effect(error);
}

ToleranceResult analyse_tolerance(const ElasticNet& net, const VecX& sigma,
                                  const std::vector<Deviation1d>& deviations,
                                  const ToleranceOptions& options) {
  check_statistics(net, sigma, deviations);
  const Linearised linearised(checked(net));
  ToleranceResult result;
  result.tension_sigma = VecX::Zero(sigma.size());
  result.position_sigma.assign(net.net.nodes.size(), Vec3::Zero());
  for (Eigen::Index b = 0; b < sigma.size(); ++b) {
    if (sigma[b] == 0) continue;
    const LengthEffect effect = linearised.effect(sigma[b] * VecX::Unit(sigma.size(), b));
    result.tension_sigma += effect.tension.cwiseAbs2();
    for (std::size_t i = 0; i < effect.displacement.size(); ++i)
      result.position_sigma[i] += effect.displacement[i].cwiseAbs2();
    result.rms_expected += mean_square(effect, deviations);
  }
  result.tension_sigma = result.tension_sigma.cwiseSqrt();
  for (Vec3& variance : result.position_sigma) variance = variance.cwiseSqrt();
  result.rms_expected = std::sqrt(result.rms_expected);

  std::mt19937_64 random(options.seed);
  std::normal_distribution<double> normal;
  for (int sample = 0; sample < options.n_samples; ++sample) {
    VecX error = sigma;
    for (double& e : error) e *= normal(random);
    result.rms.push_back(std::sqrt(mean_square(linearised.effect(error), deviations)));
  }
  std::sort(result.rms.begin(), result.rms.end());
  return result;
}

double cut_length(double length, double tension, double axial_stiffness, double expansion,
                  double temperature_rise) {
  return length * axial_stiffness / (axial_stiffness + tension) / (1 + expansion * temperature_rise);
}

}  // namespace tautline::formfinding
