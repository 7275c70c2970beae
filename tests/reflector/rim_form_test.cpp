// Stage 1 of the rim reflector against the coordinates printed by Belov (2021), appendix B, and against the
// numbers of an independent recomputation of the same net (dense SVD, KKT and position-Newton solvers in
// another language, which agreed among themselves to 2e-14 m).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <reflector/rim_net.hpp>

namespace tautline::reflector {
namespace {

using formfinding::ForceDensityOptions;
using formfinding::ForceDensityResult;
using formfinding::Net;
using formfinding::SurfaceJacobian;

constexpr double tension = 10;

ForceDensityResult find_rim_net(const ForceDensityOptions& options) {
  const Net net = front_net(make_perimeter_truss(rim_options()));
  const Paraboloid surface = make_paraboloid(rim_options());
  return find_tensions(net, VecX::Constant(net.branches.size(), tension), &surface, options);
}

const ForceDensityResult& rim_net() {
  static const ForceDensityResult result = find_rim_net({});
  return result;
}

TEST(RimNetForm, HasThePrintedCoordinates) {
  // Half a unit of the last printed decimal, 5 mm, and room for coordinates that lie on the boundary of
  // rounding. The rms of a pure rounding error is 5 mm / sqrt(3) = 2.9 mm; three standard errors of 271
  // samples above that is 3.2 mm.
  Vec3 squares = Vec3::Zero();
  const auto printed = read_table("belov_appendix_b.csv");
  ASSERT_EQ(printed.size(), 331u);
  for (int i = 0; i < 271; ++i) {
    const Vec3 difference = rim_net().nodes[i] - Vec3(printed[i][1], printed[i][2], printed[i][3]);
    EXPECT_LE(difference.cwiseAbs().maxCoeff(), 0.0051) << "node " << i + 1;
    squares += difference.cwiseAbs2() / 271;
  }
  EXPECT_LE(squares.cwiseSqrt().maxCoeff(), 0.0032);
}

TEST(RimNetForm, HasTheTensionsAskedFor) {
  EXPECT_TRUE(rim_net().converged) << rim_net().reason;
  EXPECT_LE((rim_net().tension.array() - tension).abs().maxCoeff(), 1e-8);
  EXPECT_LE(rim_net().out_of_balance, 1e-9 * tension);
}

TEST(RimNetForm, AgreesWithAnIndependentSolution) {
  // Tolerances: half a unit of the last digit of the independent solution.
  const Vec3 norm = rim_net().coordinate_norm.back();
  EXPECT_NEAR(norm.x(), 45.69135, 5e-6);
  EXPECT_NEAR(norm.y(), 45.98350, 5e-6);
  EXPECT_NEAR(norm.z(), 7.80856, 5e-6);
  EXPECT_NEAR(rim_net().force_density.minCoeff(), 9.171, 5e-4);
  EXPECT_NEAR(rim_net().force_density.maxCoeff(), 33.908, 5e-4);
  const VecX length = rim_net().tension.cwiseQuotient(rim_net().force_density);
  EXPECT_NEAR(length.minCoeff(), 0.2949, 5e-5);
  EXPECT_NEAR(length.maxCoeff(), 1.0903, 5e-5);
}

TEST(RimNetForm, NeedsTiesThatPullDown) {
  const VecX tie = -rim_net().residual_z;
  EXPECT_NEAR(tie.head(271).minCoeff(), 0.055, 5e-4);
  EXPECT_NEAR(tie.head(271).maxCoeff(), 7.81, 5e-3);
  EXPECT_NEAR(tie.head(217).minCoeff(), 0.800, 5e-4);  // rings 0 to 8
  EXPECT_NEAR(tie.head(217).maxCoeff(), 1.213, 5e-4);
  EXPECT_NEAR(tie.head(217).mean(), 1.006, 5e-4);
}

TEST(RimNetForm, ConvergesQuadraticallyWithTheSlopeOfTheSurface) {
  // Published digits of the independent solver; the last iteration is rounding error, only its size is meant.
  const auto& residual = rim_net().constraint_residual;
  ASSERT_LE(rim_net().iterations, 5);
  ASSERT_GE(residual.size(), 5u);
  EXPECT_NEAR(residual[1], 0.809, 5e-4);
  EXPECT_NEAR(residual[2], 2.1e-2, 5e-4);
  EXPECT_NEAR(residual[3], 1.1e-5, 5e-7);
  EXPECT_LE(residual[4], 1e-10);
}

TEST(RimNetForm, ConvergesLinearlyWithThePublishedJacobian) {
  ForceDensityOptions options;
  options.jacobian = SurfaceJacobian::as_published;
  options.tolerance = 1e-4;
  const ForceDensityResult result = find_rim_net(options);
  EXPECT_TRUE(result.converged) << result.reason;
  EXPECT_TRUE(result.iterations == 7 || result.iterations == 8) << result.iterations;
  const std::vector<double> expected{0.997, 1.02, 0.144, 6.1e-2, 0, 5.6e-3, 1.7e-3, 5.2e-4};
  for (int i = 0; i < 8; ++i) {
    if (expected[i] == 0) continue;
    EXPECT_NEAR(result.constraint_residual.at(i + 1), expected[i], 0.01 * expected[i]) << i;
  }
}

TEST(RimNetForm, RelaxedStepsNeverRaiseTheNorm) {
  // Twenty rings with the published Jacobian: the full step overshoots and eq. (2.25) answers with 1/4.
  const Net net = front_net(make_perimeter_truss(rim_options(20)));
  const Paraboloid surface = make_paraboloid(rim_options(20));
  ForceDensityOptions options;
  options.jacobian = SurfaceJacobian::as_published;
  options.max_iterations = 4;
  const ForceDensityResult result =
      find_tensions(net, VecX::Constant(net.branches.size(), tension), &surface, options);
  EXPECT_EQ(*std::min_element(result.step_relaxation.begin(), result.step_relaxation.end()), 0.25);
  const auto& norm = result.constraint_residual_norm;
  EXPECT_TRUE(std::is_sorted(norm.rbegin(), norm.rend()));
}

TEST(RimNetForm, IsFoundForOtherDishes) {
  for (const double clearance : {-3.0, 0.0, 4.0}) {
    for (const int rings : {1, 2, 5, 8}) {
      PerimeterTrussOptions options;
      options.aperture = 6;
      options.focal_length = 4;
      options.clearance = clearance;
      options.rings = rings;
      options.gap = 0.1;
      const Net net = front_net(make_perimeter_truss(options));
      const Paraboloid surface = make_paraboloid(options);
      const auto result = find_tensions(net, VecX::Constant(net.branches.size(), tension), &surface, {});
      EXPECT_TRUE(result.converged) << clearance << " " << rings << " " << result.reason;
    }
  }
}

TEST(RimNetForm, IsWellConditioned) {
  ForceDensityOptions options;
  options.estimate_condition = true;
  EXPECT_NEAR(find_rim_net(options).condition_number, 113, 3);
}

TEST(RimNetForm, DoesNotDependOnTheInitialForceDensity) {
  for (const double q0 : {1.0, 16.0}) {
    ForceDensityOptions options;
    options.initial_force_density = q0;
    const ForceDensityResult result = find_rim_net(options);
    ASSERT_TRUE(result.converged);
    for (int i = 0; i < 271; ++i) EXPECT_NEAR((result.nodes[i] - rim_net().nodes[i]).norm(), 0, 1e-9);
  }
}

}  // namespace
}  // namespace tautline::reflector
