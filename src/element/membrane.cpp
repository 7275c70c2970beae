#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <tautline/element/membrane.hpp>
#include <tautline/material/plane_stress.hpp>

namespace tautline::element {

namespace {

/// Reference triangle. In the axes (e1, e2) the shape function of node 1 has the gradient (p, q), of node 2
/// (0, r), and of node 0 minus their sum.
struct Triangle {
  Vec3 e1, e2;     ///< in-plane axes of the frame
  double area;     ///< [m^2]
  double p, q, r;  ///< [1/m]
};

Triangle triangle(const Mat<3, 3>& x_ref) {
  const Vec3 side1 = x_ref.col(1) - x_ref.col(0);
  const Vec3 side2 = x_ref.col(2) - x_ref.col(0);
  const Vec3 normal = side1.cross(side2);
  const double twice_area = normal.norm();
  const double a = side1.norm();  // node 1 at (a, 0), node 2 at (b, c) in the frame
  const Vec3 e1 = side1 / a;
  const Vec3 e2 = normal.cross(e1) / twice_area;
  const double b = side2.dot(e1);
  const double c = twice_area / a;
  return {e1, e2, twice_area / 2, 1 / a, -b / (a * c), 1 / c};
}

/// Principal values of F N F^T / J in the current plane, larger first; a1, a2 are the columns of F.
Vec<2> principal_cauchy(const Vec3& a1, const Vec3& a2, const Vec3& N) {
  const double f11 = a1.norm();
  const double f12 = a1.dot(a2) / f11;
  const double J = a1.cross(a2).norm();
  const double f22 = J / f11;
  const double s11 = (f11 * f11 * N[0] + 2 * f11 * f12 * N[2] + f12 * f12 * N[1]) / J;
  const double s12 = (f11 * N[2] + f12 * N[1]) * f22 / J;
  const double s22 = f22 * f22 * N[1] / J;
  const double mean = (s11 + s22) / 2;
  const double radius = std::sqrt((s11 - s22) * (s11 - s22) / 4 + s12 * s12);
  return {mean + radius, mean - radius};
}

/// @brief Tangent of the element from derivatives with respect to the displacement gradient.
///
/// P_ab = d^2 W / (dH_a dH_b), a, b = 1, 2; then K_ij = sum_ab g_ia g_jb P_ab. Nodes 1 and 2 are formed,
/// node 0 follows from the invariance under translation.
Mat<9> tangent_of(const Triangle& t, const Vec3& a1, const Vec3& a2, const Vec3& N,
                  const material::PlaneStressStiffness& D) {
  const Mat3 a11 = a1 * a1.transpose();
  const Mat3 a22 = a2 * a2.transpose();
  const Mat3 a12 = a1 * a2.transpose();
  const Mat3 I = Mat3::Identity();
  const Mat3 P11 = t.area * (D.direct * a11 + D.shear * a22 + N[0] * I);
  const Mat3 P22 = t.area * (D.direct * a22 + D.shear * a11 + N[1] * I);
  const Mat3 P12 = t.area * (D.coupling * a12 + D.shear * a12.transpose() + N[2] * I);

  const auto [p, q, r] = std::array{t.p, t.q, t.r};
  const Mat3 K11 = p * p * P11 + p * q * (P12 + P12.transpose()) + q * q * P22;
  const Mat3 K12 = r * (p * P12 + q * P22);
  const Mat3 K22 = r * r * P22;
  const Mat3 K01 = -(K11 + K12.transpose());
  const Mat3 K02 = -(K12 + K22);

  Mat<9> K;
  K.block<3, 3>(0, 0) = -(K01 + K02);
  K.block<3, 3>(0, 3) = K01;
  K.block<3, 3>(0, 6) = K02;
  K.block<3, 3>(3, 0) = K01.transpose();
  K.block<3, 3>(3, 3) = K11;
  K.block<3, 3>(3, 6) = K12;
  K.block<3, 3>(6, 0) = K02.transpose();
  K.block<3, 3>(6, 3) = K12.transpose();
  K.block<3, 3>(6, 6) = K22;
  return K;
}

}  // namespace

Mat3 membrane_frame(const Mat<3, 3>& x_ref) {
  const Triangle t = triangle(x_ref);
  Mat3 frame;
  frame << t.e1, t.e2, t.e1.cross(t.e2);
  return frame;
}

MembraneResponse evaluate_membrane(const MembraneSection& section, const Vec3& prestress,
                                   const Mat<3, 3>& x_ref, const Vec<9>& u, Want want) {
  const Triangle t = triangle(x_ref);
  const Vec3 u1 = u.segment<3>(3) - u.segment<3>(0);
  const Vec3 u2 = u.segment<3>(6) - u.segment<3>(0);
  const Vec3 h1 = t.p * u1;  // columns of the displacement gradient H = du/dX
  const Vec3 h2 = t.q * u1 + t.r * u2;
  const Vec3 a1 = t.e1 + h1;  // columns of the deformation gradient F
  const Vec3 a2 = t.e2 + h2;
  const Vec3 green_strain(t.e1.dot(h1) + h1.squaredNorm() / 2, t.e2.dot(h2) + h2.squaredNorm() / 2,
                          t.e1.dot(h2) + t.e2.dot(h1) + h1.dot(h2));
  const auto D = material::plane_stress_stiffness(section.tension_stiffness, section.poisson_ratio);
  const auto law = material::plane_stress(D, prestress, green_strain);
  const Vec3& N = law.pk2_resultant;

  MembraneResponse response;
  response.energy = t.area * law.energy_per_area;
  const Vec3 s1 = t.area * (N[0] * a1 + N[2] * a2);  // dW/dH
  const Vec3 s2 = t.area * (N[2] * a1 + N[1] * a2);
  const Vec3 f1 = t.p * s1 + t.q * s2;
  const Vec3 f2 = t.r * s2;
  response.force << -(f1 + f2), f1, f2;
  response.pk2_resultant = N;
  response.principal_cauchy = principal_cauchy(a1, a2, N);
  if (want == Want::tangent) response.tangent = tangent_of(t, a1, a2, N, D);
  return response;
}

Mat<9> membrane_mass(double mass_per_area, const Mat<3, 3>& x_ref) {
  const double twelfth = mass_per_area * triangle(x_ref).area / 12;
  Mat<9> mass;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      mass.block<3, 3>(3 * i, 3 * j) = (i == j ? 2 : 1) * twelfth * Mat3::Identity();
  return mass;
}

}  // namespace tautline::element
