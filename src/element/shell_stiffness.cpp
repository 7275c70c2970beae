#include "detail/shell_stiffness.hpp"

namespace tautline::element::detail {

namespace {

/// Stiffness of N nodes against drilling in units of G h; docs/theory/shell.md#drilling
template <int N>
constexpr double drilling_factor = N == 4 ? 0.03 : 0.01;
/// Stiffness against the curl of a triangle's director field in units of its bending stiffness.
constexpr double curl_factor = 0.1;

/// Tangents g_r, g_s at a point of the mid-surface, seen from axes 1 along g_r and 2 in the plane.
struct Basis {
  double jacobian;  ///< |g_r x g_s|
  Mat3 strain;      ///< (rr, ss, 2 rs) covariant to (11, 22, 2 12)
  Mat<2> shear;     ///< covariant to axes 1, 2
};

Basis basis(const Vec3& g_r, const Vec3& g_s) {
  const double length = g_r.norm();
  const double along = g_r.dot(g_s) / length;
  const double across = g_r.cross(g_s).norm() / length;
  const double a = 1 / length;  // contravariant tangents: (a, b) and (0, c)
  const double b = -along / (length * across);
  const double c = 1 / across;
  Basis result{length * across, {}, {}};
  result.strain << a * a, 0, 0, b * b, c * c, b * c, 2 * a * b, 0, a * c;
  result.shear << a, 0, b, c;
  return result;
}

/// Plane stress, for strains (11, 22, 2 12), without the factor E.
Mat3 plane_stress(double nu) {
  Mat3 D;
  D << 1, nu, 0, nu, 1, 0, 0, 0, (1 - nu) / 2;
  return D / (1 - nu * nu);
}

/// Stiffnesses of the section; membrane and bending for strains (11, 22, 2 12).
struct Rigidity {
  Mat3 membrane, bending;
  double young, transverse_shear, in_plane_shear;
};

Rigidity rigidity(const ShellSection& s) {
  const double h = s.thickness;
  const double G = s.young_modulus / (2 * (1 + s.poisson_ratio));
  const Mat3 D = s.young_modulus * plane_stress(s.poisson_ratio);
  return {h * D, h * h * h / 12 * D, s.young_modulus * h, s.shear_factor * G * h, G * h};
}

/// Points and unit weights of the 2 x 2 Gauss rule.
constexpr double gauss = 0.57735026918962576451;
constexpr std::array<std::array<double, 2>, 4> gauss_points{
    {{-gauss, -gauss}, {gauss, -gauss}, {gauss, gauss}, {-gauss, gauss}}};

/// Strain at the centre and its two linear modes (rr, ss, 2 rs, hourglass r, hourglass s) by the five
/// membrane strains. Ko, Lee & Bathe (2017): x_d . u_d is expressed by edges and centre as if the element
/// were flat.
Mat<5> centre_and_hourglass(const ShellModes<4>& x) {
  using T = ShellTable<4>;
  const Vec3 xr = x.col(T::yr), xs = x.col(T::ys), xd = x.col(T::yd);
  const double rr = xr.squaredNorm(), ss = xs.squaredNorm(), rs = xr.dot(xs);
  const double det = rr * ss - rs * rs;
  const double cr = (ss * xr.dot(xd) - rs * xs.dot(xd)) / det;
  const double cs = (rr * xs.dot(xd) - rs * xr.dot(xd)) / det;
  Mat<1, 5> q;
  q << cr * cr, cs * cs, cr * cs, -cr, -cs;
  q /= cr * cr + cs * cs - 1;
  Mat<5> map = Mat<5>::Identity();
  map.row(0) -= q;
  map.row(1) -= q;
  map.row(3) -= 2 * cr * map.row(0) + cs * map.row(2);
  map.row(4) -= 2 * cs * map.row(1) + cr * map.row(2);
  return map;
}

void add_membrane(const Rigidity& k, const Basis& centre, const ShellModes<4>& x, double area,
                  const Vec3& prestress, ShellStiffness<4>& result) {
  using T = ShellTable<4>;
  const Mat<5> map = centre_and_hourglass(x);
  const Mat<3, 5> strain = centre.strain * map.topRows<3>();
  result.membrane_force = k.membrane * strain;
  result.membrane = area * strain.transpose() * result.membrane_force;
  for (const int hourglass : {0, 1}) {
    const double side = x.col(hourglass == 0 ? T::yr : T::ys).squaredNorm();
    result.membrane +=
        k.young * area / (3 * side * side) * map.row(3 + hourglass).transpose() * map.row(3 + hourglass);
  }
  result.prestress = area * strain.transpose() * prestress;
  // a strain g_rr = s c of a rectangle makes its sides s = const turn by -c dr/jacobian
  for (int i = 0; i < 4; ++i)
    result.rotation_of_node.row(i) =
        4 / centre.jacobian * (T::weight[T::ys][i] * map.row(4) - T::weight[T::yr][i] * map.row(3));
}

/// Curvatures (rr, ss, 2 rs) at (r, s) by the strains of the table.
Mat<3, 6> curvature_at(double r, double s) {
  Mat<3, 6> map;
  map << 1, 0, 0, s, 0, s * s,  //
      0, 1, 0, 0, r, r * r,     //
      0, 0, 1, r, s, 2 * r * s;
  return map;
}

/// Shears (r, s) at (r, s): linear between the middles of opposite edges (Dvorkin & Bathe 1984).
Mat<2, 4> shear_at(double r, double s) {
  Mat<2, 4> map;
  map << 1, s, 0, 0, 0, 0, 1, r;
  return map;
}

Basis basis_at(const ShellModes<4>& x, double r, double s) {
  using T = ShellTable<4>;
  return basis(x.col(T::yr) + s * x.col(T::yd), x.col(T::ys) + r * x.col(T::yd));
}

}  // namespace

template <>
double area_of<4>(const ShellModes<4>& reference) {
  double area = 0;
  for (const auto& [r, s] : gauss_points) area += basis_at(reference, r, s).jacobian;
  return area;
}

template <>
double area_of<3>(const ShellModes<3>& reference) {
  using T = ShellTable<3>;
  return reference.col(T::yr).cross(reference.col(T::ys)).norm() / 2;
}

template <>
Mat<4> shape_products<4>(const ShellModes<4>& reference) {
  Mat<4> products = Mat<4>::Zero();
  for (const auto& [r, s] : gauss_points) {
    const Vec<4> shape =
        Vec<4>((1 - r) * (1 - s), (1 + r) * (1 - s), (1 + r) * (1 + s), (1 - r) * (1 + s)) / 4;
    products += basis_at(reference, r, s).jacobian * shape * shape.transpose();
  }
  return products;
}

template <>
Mat3 shape_products<3>(const ShellModes<3>& reference) {
  return area_of<3>(reference) / 12 * (Mat3::Ones() + Mat3::Identity());
}

template <>
ShellStiffness<4> shell_stiffness<4>(const ShellSection& section, const ShellModes<4>& reference,
                                     const Vec3& prestress) {
  const Rigidity k = rigidity(section);
  ShellStiffness<4> result;
  result.bending.setZero();
  result.shear.setZero();
  double area = 0;
  for (const auto& [r, s] : gauss_points) {
    const Basis at = basis_at(reference, r, s);
    const Mat<3, 6> curvature = at.strain * curvature_at(r, s);
    const Mat<2, 4> shear = at.shear * shear_at(r, s);
    result.bending += at.jacobian * curvature.transpose() * (k.bending * curvature);
    result.shear += at.jacobian * k.transverse_shear * shear.transpose() * shear;
    area += at.jacobian;
  }
  const Basis centre = basis_at(reference, 0, 0);
  add_membrane(k, centre, reference, area, prestress, result);
  result.drilling = drilling_factor<4> * k.in_plane_shear * area / 4;
  result.moment = k.bending * (centre.strain * curvature_at(0, 0));
  result.shear_force = k.transverse_shear * (centre.shear * shear_at(0, 0));
  return result;
}

namespace {

/// @brief Transverse shear compliance of a triangle in its axes [m/N], softened by a bubble.
///
/// The bubble 27 l1 l2 l3 of the director (Lee, Lee & Bathe 2014) has no mean curvature and shears the
/// element uniformly by half its height; its height is eliminated. The integrals of the products of its
/// derivatives are 4.05 area times the sum of g_i g_i^T over the gradients g_i of the area coordinates.
Mat<2> shear_compliance(const Rigidity& k, const Basis& b) {
  const Mat<2> gradients = b.shear * (Mat<2>() << 2, 1, 1, 2).finished() * b.shear.transpose();
  const double flexural = k.bending(0, 0);
  const double nu = k.bending(0, 1) / flexural;
  const Mat<2> bending_of_bubble =
      4.05 * flexural * ((1 + nu) / 2 * gradients + (1 - nu) / 2 * gradients.trace() * Mat<2>::Identity());
  return Mat<2>::Identity() / k.transverse_shear + bending_of_bubble.inverse() / 4;
}

}  // namespace

template <>
ShellStiffness<3> shell_stiffness<3>(const ShellSection& section, const ShellModes<3>& reference,
                                     const Vec3& prestress) {
  using T = ShellTable<3>;
  const Rigidity k = rigidity(section);
  const Basis b = basis(reference.col(T::yr), reference.col(T::ys));
  const double area = b.jacobian / 2;
  ShellStiffness<3> result;
  result.membrane_force = k.membrane * b.strain;
  result.membrane = area * b.strain.transpose() * result.membrane_force;
  result.prestress = area * b.strain.transpose() * prestress;
  result.moment = k.bending * b.strain;
  result.bending = area * b.strain.transpose() * result.moment;

  result.shear_force << shear_compliance(k, b).inverse() * b.shear, Vec<2>::Zero();
  result.shear.setZero();
  result.shear.topLeftCorner<2, 2>() = area * b.shear.transpose() * result.shear_force.leftCols<2>();
  const Mat<2> metric = b.shear.transpose() * b.shear;  // contravariant
  const double by_shear = k.transverse_shear * area / 18 * (metric(0, 0) + metric(1, 1) + metric(0, 1));
  const double by_bending = curl_factor * k.bending(0, 0) * 4 * area / (b.jacobian * b.jacobian);
  result.shear(2, 2) = by_shear * by_bending / (by_shear + by_bending);
  result.drilling = drilling_factor<3> * k.in_plane_shear * area / 3;
  result.rotation_of_node.setZero();
  return result;
}

}  // namespace tautline::element::detail
