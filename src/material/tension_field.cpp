#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <tautline/material/plane_stress.hpp>
#include <tautline/material/tension_field.hpp>

namespace tautline::material {

namespace {

/// No principal value of N is negative: N lies in the cone of tensions, trace >= 0 and det >= 0.
bool pulls_everywhere(const Vec3& N) {
  return N[0] + N[1] >= 0 && N[0] * N[1] >= N[2] * N[2];
}

/// @brief Axes y in which both the complementary energy and the determinant of N are diagonal.
///
/// N = V y with N : C : N = y . y (C = D^-1) and det N = j (y_1^2 - k_1 y_2^2 - k_2 y_3^2), j > 0; tensions
/// are those with y_1 >= sqrt(k_1 y_2^2 + k_2 y_3^2).
struct ConeAxes {
  Mat3 V, inverse;
  Vec<2> k;  ///< positive; both (1 - nu)/(1 + nu) in an isotropic sheet
};

/// Isotropic sheet, or one that is alike along axes 1 and 2: mean, difference and shear of N are the axes.
ConeAxes cone_axes_of_alike(const Mat3& D) {
  const double mean = (D(0, 0) + D(0, 1)) / 2, difference = (D(0, 0) - D(0, 1)) / 2, shear = D(2, 2);
  const double a = std::sqrt(mean), b = std::sqrt(difference), c = std::sqrt(shear);
  Mat3 V, inverse;
  V << a, b, 0, a, -b, 0, 0, 0, c;
  inverse << 0.5 / a, 0.5 / a, 0, 0.5 / b, -0.5 / b, 0, 0, 0, 1 / c;
  return {V, inverse, Vec<2>(difference, shear) / mean};
}

ConeAxes cone_axes(const Mat3& D) {
  if (D(0, 0) == D(1, 1) && D(0, 2) == 0 && D(1, 2) == 0) return cone_axes_of_alike(D);
  const Mat3 L = D.llt().matrixL();
  Mat3 determinant;
  determinant << 0, 0.5, 0, 0.5, 0, 0, 0, 0, -1;  // det N = N . (determinant N)
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(L.transpose() * determinant * L);
  const Vec3& j = eigen.eigenvalues();  // increasing: two negative, one positive
  Mat3 Q;
  Q << eigen.eigenvectors().col(2), eigen.eigenvectors().leftCols<2>();
  Mat3 V = L * Q;
  if (V(0, 0) + V(1, 0) < 0) V.col(0) = -V.col(0);
  return {V, V.inverse(), -j.head<2>() / j[2]};
}

/// @brief First coordinate of the point of the cone's surface that is nearest to e.
///
/// Root of 1 = sum of k_i e_i^2 / ((1 + k_i) y - k_i e_1)^2, i = 2, 3, beyond max(0, e_1). The sum falls with
/// y. Newton's method on sum^(-1/2), which is concave, climbs to the root; where both k are equal it is a
/// straight line, and one step is enough. It starts from the larger root of the single terms.
double nearest_on_cone(const Vec3& e, const Vec<2>& k) {
  const Vec<2> part = k.cwiseSqrt().cwiseProduct(e.tail<2>()).cwiseAbs();
  double y = std::max({0., e[0], (part[0] + k[0] * e[0]) / (1 + k[0]), (part[1] + k[1] * e[0]) / (1 + k[1])});
  const double rounding = 1e-16 * (std::abs(e[0]) + part.sum());
  for (int iteration = 0; iteration < 50; ++iteration) {
    double sum = 0, slope = 0;
    for (int i = 0; i < 2; ++i) {
      const double denominator = (1 + k[i]) * y - k[i] * e[0];
      const double ratio = part[i] / denominator;
      sum += ratio * ratio;
      slope += ratio * ratio * (1 + k[i]) / denominator;
    }
    const double step = sum * (std::sqrt(sum) - 1) / slope;
    y += std::max(step, 0.);
    if (!(step > rounding)) break;
  }
  return y;
}

bool no_tension_is_nearest(const Vec3& e, const Vec<2>& k) {
  return e[0] <= 0 && e[1] * e[1] / k[0] + e[2] * e[2] / k[1] <= e[0] * e[0];
}

/// Tangent of the projection on the surface of the cone: tension along the rays, and the turning of the rays.
Mat3 surface_tangent(const ConeAxes& axes, const Vec3& e, const Vec3& y) {
  const Vec<2>& k = axes.k;
  const Vec3 ray = y.normalized();
  const Vec3 normal(ray[0], -k[0] * ray[1], -k[1] * ray[2]);
  const Vec3 turn = ray.cross(normal);
  const double curvature = k[0] * turn[1] * turn[1] + k[1] * turn[2] * turn[2] - turn[0] * turn[0];
  const double turning = turn.squaredNorm() + (1 - e[0] / y[0]) * curvature;
  const Vec3 along = axes.V * ray, across = axes.V * turn;
  return along * along.transpose() + across * across.transpose() / turning;
}

}  // namespace

TensionFieldResponse tension_field(const Mat3& stiffness, const Vec3& prestress, const Vec3& free_strain,
                                   const Vec3& green_strain) {
  const auto taut = plane_stress(stiffness, prestress, free_strain, green_strain);
  if (pulls_everywhere(taut.pk2_resultant))
    return {taut.energy_per_area, taut.pk2_resultant, stiffness, TensionState::taut};

  const ConeAxes axes = cone_axes(stiffness);
  const Vec3 e = axes.inverse * taut.pk2_resultant;
  const double energy_of_slack = prestress.dot(free_strain) - (axes.inverse * prestress).squaredNorm() / 2;
  if (no_tension_is_nearest(e, axes.k))
    return {energy_of_slack, Vec3::Zero(), Mat3::Zero(), TensionState::slack};

  Vec3 y;
  y[0] = nearest_on_cone(e, axes.k);
  if (!(y[0] > 1e-15 * e.norm()))  // on the border of the two, within rounding: a side that keeps its length
    return {energy_of_slack, Vec3::Zero(), Mat3::Zero(), TensionState::slack};
  for (int i = 0; i < 2; ++i) y[i + 1] = e[i + 1] * y[0] / ((1 + axes.k[i]) * y[0] - axes.k[i] * e[0]);
  return {energy_of_slack + y.squaredNorm() / 2, axes.V * y, surface_tangent(axes, e, y),
          TensionState::wrinkled};
}

}  // namespace tautline::material
