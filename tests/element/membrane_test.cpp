#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <tautline/element/membrane.hpp>
#include <vector>

namespace tautline::element {

namespace {

Vec3 in_frame(const Mat<2>& tensor, const Mat3& frame) {
  const Mat<2> Q = frame.topLeftCorner<2, 2>();  // columns: frame axes in the x-y plane
  const Mat<2> local = Q.transpose() * tensor * Q;
  return {local(0, 0), local(1, 1), local(0, 1)};
}

/// Square of four quadrilaterals with a displaced middle, each cut in two: every triangle is different. The
/// nine nodes lie in the x-y plane; node 4 is the only inner one.
struct Patch {
  Mat<3, 9> x;
  std::vector<std::array<int, 3>> triangles{{0, 1, 4}, {4, 3, 0}, {1, 2, 5}, {1, 5, 4},
                                            {3, 4, 6}, {7, 6, 4}, {8, 7, 4}, {4, 5, 8}};
  std::array<int, 8> boundary{0, 1, 2, 5, 8, 7, 6, 3};  // counter-clockwise
  MembraneSection section{1000, 0.3, 0};
  Mat<2> prestress{{20, 5}, {5, 12}};

  Patch() {
    x << 0, 0.4, 1, 0, 0.57, 1, 0, 0.6, 1, 0, 0, 0, 0.55, 0.41, 0.5, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0;
  }

  template <class Visit>
  void for_each(const Mat<3, 9>& u, const Visit& visit) const {
    for (const auto& t : triangles) {
      Mat<3, 3> x_ref, displacement;
      for (int i = 0; i < 3; ++i) {
        x_ref.col(i) = x.col(t[i]);
        displacement.col(i) = u.col(t[i]);
      }
      const Mat3 frame = membrane_frame(x_ref);
      const Vec<9> flat = Eigen::Map<const Vec<9>>(displacement.data());
      visit(t, frame, evaluate_membrane(section, in_frame(prestress, frame), x_ref, flat, Want::tangent));
    }
  }

  /// Nodal forces of the patch.
  Mat<3, 9> force(const Mat<3, 9>& u) const {
    Mat<3, 9> sum = Mat<3, 9>::Zero();
    for_each(u, [&](const auto& t, const Mat3&, const MembraneResponse& response) {
      for (int i = 0; i < 3; ++i) sum.col(t[i]) += response.force.template segment<3>(3 * i);
    });
    return sum;
  }

  Mat3 inner_stiffness(const Mat<3, 9>& u) const {
    Mat3 sum = Mat3::Zero();
    for_each(u, [&](const auto& t, const Mat3&, const MembraneResponse& response) {
      for (int i = 0; i < 3; ++i)
        if (t[i] == 4) sum += response.tangent.template block<3, 3>(3 * i, 3 * i);
    });
    return sum;
  }
};

/// A homogeneous deformation out of the plane: large stretch, shear and rotation.
Mat<3, 2> deformation_gradient() {
  Mat<3, 2> F;
  F << 1.1, 0.2, -0.1, 0.9, 0.3, 0.4;
  return F;
}

Mat<3, 9> homogeneous(const Patch& patch, const Mat<3, 2>& F) {
  return F * patch.x.topRows<2>() - patch.x;
}

/// Exact second Piola-Kirchhoff resultants of the homogeneous state in x-y axes.
Mat<2> exact_pk2(const Patch& patch, const Mat<3, 2>& F) {
  const Mat<2> E = (F.transpose() * F - Mat<2>::Identity()) / 2;
  const double Eh = patch.section.tension_stiffness, nu = patch.section.poisson_ratio;
  return patch.prestress + Eh / (1 - nu * nu) * ((1 - nu) * E + nu * E.trace() * Mat<2>::Identity());
}

Mat<3, 3> right_triangle() {
  Mat<3, 3> x;
  x << 0, 2, 0, 0, 0, 1, 0, 0, 0;
  return x;
}

}  // namespace

TEST(MembranePatch, HomogeneousDeformationGivesTheSameStressInEveryTriangle) {
  const Patch patch;
  const Mat<3, 2> F = deformation_gradient();
  const Mat<2> exact = exact_pk2(patch, F);
  patch.for_each(homogeneous(patch, F),
                 [&](const auto&, const Mat3& frame, const MembraneResponse& response) {
                   EXPECT_LT((response.pk2_resultant - in_frame(exact, frame)).norm(), 1e-12 * exact.norm());
                 });
}

TEST(MembranePatch, NodalForcesBalanceTheTractionOfTheBoundary) {
  const Patch patch;
  const Mat<3, 2> F = deformation_gradient();
  const Mat<3, 2> first_piola = F * exact_pk2(patch, F);
  Mat<3, 9> traction = Mat<3, 9>::Zero();
  for (int k = 0; k < 8; ++k) {
    const int a = patch.boundary[k], b = patch.boundary[(k + 1) % 8];
    const Vec3 side = patch.x.col(b) - patch.x.col(a);
    const Vec<2> normal_times_length(side[1], -side[0]);
    for (const int node : {a, b}) traction.col(node) += first_piola * normal_times_length / 2;
  }
  EXPECT_LT((patch.force(homogeneous(patch, F)) - traction).norm(), 1e-12 * traction.norm());
  EXPECT_EQ(traction.col(4).norm(), 0);
}

TEST(MembranePatch, InnerNodeFindsTheHomogeneousState) {
  const Patch patch;
  const Mat<3, 9> exact = homogeneous(patch, deformation_gradient());
  Mat<3, 9> u = exact;
  u.col(4) += Vec3(0.05, -0.03, 0.06);
  for (int i = 0; i < 8; ++i) u.col(4) -= patch.inner_stiffness(u).inverse() * patch.force(u).col(4);
  EXPECT_LT((u - exact).norm(), 1e-14);
}

TEST(Membrane, CarriesItsPrestressAtZeroDisplacement) {
  const Vec3 prestress(30, 20, 0);
  const auto film =
      evaluate_membrane({1000, 0.3, 0}, prestress, right_triangle(), Vec<9>::Zero(), Want::force);
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
  const auto answer = evaluate_membrane({1e6, 0.25, 0}, Vec3::Zero(), x, u, Want::force);
  EXPECT_NEAR(answer.pk2_resultant[0] / (1e6 / (1 - 0.0625) * strain), 1, 1e-11);
  EXPECT_NEAR(answer.pk2_resultant[1] / (0.25e6 / (1 - 0.0625) * strain), 1, 1e-11);
}

TEST(Membrane, SoapFilmStiffnessIsTheCotangentLaplacian) {
  // Isotropic prestress n without elasticity: transverse stiffness between two nodes -n cot(opposite angle)/2
  // (Pinkall & Polthier 1993); angles of the triangle: 90 degrees at node 0, cot = 2 and 1/2 at nodes 1
  // and 2.
  const double n = 7;
  const auto film =
      evaluate_membrane({0, 0, 0}, Vec3(n, n, 0), right_triangle(), Vec<9>::Zero(), Want::tangent);
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
    stiffness += evaluate_membrane({0, 0, 0}, Vec3(n, n, 0), x, Vec<9>::Zero(), Want::tangent).tangent(2, 2);
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
  const auto answer = evaluate_membrane({0, 0, 0}, Vec3(30, 20, 0), right_triangle(),
                                        Eigen::Map<const Vec<9>>(u.data()), Want::force);
  EXPECT_NEAR(answer.principal_cauchy[0], 30 * 1.5 / 0.8, 1e-12);
  EXPECT_NEAR(answer.principal_cauchy[1], 20 * 0.8 / 1.5, 1e-12);
}

TEST(Membrane, PrincipalValuesOfPureShearAreOpposite) {
  const auto answer =
      evaluate_membrane({0, 0, 0}, Vec3(0, 0, 4), right_triangle(), Vec<9>::Zero(), Want::force);
  EXPECT_NEAR(answer.principal_cauchy[0], 4, 1e-14);
  EXPECT_NEAR(answer.principal_cauchy[1], -4, 1e-14);
}

TEST(Membrane, FrameRunsAlongTheFirstSideAndIsRightHanded) {
  Mat<3, 3> x;
  x << 1, 1, 0, 0, 2, 1, 0, 0, 1;
  const Mat3 frame = membrane_frame(x);
  EXPECT_LT((frame.col(0) - Vec3(0, 1, 0)).norm(), 1e-15);
  EXPECT_LT((frame.transpose() * frame - Mat3::Identity()).norm(), 1e-15);
  EXPECT_NEAR(frame.determinant(), 1, 1e-15);
  EXPECT_GT(frame.col(1).dot(x.col(2) - x.col(0)), 0);
}

TEST(Membrane, MassGivesTheKineticEnergyOfRigidMotion) {
  const Mat<9> mass = membrane_mass(3, right_triangle());  // area 1
  const Vec<9> translation = Vec3(1, 2, 2).replicate<3, 1>();
  EXPECT_NEAR(translation.dot(mass * translation) / 2, 3 * 9 / 2., 1e-13);
  Vec<9> spin;  // 1 rad/s about the y axis: second moment of area, integral of x^2 = b^3 h / 12 = 2/3
  spin << 0, 0, 0, 0, 0, -2, 0, 0, 0;
  EXPECT_NEAR(spin.dot(mass * spin) / 2, 3 * (2. / 3) / 2, 1e-13);
}

}  // namespace tautline::element
