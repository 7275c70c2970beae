#include <gtest/gtest.h>

#include <cmath>
#include <formfinding/elastic_nets.hpp>
#include <limits>
#include <random>
#include <tautline/formfinding/force_density.hpp>
#include <tautline/formfinding/tolerance.hpp>

namespace tautline::formfinding {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A triangular net of 10 N in equilibrium under loads, cut of cables of EA = 20 kN.
ElasticNet cut_net(int rings) {
  ElasticNet elastic;
  Net& net = elastic.net;
  net = triangular_net(rings, 0.5, Dish(6));
  net.load.assign(net.nodes.size(), Vec3(0, 0, -0.5));
  const ForceDensityResult form = find_tensions(net, VecX::Constant(net.branches.size(), 10), nullptr, {});
  EXPECT_TRUE(form.converged);
  net.nodes = form.nodes;
  elastic.axial_stiffness = VecX::Constant(net.branches.size(), 20e3);
  elastic.unstressed_length.resize(net.branches.size());
  for (Eigen::Index b = 0; b < form.tension.size(); ++b)
    elastic.unstressed_length[b] = cut_length(form.tension[b] / form.force_density[b], form.tension[b], 20e3);
  return elastic;
}

double rms_z(const Points& a, const Points& b, const std::vector<Deviation1d>& deviations) {
  double sum = 0;
  for (const auto& [node, direction] : deviations) sum += std::pow(direction.dot(a[node] - b[node]), 2);
  return std::sqrt(sum / static_cast<double>(deviations.size()));
}

std::vector<Deviation1d> free_heights(const Net& net) {
  std::vector<Deviation1d> deviations;
  for (std::size_t i = 0; i < net.nodes.size(); ++i)
    if (!net.fixed[i]) deviations.push_back({static_cast<int>(i), Vec3::UnitZ()});
  return deviations;
}

TEST(Tolerance, CutLengthOfAStressedAndHeatedCable) {
  EXPECT_NEAR(cut_length(2.5, 5, 1000), 2.5 / 1.005, 1e-15);
  EXPECT_NEAR(cut_length(1.002 * 1.001, 20, 20e3, 2e-5, 100), 1, 1e-15);
}

TEST(Tolerance, FormedNetIsInEquilibriumWithItsCutLengths) {
  ElasticNet net = cut_net(3);
  const ElasticResult result = find_elastic_equilibrium(net);
  EXPECT_LE(result.residual.front(), 1e-7);
  EXPECT_LE((result.tension.array() - 10).abs().maxCoeff(), 1e-6);
}

TEST(Tolerance, EffectOfOneErrorIsTheDerivativeOfTheEquilibrium) {
  ElasticNet net = cut_net(3);
  const int b = 17;
  const double h = 1e-6;
  const VecX error = VecX::Unit(static_cast<Eigen::Index>(net.net.branches.size()), b);
  const LengthEffect effect = find_length_effect(net, error);
  ElasticOptions options;
  options.tolerance = 1e-13;
  ElasticNet longer = net, shorter = net;
  longer.unstressed_length += h * error;
  shorter.unstressed_length -= h * error;
  const ElasticResult more = find_elastic_equilibrium(longer, options),
                      less = find_elastic_equilibrium(shorter, options);
  const VecX slope = (more.tension - less.tension) / (2 * h);
  EXPECT_LE((effect.tension - slope).norm(), 1e-4 * slope.norm());
  for (std::size_t i = 0; i < net.net.nodes.size(); ++i)
    EXPECT_LE((effect.displacement[i] - (more.nodes[i] - less.nodes[i]) / (2 * h)).norm(), 1e-4) << i;
}

TEST(Tolerance, StraightCableOfEqualPieces) {
  // T = EA (L / sum L0 - 1): n independent errors of sigma change it by EA L / (n L0)^2 sqrt(n) sigma.
  const int n = 5;
  ElasticNet net;
  net.net = chain(n, {0, 0, 0}, {10, 0, 0});
  net.axial_stiffness = VecX::Constant(n, 1e4);
  net.unstressed_length = VecX::Constant(n, 1.99);
  ToleranceOptions options;
  options.n_samples = 0;
  const ToleranceResult result = analyse_tolerance(net, VecX::Constant(n, 1e-4), {}, options);
  const double expected = 1e4 * 10 / std::pow(n * 1.99, 2) * std::sqrt(5.0) * 1e-4;
  for (const double sigma : result.tension_sigma) EXPECT_NEAR(sigma, expected, 1e-10);
  EXPECT_LE(result.position_sigma[2].tail<2>().norm(), 1e-15);
}

TEST(Tolerance, LengthsOfCablesThatAreNotElasticHaveNoEffect) {
  // A node between two cables along x: the left one elastic, the right one of a tension, then of a force
  // density, each 10 N at a length of 2 m. Across, the node is held by both tensions.
  ElasticNet net;
  net.net = star({{-2, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, -1, 0}});
  net.axial_stiffness = VecX::Constant(4, 1e4);
  net.unstressed_length = Eigen::Vector4d(2 / 1.001, 2 / 1.001, 0.99, 0.99);
  const double k = 1e4 / (2 / 1.001), across = 2 * (1e4 * (1 / 0.99 - 1));  // EA / L0; T / L of two
  for (const bool density : {false, true}) {
    (density ? net.force_density : net.tension) = Eigen::Vector4d(nan, density ? 5 : 10, nan, nan);
    (density ? net.tension : net.force_density) = {};
    const LengthEffect none = find_length_effect(net, Eigen::Vector4d(0, 1e-3, 0, 0));
    EXPECT_EQ(none.displacement[0].norm(), 0);
    EXPECT_EQ(none.tension.norm(), 0);
    // dT/dL0 = -EA L / L0^2 at the left: the node goes by that over the stiffness along x.
    const LengthEffect left = find_length_effect(net, Eigen::Vector4d(1e-3, 0, 0, 0));
    const double lost = 1e4 * 2 / std::pow(2 / 1.001, 2) * 1e-3;
    EXPECT_NEAR(left.displacement[0].x(), lost / (k + across + (density ? 5 : 0)), 1e-12);
  }
}

TEST(Tolerance, RmsOfRandomNetsIsThatOfFullSolves) {
  const ElasticNet net = cut_net(4);
  const auto deviations = free_heights(net.net);
  const double sigma = 2e-5;
  const VecX sigmas = VecX::Constant(static_cast<Eigen::Index>(net.net.branches.size()), sigma);
  const ToleranceResult result = analyse_tolerance(net, sigmas, deviations);
  ASSERT_EQ(result.rms.size(), 1000u);
  double mean_square = 0;
  for (const double rms : result.rms) mean_square += rms * rms / 1000;
  EXPECT_NEAR(std::sqrt(mean_square), result.rms_expected, 0.05 * result.rms_expected);
  EXPECT_LT(result.rms_quantile(0.1), result.rms_quantile(0.9));

  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 3; ++k) {
    ElasticNet wrong = net;
    VecX error(sigmas.size());
    for (double& e : error) e = sigma * normal(random);
    wrong.unstressed_length += error;
    const ElasticResult full = find_elastic_equilibrium(wrong);
    ASSERT_TRUE(full.converged) << full.reason;
    const LengthEffect effect = find_length_effect(net, error);
    Points linear = net.net.nodes;
    for (std::size_t i = 0; i < linear.size(); ++i) linear[i] += effect.displacement[i];
    const double full_rms = rms_z(full.nodes, net.net.nodes, deviations);
    EXPECT_NEAR(rms_z(linear, net.net.nodes, deviations), full_rms, 0.05 * full_rms);
    EXPECT_LE((full.tension.array() - 10 - effect.tension.array()).matrix().norm(),
              0.1 * effect.tension.norm());
  }
}

}  // namespace
}  // namespace tautline::formfinding
