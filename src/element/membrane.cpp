#include <array>
#include <cmath>

#include <tautline/element/membrane.hpp>
#include <tautline/material/plane_stress.hpp>

#include "detail/quadrilateral.hpp"

namespace tautline::element {

namespace {

/// Where the law is evaluated. The gradients of the shape functions add up to zero, so those of nodes 1, 2,
/// ... are enough; node 0 follows.
template <int N>
struct Point {
  Vec3 e1, e2;             ///< tangential axes of the reference surface
  double weight;           ///< area that the point stands for [m^2]
  Mat<2, N - 1> gradient;  ///< of the shape functions of nodes 1, 2, ..., along e1 and e2 [1/m]
};

Mat3 frame_of(const Mat<3, 4>& x_ref) {
  const Mat<3, 2> medians = x_ref * detail::bilinear_derivatives(0, 0).transpose();
  const Vec3 e1 = medians.col(0).normalized();
  const Vec3 e3 = medians.col(0).cross(medians.col(1)).normalized();
  Mat3 frame;
  frame << e1, e3.cross(e1), e3;
  return frame;
}

/// @brief Frame at a point with unit normal `n`: the element's frame, turned by the smallest rotation that
/// brings its normal there.
Mat<3, 2> carried_to(const Vec3& n, const Mat3& frame) {
  const Vec3 mid_normal = frame.col(2);
  const Vec3 bisector = (mid_normal + n) / (1 + mid_normal.dot(n));
  Mat<3, 2> axes;
  for (int a = 0; a < 2; ++a) axes.col(a) = frame.col(a) - frame.col(a).dot(n) * bisector;
  return axes;
}

Point<4> point_at(const Mat<3, 4>& x_ref, const Mat3& frame, double xi, double eta) {
  const Mat<2, 4> d = detail::bilinear_derivatives(xi, eta);
  const Mat<3, 2> g = x_ref * d.transpose();  // tangents of the coordinate lines
  const Vec3 normal = g.col(0).cross(g.col(1));
  const double area = normal.norm();
  const Mat<3, 2> axes = carried_to(normal / area, frame);
  const Mat<2> jacobian = g.transpose() * axes;
  return {axes.col(0), axes.col(1), area, jacobian.inverse() * d.rightCols<3>()};
}

/// One point in a triangle, node 1 at (a, 0) and node 2 at (b, c) in the frame.
std::array<Point<3>, 1> points_of(const Mat<3, 3>& x_ref) {
  const Vec3 side1 = x_ref.col(1) - x_ref.col(0);
  const Vec3 side2 = x_ref.col(2) - x_ref.col(0);
  const Vec3 normal = side1.cross(side2);
  const double twice_area = normal.norm();
  const double a = side1.norm();
  const Vec3 e1 = side1 / a;
  const Vec3 e2 = normal.cross(e1) / twice_area;
  const double b = side2.dot(e1);
  const double c = twice_area / a;
  Mat<2> gradient;
  gradient << 1 / a, 0, -b / (a * c), 1 / c;
  return {{{e1, e2, twice_area / 2, gradient}}};
}

/// 2 x 2 Gauss points in a quadrilateral.
std::array<Point<4>, 4> points_of(const Mat<3, 4>& x_ref) {
  const Mat3 frame = frame_of(x_ref);
  std::array<Point<4>, 4> points;
  for (int k = 0; k < 4; ++k)
    points[k] = point_at(x_ref, frame, detail::gauss_points[k][0], detail::gauss_points[k][1]);
  return points;
}

Mat3 frame_of(const Mat<3, 3>& x_ref) {
  const Point<3> p = points_of(x_ref)[0];
  Mat3 frame;
  frame << p.e1, p.e2, p.e1.cross(p.e2);
  return frame;
}

Point<3> centre_of(const Mat<3, 3>&, const std::array<Point<3>, 1>& points) {
  return points[0];
}

Point<4> centre_of(const Mat<3, 4>& x_ref, const std::array<Point<4>, 4>&) {
  return point_at(x_ref, frame_of(x_ref), 0, 0);
}

/// Displacements of nodes 1, 2, ... less that of node 0.
template <int N>
Mat<3, N - 1> relative(const Vec<3 * N>& u) {
  Mat<3, N - 1> result;
  for (int i = 1; i < N; ++i) result.col(i - 1) = u.template segment<3>(3 * i) - u.template head<3>();
  return result;
}

/// Motion at a point: columns of the deformation gradient, and the Green-Lagrange strain (E11, E22, 2 E12).
struct Deformation {
  Vec3 a1, a2;
  Vec3 green_strain;
};

template <int N>
Deformation deform(const Point<N>& p, const Mat<3, N - 1>& u) {
  const Vec3 h1 = u * p.gradient.row(0).transpose();  // columns of the displacement gradient
  const Vec3 h2 = u * p.gradient.row(1).transpose();
  return {p.e1 + h1, p.e2 + h2,
          Vec3(p.e1.dot(h1) + h1.squaredNorm() / 2, p.e2.dot(h2) + h2.squaredNorm() / 2,
               p.e1.dot(h2) + p.e2.dot(h1) + h1.dot(h2))};
}

/// Change of the strain by a small change of displacements.
template <int N>
Vec3 strain_rate(const Point<N>& p, const Deformation& F, const Mat<3, N - 1>& change) {
  const Vec3 h1 = change * p.gradient.row(0).transpose(), h2 = change * p.gradient.row(1).transpose();
  return {F.a1.dot(h1), F.a2.dot(h2), F.a1.dot(h2) + F.a2.dot(h1)};
}

/// The law at a strain, relaxed where the membrane wrinkles.
material::TensionFieldResponse respond(const MembraneLaw& law, const Vec3& green_strain) {
  if (law.wrinkling)
    return material::tension_field(law.stiffness, law.prestress, law.free_strain, green_strain);
  const auto elastic = material::plane_stress(law.stiffness, law.prestress, law.free_strain, green_strain);
  return {elastic.energy_per_area, elastic.pk2_resultant, law.stiffness, MembraneState::taut};
}

/// Principal values of F N F^T / J in the current plane, larger first; a1, a2 are the columns of F.
Vec<2> principal_cauchy(const Vec3& a1, const Vec3& a2, const Vec3& N) {
  if (N.isZero(0)) return Vec<2>::Zero();  // slack, perhaps collapsed to a line
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

/// Adds a point's share of the force on nodes 1, 2, ...
template <int N>
void add_force(const Point<N>& p, const Deformation& F, const Vec3& N_pk2, Mat<3, N - 1>& force) {
  Mat<3, 2> s;  // dW/dH
  s << p.weight * (N_pk2[0] * F.a1 + N_pk2[2] * F.a2), p.weight * (N_pk2[2] * F.a1 + N_pk2[1] * F.a2);
  force += s * p.gradient;
}

/// @brief Adds a point's share of the upper blocks of nodes 1, 2, ... to the tangent.
///
/// P_ab = d^2 W / (dH_a dH_b), a, b = 1, 2; then K_ij = sum_ab g_ia g_jb P_ab.
template <int N>
void add_tangent(const Point<N>& p, const Deformation& F, const Vec3& N_pk2, const Mat3& D, Mat<3 * N>& K) {
  const Mat3 a11 = F.a1 * F.a1.transpose();
  const Mat3 a22 = F.a2 * F.a2.transpose();
  const Mat3 a12 = F.a1 * F.a2.transpose();
  const Mat3 both = a12 + a12.transpose();
  const Mat3 I = Mat3::Identity();
  const Mat3 P11 = p.weight * (D(0, 0) * a11 + D(0, 2) * both + D(2, 2) * a22 + N_pk2[0] * I);
  const Mat3 P22 = p.weight * (D(1, 1) * a22 + D(1, 2) * both + D(2, 2) * a11 + N_pk2[1] * I);
  const Mat3 P12 =
      p.weight * (D(0, 1) * a12 + D(2, 2) * a12.transpose() + D(0, 2) * a11 + D(1, 2) * a22 + N_pk2[2] * I);
  for (int i = 1; i < N; ++i) {
    const double gi1 = p.gradient(0, i - 1), gi2 = p.gradient(1, i - 1);
    const Mat3 row1 = gi1 * P11 + gi2 * P12.transpose();
    const Mat3 row2 = gi1 * P12 + gi2 * P22;
    for (int j = i; j < N; ++j)
      K.template block<3, 3>(3 * i, 3 * j) += p.gradient(0, j - 1) * row1 + p.gradient(1, j - 1) * row2;
  }
}

/// Force on all nodes: node 0 from translation.
template <int N>
Vec<3 * N> with_first_node(const Mat<3, N - 1>& force) {
  Vec<3 * N> all;
  all << -force.rowwise().sum(), Eigen::Map<const Vec<3 * N - 3>>(force.data());
  return all;
}

/// Mirrors the upper blocks of nodes 1, 2, ... and fills in those of node 0 from translation.
template <int N>
void complete_tangent(Mat<3 * N>& K) {
  for (int i = 1; i < N; ++i)
    for (int j = i + 1; j < N; ++j)
      K.template block<3, 3>(3 * j, 3 * i) = K.template block<3, 3>(3 * i, 3 * j).transpose();
  Mat3 corner = Mat3::Zero();
  for (int j = 1; j < N; ++j) {
    Mat3 block = Mat3::Zero();
    for (int i = 1; i < N; ++i) block -= K.template block<3, 3>(3 * i, 3 * j);
    K.template block<3, 3>(0, 3 * j) = block;
    K.template block<3, 3>(3 * j, 0) = block.transpose();
    corner -= block;
  }
  K.template block<3, 3>(0, 0) = (corner + corner.transpose()) / 2;
}

Mat<9> mass_of(double mass_per_area, const Mat<3, 3>& x_ref) {
  const double twelfth = mass_per_area * points_of(x_ref)[0].weight / 12;
  Mat<9> mass;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      mass.block<3, 3>(3 * i, 3 * j) = (i == j ? 2 : 1) * twelfth * Mat3::Identity();
  return mass;
}

Mat<12> mass_of(double mass_per_area, const Mat<3, 4>& x_ref) {
  const auto points = points_of(x_ref);
  Mat<12> mass = Mat<12>::Zero();
  for (int k = 0; k < 4; ++k) {
    const Vec<4> shape = detail::bilinear(detail::gauss_points[k][0], detail::gauss_points[k][1]);
    const double share = mass_per_area * points[k].weight;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        mass.block<3, 3>(3 * i, 3 * j).diagonal().array() += share * shape[i] * shape[j];
  }
  return mass;
}

}  // namespace

MembraneLaw membrane_law(const MembraneSection& section, double angle, const Vec3& prestress,
                         double temperature_change) {
  const auto green = [&](double expansion) {  // free growth as a Green-Lagrange strain
    const double growth = expansion * temperature_change;
    return growth + growth * growth / 2;
  };
  const double expansion = green(section.thermal_expansion);
  const bool wrinkling = section.wrinkling && section.tension_stiffness > 0;
  if (!section.orthotropic())
    return {material::plane_stress_stiffness(section.tension_stiffness, section.poisson_ratio), prestress,
            Vec3(expansion, expansion, 0), wrinkling};
  const Mat3 D = material::plane_stress_stiffness({section.tension_stiffness, section.tension_stiffness_2,
                                                   section.poisson_ratio, section.shear_stiffness});
  const Mat3 to_material_axes = material::strain_rotation(angle);
  const Vec3 free_strain(expansion, green(section.thermal_expansion_2), 0);
  const Mat3 turned = to_material_axes.transpose() * D * to_material_axes;
  return {(turned + turned.transpose()) / 2, prestress, material::strain_rotation(-angle) * free_strain,
          wrinkling};
}

template <int N>
Mat3 membrane_frame(const Mat<3, N>& x_ref) {
  return frame_of(x_ref);
}

template <int N>
MembraneResponse<N> evaluate_membrane(const MembraneLaw& law, const Mat<3, N>& x_ref, const Vec<3 * N>& u,
                                      Want want) {
  const Mat<3, N - 1> u_relative = relative<N>(u);
  const auto points = points_of(x_ref);
  MembraneResponse<N> response;
  if (want == Want::tangent) response.tangent.setZero();
  Mat<3, N - 1> force = Mat<3, N - 1>::Zero();
  Vec3 resultant = Vec3::Zero();
  double area = 0;
  for (const Point<N>& p : points) {
    const Deformation F = deform(p, u_relative);
    const auto answer = respond(law, F.green_strain);
    response.energy += p.weight * answer.energy_per_area;
    resultant += p.weight * answer.pk2_resultant;
    area += p.weight;
    add_force(p, F, answer.pk2_resultant, force);
    if (want == Want::tangent) add_tangent(p, F, answer.pk2_resultant, answer.tangent, response.tangent);
    response.state = answer.state;
  }
  response.force = with_first_node<N>(force);
  if (want == Want::tangent) complete_tangent<N>(response.tangent);
  response.pk2_resultant = resultant / area;
  const Deformation centre = deform(centre_of(x_ref, points), u_relative);
  if (law.wrinkling && N > 3) response.state = respond(law, centre.green_strain).state;
  response.principal_cauchy = principal_cauchy(centre.a1, centre.a2, response.pk2_resultant);
  return response;
}

template <int N>
Extrapolated<3 * N> extrapolate_membrane(const MembraneLaw& law, const Mat<3, N>& x_ref,
                                         const Vec<3 * N>& before, const Vec<3 * N>& increment,
                                         const Vec<3 * N>& u) {
  const Mat<3, N - 1> last_u = relative<N>(before), step = relative<N>(increment), now_u = relative<N>(u);
  Extrapolated<3 * N> response;
  response.tangent.setZero();
  Mat<3, N - 1> force = Mat<3, N - 1>::Zero();
  for (const Point<N>& p : points_of(x_ref)) {
    const Deformation last = deform(p, last_u), F = deform(p, now_u);
    const auto there = respond(law, last.green_strain), here = respond(law, F.green_strain);
    const Vec3 pk2 = there.pk2_resultant + there.tangent * strain_rate(p, last, step);
    add_force(p, F, pk2, force);
    add_tangent(p, F, pk2, here.tangent, response.tangent);
  }
  response.force = with_first_node<N>(force);
  complete_tangent<N>(response.tangent);
  return response;
}

template <int N>
double membrane_area(const Mat<3, N>& x_ref) {
  double area = 0;
  for (const Point<N>& p : points_of(x_ref)) area += p.weight;
  return area;
}

template <int N>
Mat<3 * N> membrane_mass(double mass_per_area, const Mat<3, N>& x_ref) {
  return mass_of(mass_per_area, x_ref);
}

template Mat3 membrane_frame<3>(const Mat<3, 3>&);
template Mat3 membrane_frame<4>(const Mat<3, 4>&);
template MembraneResponse<3> evaluate_membrane<3>(const MembraneLaw&, const Mat<3, 3>&, const Vec<9>&, Want);
template MembraneResponse<4> evaluate_membrane<4>(const MembraneLaw&, const Mat<3, 4>&, const Vec<12>&, Want);
template Extrapolated<9> extrapolate_membrane<3>(const MembraneLaw&, const Mat<3, 3>&, const Vec<9>&,
                                                 const Vec<9>&, const Vec<9>&);
template Extrapolated<12> extrapolate_membrane<4>(const MembraneLaw&, const Mat<3, 4>&, const Vec<12>&,
                                                  const Vec<12>&, const Vec<12>&);
template double membrane_area<3>(const Mat<3, 3>&);
template double membrane_area<4>(const Mat<3, 4>&);
template Mat<9> membrane_mass<3>(double, const Mat<3, 3>&);
template Mat<12> membrane_mass<4>(double, const Mat<3, 4>&);

}  // namespace tautline::element
