#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <type_traits>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <tautline/element/membrane.hpp>

namespace tautline::element {

namespace {

/// Green-Lagrange strain of a free growth.
double green(double growth) {
  return growth + growth * growth / 2;
}

Vec3 in_frame(const Mat<2>& tensor, const Mat3& frame) {
  const Mat<2> Q = frame.topLeftCorner<2, 2>();  // columns: frame axes in the x-y plane
  const Mat<2> local = Q.transpose() * tensor * Q;
  return {local(0, 0), local(1, 1), local(0, 1)};
}

using Triangles = std::integral_constant<int, 3>;
using Quadrilaterals = std::integral_constant<int, 4>;

/// Square of four quadrilaterals with a displaced middle, each different; for triangles each is cut in two.
/// The nine nodes lie in the x-y plane; node 4 is the only inner one.
template <int N>
struct Patch {
  Mat<3, 9> x;
  std::vector<std::array<int, N>> elements;
  std::array<int, 8> boundary{0, 1, 2, 5, 8, 7, 6, 3};  // counter-clockwise
  MembraneSection section{1000, 0.3, 0};
  Mat<2> prestress{{20, 5}, {5, 12}};
  double temperature_change = 0;

  Patch() {
    x << 0, 0.4, 1, 0, 0.57, 1, 0, 0.6, 1, 0, 0, 0, 0.55, 0.41, 0.5, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0;
    if constexpr (N == 3)
      elements = {{0, 1, 4}, {4, 3, 0}, {1, 2, 5}, {1, 5, 4}, {3, 4, 6}, {7, 6, 4}, {8, 7, 4}, {4, 5, 8}};
    else
      elements = {{0, 1, 4, 3}, {5, 4, 1, 2}, {3, 4, 7, 6}, {8, 7, 4, 5}};
  }

  template <class Visit>
  void for_each(const Mat<3, 9>& u, const Visit& visit) const {
    for (const auto& nodes : elements) {
      Mat<3, N> x_ref, displacement;
      for (int i = 0; i < N; ++i) {
        x_ref.col(i) = x.col(nodes[i]);
        displacement.col(i) = u.col(nodes[i]);
      }
      const Mat3 frame = membrane_frame<N>(x_ref);
      const double angle = std::atan2(frame(0, 1), frame(0, 0));  // of the x axis in the frame
      const MembraneLaw law = membrane_law(section, angle, in_frame(prestress, frame), temperature_change);
      const Vec<3 * N> flat = Eigen::Map<const Vec<3 * N>>(displacement.data());
      visit(nodes, frame, evaluate_membrane<N>(law, x_ref, flat, Want::tangent));
    }
  }

  /// Nodal forces of the patch.
  Mat<3, 9> force(const Mat<3, 9>& u) const {
    Mat<3, 9> sum = Mat<3, 9>::Zero();
    for_each(u, [&](const auto& nodes, const Mat3&, const MembraneResponse<N>& response) {
      for (int i = 0; i < N; ++i) sum.col(nodes[i]) += response.force.template segment<3>(3 * i);
    });
    return sum;
  }

  double energy(const Mat<3, 9>& u) const {
    double sum = 0;
    for_each(u,
             [&](const auto&, const Mat3&, const MembraneResponse<N>& response) { sum += response.energy; });
    return sum;
  }

  Mat3 inner_stiffness(const Mat<3, 9>& u) const {
    Mat3 sum = Mat3::Zero();
    for_each(u, [&](const auto& nodes, const Mat3&, const MembraneResponse<N>& response) {
      for (int i = 0; i < N; ++i)
        if (nodes[i] == 4) sum += response.tangent.template block<3, 3>(3 * i, 3 * i);
    });
    return sum;
  }

  Mat<3, 9> homogeneous(const Mat<3, 2>& F) const { return F * x.template topRows<2>() - x; }

  /// Newton's method for the inner node from a place beside that of the homogeneous state; the distance left.
  double distance_after_newton(const Mat<3, 2>& F, const Vec3& beside, int iterations) const {
    const Mat<3, 9> exact = homogeneous(F);
    Mat<3, 9> u = exact;
    u.col(4) += beside;
    for (int i = 0; i < iterations; ++i) u.col(4) -= inner_stiffness(u).inverse() * force(u).col(4);
    return (u - exact).norm();
  }
};

/// A homogeneous deformation out of the plane: large stretch, shear and rotation.
Mat<3, 2> deformation_gradient() {
  Mat<3, 2> F;
  F << 1.1, 0.2, -0.1, 0.9, 0.3, 0.4;
  return F;
}

Mat<2> green_strain(const Mat<3, 2>& F) {
  return (F.transpose() * F - Mat<2>::Identity()) / 2;
}

/// Exact second Piola-Kirchhoff resultants of the homogeneous state in x-y axes.
Mat<2> isotropic_pk2(const MembraneSection& section, const Mat<2>& prestress, const Mat<3, 2>& F) {
  const Mat<2> E = green_strain(F);
  const double Eh = section.tension_stiffness, nu = section.poisson_ratio;
  return prestress + Eh / (1 - nu * nu) * ((1 - nu) * E + nu * E.trace() * Mat<2>::Identity());
}

/// Nodal forces of a uniform first Piola-Kirchhoff stress: half of each side times the traction there.
template <int N>
Mat<3, 9> boundary_forces(const Patch<N>& patch, const Mat<3, 2>& first_piola) {
  Mat<3, 9> traction = Mat<3, 9>::Zero();
  for (int k = 0; k < 8; ++k) {
    const int a = patch.boundary[k], b = patch.boundary[(k + 1) % 8];
    const Vec3 side = patch.x.col(b) - patch.x.col(a);
    const Vec<2> normal_times_length(side[1], -side[0]);
    for (const int node : {a, b}) traction.col(node) += first_piola * normal_times_length / 2;
  }
  return traction;
}

template <int N>
void expect_everywhere(const Patch<N>& patch, const Mat<3, 2>& F, const Mat<2>& pk2, MembraneState state) {
  patch.for_each(patch.homogeneous(F),
                 [&](const auto&, const Mat3& frame, const MembraneResponse<N>& response) {
                   EXPECT_LT((response.pk2_resultant - in_frame(pk2, frame)).norm(), 1e-12 * pk2.norm());
                   EXPECT_EQ(response.state, state);
                 });
}

std::vector<Mat<3, 9>> random_displacements(int n) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> uniform(-0.4, 0.4);
  std::vector<Mat<3, 9>> result;
  for (int i = 0; i < n; ++i) result.push_back(Mat<3, 9>::NullaryExpr([&] { return uniform(engine); }));
  return result;
}

template <int N>
double lowest_eigenvalue(const Mat<N>& matrix) {
  return Eigen::SelfAdjointEigenSolver<Mat<N>>(matrix).eigenvalues()[0];
}

Mat<3, 3> right_triangle() {
  Mat<3, 3> x;
  x << 0, 2, 0, 0, 0, 1, 0, 0, 0;
  return x;
}

/// Plane quadrilateral; area and the integral of x^2 over it by the formulas for polygons, sums over the
/// sides of (x_i y_j - x_j y_i)/2 and (x_i y_j - x_j y_i)(x_i^2 + x_i x_j + x_j^2)/12.
Mat<3, 4> kite() {
  Mat<3, 4> x;
  x << 0, 3, 4, 1, 0, 0, 2, 3, 0, 0, 0, 0;
  return x;
}
constexpr double kite_area = (0 + 6 + 10 + 0) / 2.;
constexpr double kite_second_moment = (6 * (9 + 12 + 16) + 10 * (16 + 4 + 1)) / 12.;

MembraneResponse<3> evaluate_triangle(const MembraneSection& section, const Vec3& prestress,
                                      const Mat<3, 3>& x_ref, const Vec<9>& u, Want want) {
  return evaluate_membrane<3>(membrane_law(section, 0, prestress, 0), x_ref, u, want);
}

template <class Nodes>
class MembranePatch : public testing::Test {};
using BothShapes = testing::Types<Triangles, Quadrilaterals>;
TYPED_TEST_SUITE(MembranePatch, BothShapes);

}  // namespace

TYPED_TEST(MembranePatch, HomogeneousDeformationGivesTheSameStressEverywhere) {
  const Patch<TypeParam::value> patch;
  const Mat<3, 2> F = deformation_gradient();
  expect_everywhere(patch, F, isotropic_pk2(patch.section, patch.prestress, F), MembraneState::taut);
}

TYPED_TEST(MembranePatch, NodalForcesBalanceTheTractionOfTheBoundary) {
  const Patch<TypeParam::value> patch;
  const Mat<3, 2> F = deformation_gradient();
  const Mat<3, 9> traction = boundary_forces(patch, F * isotropic_pk2(patch.section, patch.prestress, F));
  EXPECT_LT((patch.force(patch.homogeneous(F)) - traction).norm(), 1e-12 * traction.norm());
  EXPECT_EQ(traction.col(4).norm(), 0);
}

TYPED_TEST(MembranePatch, InnerNodeFindsTheHomogeneousState) {
  const Patch<TypeParam::value> patch;
  EXPECT_LT(patch.distance_after_newton(deformation_gradient(), Vec3(0.05, -0.03, 0.06), 8), 1e-14);
}

TYPED_TEST(MembranePatch, WovenSheetCarriesTheStressOfItsMaterialAxes) {
  // material axes x and y: N_x = E1 h/(1 - nu12 nu21) (Ex + nu21 Ey) and so on, nu21 = nu12 E2/E1
  Patch<TypeParam::value> patch;
  patch.section = {1000, 0.3, 0, 400, 150};
  const Mat<3, 2> F = deformation_gradient();
  const Mat<2> E = green_strain(F);
  const double nu21 = 0.3 * 400 / 1000, share = 1 / (1 - 0.3 * nu21);
  Mat<2> pk2 = patch.prestress;
  pk2(0, 0) += 1000 * share * (E(0, 0) + nu21 * E(1, 1));
  pk2(1, 1) += 400 * share * (E(1, 1) + 0.3 * E(0, 0));
  pk2(0, 1) += 150 * 2 * E(0, 1);
  pk2(1, 0) = pk2(0, 1);
  expect_everywhere(patch, F, pk2, MembraneState::taut);
  const Mat<3, 9> traction = boundary_forces<TypeParam::value>(patch, F * pk2);
  EXPECT_LT((patch.force(patch.homogeneous(F)) - traction).norm(), 1e-12 * traction.norm());
}

TYPED_TEST(MembranePatch, FreeThermalExpansionIsStressFree) {
  Patch<TypeParam::value> patch;
  patch.section = {1000, 0.3, 0, 400, 150, 1e-3, -4e-4};
  patch.prestress.setZero();
  patch.temperature_change = 80;
  Mat<3, 2> F = Mat<3, 2>::Zero();  // stretched by 1 + alpha dT along both material axes
  F(0, 0) = 1 + 0.08;
  F(2, 1) = 1 - 0.032;
  patch.for_each(patch.homogeneous(F), [](const auto&, const Mat3&, const auto& response) {
    EXPECT_LT(response.pk2_resultant.norm(), 1e-12);
    EXPECT_LT(response.force.norm(), 1e-12);
    EXPECT_NEAR(response.energy, 0, 1e-14);
  });
}

TYPED_TEST(MembranePatch, HeldMembraneResistsItsThermalExpansion) {
  Patch<TypeParam::value> patch;
  patch.temperature_change = -80;
  patch.section.thermal_expansion = 1e-3;
  const double isotropic = -1000 / (1 - 0.3) * green(-0.08);  // E h alpha dT/(1 - nu)
  expect_everywhere(patch, Mat<3, 2>::Identity(), patch.prestress + isotropic * Mat<2>::Identity(),
                    MembraneState::taut);
  patch.section = {1000, 0.3, 0, 400, 150, 1e-3, -4e-4};
  const double nu21 = 0.3 * 400 / 1000, share = 1 / (1 - 0.3 * nu21);
  Mat<2> woven = patch.prestress;
  woven(0, 0) += 1000 * share * (-green(-0.08) - nu21 * green(0.032));
  woven(1, 1) += 400 * share * (-green(0.032) - 0.3 * green(-0.08));
  expect_everywhere(patch, Mat<3, 2>::Identity(), woven, MembraneState::taut);
}

TYPED_TEST(MembranePatch, WrinkledSheetPullsInOneDirectionOnly) {
  // stretched along x, its width given up: N_x = E h E_xx, all else zero
  Patch<TypeParam::value> patch;
  patch.section.wrinkling = true;
  patch.prestress.setZero();
  Mat<3, 2> F = Mat<3, 2>::Zero();
  F(0, 0) = 1.1;
  F(2, 1) = 0.5;
  Mat<2> pk2 = Mat<2>::Zero();
  pk2(0, 0) = 1000 * (1.1 * 1.1 - 1) / 2;
  expect_everywhere(patch, F, pk2, MembraneState::wrinkled);
  const Mat<3, 9> traction = boundary_forces<TypeParam::value>(patch, F * pk2);
  EXPECT_LT((patch.force(patch.homogeneous(F)) - traction).norm(), 1e-12 * traction.norm());
  patch.for_each(patch.homogeneous(F), [&](const auto&, const Mat3&, const auto& response) {
    EXPECT_NEAR(response.principal_cauchy[0], pk2(0, 0) * 1.1 / 0.5, 1e-10);  // on the current width
    EXPECT_NEAR(response.principal_cauchy[1], 0, 1e-11);
  });
}

TYPED_TEST(MembranePatch, InnerNodeOfAWrinkledSheetFindsTheHomogeneousState) {
  // pure shear: the tension at 45 degrees holds the node across the sheet and within it
  Patch<TypeParam::value> patch;
  patch.section.wrinkling = true;
  patch.prestress.setZero();
  Mat<3, 2> F = Mat<3, 2>::Zero();
  F(0, 0) = F(1, 1) = 1;
  F(0, 1) = F(1, 0) = 0.1;
  const double inclined = 1000 * green_strain(F).sum() / 2;  // E h times the larger principal strain
  expect_everywhere(patch, F, inclined / 2 * Mat<2>::Ones(), MembraneState::wrinkled);
  EXPECT_LT(patch.distance_after_newton(F, Vec3(0.005, 0.003, 0.01), 12), 1e-13);
}

TYPED_TEST(MembranePatch, SlackSheetHasNoForce) {
  Patch<TypeParam::value> patch;
  patch.section.wrinkling = true;
  patch.prestress.setZero();
  for (const double stretch : {0.9, 0.}) {
    const Mat<3, 2> F = stretch * Mat<3, 2>::Identity();
    patch.for_each(patch.homogeneous(F), [](const auto&, const Mat3&, const auto& response) {
      EXPECT_EQ(response.state, MembraneState::slack);
      EXPECT_EQ(response.energy, 0);
      EXPECT_EQ(response.force.norm(), 0);
      EXPECT_EQ(response.tangent.norm(), 0);
      EXPECT_EQ(response.principal_cauchy.norm(), 0);
    });
  }
}

TYPED_TEST(MembranePatch, WrinklingEnergyIsConvexInTheDisplacements) {
  // Convex in E, never falling with E since there is no compression, and E convex in u (Pipkin 1994). Random
  // displacements as large as the elements; the elastic energy is far from convex there.
  Patch<TypeParam::value> patch, elastic;
  patch.section.wrinkling = true;
  const auto displacements = random_displacements(20);
  double lowest_elastic = 0;
  for (const Mat<3, 9>& u : displacements) {
    patch.for_each(u, [](const auto&, const Mat3&, const auto& response) {
      EXPECT_GE(lowest_eigenvalue<3 * TypeParam::value>(response.tangent), -1e-14 * response.tangent.norm());
    });
    elastic.for_each(u, [&](const auto&, const Mat3&, const auto& response) {
      lowest_elastic = std::min(lowest_elastic, lowest_eigenvalue<3 * TypeParam::value>(response.tangent) /
                                                    response.tangent.norm());
    });
  }
  EXPECT_LT(lowest_elastic, -0.1);
  for (std::size_t i = 1; i < displacements.size(); ++i) {
    const Mat<3, 9>&a = displacements[i - 1], &b = displacements[i];
    for (double share = 0.1; share < 1; share += 0.1)
      EXPECT_LT(patch.energy((1 - share) * a + share * b),
                (1 - share) * patch.energy(a) + share * patch.energy(b));
  }
}

TEST(Membrane, CarriesItsPrestressAtZeroDisplacement) {
  const Vec3 prestress(30, 20, 0);
  const auto film =
      evaluate_triangle({1000, 0.3, 0}, prestress, right_triangle(), Vec<9>::Zero(), Want::force);
  EXPECT_EQ(film.energy, 0);
  EXPECT_EQ(film.pk2_resultant, prestress);
  EXPECT_NEAR(film.principal_cauchy[0], 30, 1e-14);
  EXPECT_NEAR(film.principal_cauchy[1], 20, 1e-14);
  // half of the side lengths times the resultants that cross them
  Vec<9> force;
  force << -15, -20, 0, 15, 0, 0, 0, 20, 0;
  EXPECT_LT((film.force - force).norm(), 1e-13);
}

TEST(Membrane, SmallDisplacementsKeepTheirDigits) {
  // Strain 1e-12 far from the origin: forming it from deformed lengths would leave errors of 1e-16 x 20 m / 1
  // m.
  Mat<3, 3> x = right_triangle();
  x.colwise() += Vec3(12, -15, 20);
  const double strain = 1e-12;
  Vec<9> u = Vec<9>::Zero();
  u[3] = 2 * strain;  // E11 = strain
  const auto answer = evaluate_triangle({1e6, 0.25, 0}, Vec3::Zero(), x, u, Want::force);
  EXPECT_NEAR(answer.pk2_resultant[0] / (1e6 / (1 - 0.0625) * strain), 1, 1e-11);
  EXPECT_NEAR(answer.pk2_resultant[1] / (0.25e6 / (1 - 0.0625) * strain), 1, 1e-11);
}

TEST(Membrane, SoapFilmStiffnessIsTheCotangentLaplacian) {
  // Isotropic prestress n without elasticity: transverse stiffness between two nodes -n cot(opposite angle)/2
  // (Pinkall & Polthier 1993); angles of the triangle: 90 degrees at node 0, cot = 2 and 1/2 at nodes 1
  // and 2.
  const double n = 7;
  const auto film =
      evaluate_triangle({0, 0, 0}, Vec3(n, n, 0), right_triangle(), Vec<9>::Zero(), Want::tangent);
  EXPECT_NEAR(film.tangent(2, 5), -n / 4, 1e-14);
  EXPECT_NEAR(film.tangent(2, 8), -n, 1e-14);
  EXPECT_NEAR(film.tangent(5, 8), 0, 1e-14);
}

TEST(Membrane, SoapFilmOfAHexagonCarriesACentralLoad) {
  // six equilateral triangles: 6 edges, each with two opposite angles of 60 degrees: K = 6 n cot 60
  const double n = 5;
  double stiffness = 0;
  for (int k = 0; k < 6; ++k) {
    const double a = k * std::acos(-1.) / 3, b = (k + 1) * std::acos(-1.) / 3;
    Mat<3, 3> x;
    x << 0, std::cos(a), std::cos(b), 0, std::sin(a), std::sin(b), 0, 0, 0;
    stiffness += evaluate_triangle({0, 0, 0}, Vec3(n, n, 0), x, Vec<9>::Zero(), Want::tangent).tangent(2, 2);
  }
  EXPECT_NEAR(stiffness, 6 * n / std::sqrt(3.), 1e-13);
}

TEST(Membrane, PrincipalCauchyResultantsReferToCurrentLengths) {
  // F = Q diag(1.5, 0.8): the force across each side stays F N, the side grows: 1.5/0.8 N1 and 0.8/1.5 N2
  Mat<3, 2> F = Mat<3, 2>::Zero();
  F(0, 0) = 1.5;
  F(1, 1) = 0.8;
  const Mat3 Q = Eigen::AngleAxisd(2.5, Vec3(1, 2, 2) / 3).toRotationMatrix();
  const Mat<3, 3> u = Q * F * right_triangle().topRows<2>() - right_triangle();
  const auto answer = evaluate_triangle({0, 0, 0}, Vec3(30, 20, 0), right_triangle(),
                                        Eigen::Map<const Vec<9>>(u.data()), Want::force);
  EXPECT_NEAR(answer.principal_cauchy[0], 30 * 1.5 / 0.8, 1e-12);
  EXPECT_NEAR(answer.principal_cauchy[1], 20 * 0.8 / 1.5, 1e-12);
}

TEST(Membrane, PrincipalValuesOfPureShearAreOpposite) {
  const auto answer =
      evaluate_triangle({0, 0, 0}, Vec3(0, 0, 4), right_triangle(), Vec<9>::Zero(), Want::force);
  EXPECT_NEAR(answer.principal_cauchy[0], 4, 1e-14);
  EXPECT_NEAR(answer.principal_cauchy[1], -4, 1e-14);
}

TEST(Membrane, FrameRunsAlongTheFirstSideAndIsRightHanded) {
  Mat<3, 3> x;
  x << 1, 1, 0, 0, 2, 1, 0, 0, 1;
  const Mat3 frame = membrane_frame<3>(x);
  EXPECT_LT((frame.col(0) - Vec3(0, 1, 0)).norm(), 1e-15);
  EXPECT_LT((frame.transpose() * frame - Mat3::Identity()).norm(), 1e-15);
  EXPECT_NEAR(frame.determinant(), 1, 1e-15);
  EXPECT_GT(frame.col(1).dot(x.col(2) - x.col(0)), 0);
}

TEST(Membrane, MassGivesTheKineticEnergyOfRigidMotion) {
  const Mat<9> mass = membrane_mass<3>(3, right_triangle());  // area 1
  const Vec<9> translation = Vec3(1, 2, 2).replicate<3, 1>();
  EXPECT_NEAR(translation.dot(mass * translation) / 2, 3 * 9 / 2., 1e-13);
  Vec<9> spin;  // 1 rad/s about the y axis: second moment of area, integral of x^2 = b^3 h / 12 = 2/3
  spin << 0, 0, 0, 0, 0, -2, 0, 0, 0;
  EXPECT_NEAR(spin.dot(mass * spin) / 2, 3 * (2. / 3) / 2, 1e-13);
}

TEST(Membrane, SoapFilmPullsItsAreaTogether) {
  // N0 = n in all directions, no elasticity: in the reference configuration the force is n times the gradient
  // of the area, also of a surface that is not flat. Five-point formula, truncation about 1e-11.
  Mat<3, 4> x;
  x << 0, 1.2, 1.4, 0.3, 0.1, 0.2, 1.1, 0.9, 0, 0.3, -0.1, -0.2;
  const double n = 3, h = 1e-3;
  const auto film =
      evaluate_membrane<4>(membrane_law({}, 0, Vec3(n, n, 0), 0), x, Vec<12>::Zero(), Want::force);
  for (int i = 0; i < 12; ++i) {
    const auto area = [&](double step) {
      Mat<3, 4> moved = x;
      moved.data()[i] += step * h;
      return membrane_area<4>(moved);
    };
    EXPECT_NEAR(film.force[i], n * (8 * (area(1) - area(-1)) - (area(2) - area(-2))) / (12 * h), 1e-10);
  }
}

TEST(Membrane, BentStripWrinklesAsSteinAndHedgepethFound) {
  // Rectangle of height h under tension P and moment M (Stein & Hedgepeth 1961): a band of width b at the
  // lower edge wrinkles when M > P h/6, b/h = 3 M/(P h) - 1/2, and 2 M/(P h) = 1 - (2/3) sqrt(2 P/(E h^2
  // kappa)) with E per width. Short elements one above the other; the band ends on an edge, where the tension
  // vanishes. Tension across the strip keeps the labels definite. Strains of 1e-6 leave it linear.
  const double Eh = 1000, height = 2, length = 1e-3, prestress = 5e-4;
  const int n = 10, band_elements = 4;
  const double b = height * band_elements / n, kappa = 1e-6;
  const MembraneSection section{Eh, 0, 0, 0, 0, 0, 0, true};
  const auto strain = [&](double y) { return kappa * (y - b) - prestress / Eh; };
  double P = 0, M = 0;
  for (int k = 0; k < n; ++k) {
    const double low = height * k / n, high = height * (k + 1) / n;
    Mat<3, 4> x, u = Mat<3, 4>::Zero();
    x << 0, length, length, 0, low, low, high, high, 0, 0, 0, 0;
    u(0, 1) = strain(low) * length;
    u(0, 2) = strain(high) * length;
    const auto strip = evaluate_membrane<4>(membrane_law(section, 0, Vec3(prestress, prestress, 0), 0), x,
                                            Eigen::Map<const Vec<12>>(u.data()), Want::force);
    EXPECT_EQ(strip.state == MembraneState::taut, k >= band_elements);
    P += strip.force[3] + strip.force[6];
    M += strip.force[3] * (low - height / 2) + strip.force[6] * (high - height / 2);
  }
  EXPECT_GT(M, P * height / 6);
  EXPECT_NEAR(3 * M / (P * height) - 0.5, b / height, 1e-5);
  EXPECT_NEAR(2 * M / (P * height), 1 - 2. / 3 * std::sqrt(2 * P / (Eh * height * height * kappa)), 1e-5);
}

TEST(Membrane, QuadrilateralFrameRunsAlongItsMedian) {
  Mat<3, 4> x;
  x << 1, 1, 0, 0, 0, 2, 3, 1, 0, 0, 1, 1;
  const Mat3 frame = membrane_frame<4>(x);  // middle of side 4-1: (0.5, 0.5, 0.5), of 2-3: (0.5, 2.5, 0.5)
  EXPECT_LT((frame.col(0) - Vec3(0, 1, 0)).norm(), 1e-15);
  EXPECT_LT((frame.col(2) - Vec3(1, 0, 1) / std::sqrt(2.)).norm(), 1e-15);
  EXPECT_NEAR(frame.determinant(), 1, 1e-15);
}

TEST(Membrane, AreaOfAPlaneQuadrilateralIsThatOfThePolygon) {
  const Mat3 Q = Eigen::AngleAxisd(0.7, Vec3(2, -1, 2) / 3).toRotationMatrix();
  EXPECT_NEAR(membrane_area<4>(Q * kite()), kite_area, 1e-14);
  EXPECT_NEAR(membrane_area<3>(Q * right_triangle()), 1, 1e-15);
}

TEST(Membrane, MassOfAQuadrilateralGivesTheKineticEnergyOfRigidMotion) {
  const Mat<12> mass = membrane_mass<4>(3, kite());
  const Vec<12> translation = Vec3(1, 2, 2).replicate<4, 1>();
  EXPECT_NEAR(translation.dot(mass * translation) / 2, 3 * kite_area * 9 / 2., 1e-13);
  Vec<12> spin = Vec<12>::Zero();  // 1 rad/s about the y axis: u_z = -x
  for (int i = 0; i < 4; ++i) spin[3 * i + 2] = -kite()(0, i);
  EXPECT_NEAR(spin.dot(mass * spin) / 2, 3 * kite_second_moment / 2, 1e-13);
}

TEST(Membrane, LawTurnsMaterialAxesIntoTheFrame) {
  // fibres at 90 degrees: the axes change places
  const MembraneSection section{1000, 0.3, 0, 400, 150, 1e-3, -4e-4};
  const MembraneLaw law = membrane_law(section, std::acos(-1.) / 2, Vec3(1, 2, 3), 10);
  const double share = 1 / (1 - 0.3 * 0.12);
  Mat3 D;
  D << 400 * share, 0.3 * 400 * share, 0, 0.3 * 400 * share, 1000 * share, 0, 0, 0, 150;
  EXPECT_LT((law.stiffness - D).norm(), 1e-12 * D.norm());
  EXPECT_LT((law.free_strain - Vec3(green(-4e-3), green(1e-2), 0)).norm(), 1e-17);
  EXPECT_EQ(law.prestress, Vec3(1, 2, 3));
}

TEST(Membrane, IsotropicLawDoesNotKnowItsAngle) {
  const MembraneSection section{1000, 0.3, 0, 0, 0, 1e-3};
  const MembraneLaw law = membrane_law(section, 0.3, Vec3::Zero(), 10);
  EXPECT_EQ(law.stiffness, membrane_law(section, 0, Vec3::Zero(), 10).stiffness);
  EXPECT_EQ(law.free_strain, Vec3(green(1e-2), green(1e-2), 0));
}

TEST(Membrane, PrestressAloneDoesNotWrinkle) {
  const MembraneSection nothing_to_relax{0, 0, 0, 0, 0, 0, 0, true};
  EXPECT_FALSE(membrane_law(nothing_to_relax, 0, Vec3(1, 1, 0), 0).wrinkling);
}

}  // namespace tautline::element
