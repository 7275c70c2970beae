#include <tautline/element/shell.hpp>

#include <cmath>

#include "detail/rotation.hpp"
#include "detail/shell_drilling.hpp"
#include "detail/shell_stiffness.hpp"
#include "detail/shell_strains.hpp"

namespace tautline::element {

namespace {

using detail::n_shell_strains;
using detail::shell_modes;
using detail::ShellModes;
using detail::ShellStiffness;
using detail::ShellTable;
using detail::skew;

/// Strains of the table, then the drilling strains of the nodes; or derivatives of them, one row for each.
template <int N>
constexpr int n_rows = n_shell_strains<N> + N;
template <int N, int Columns>
using Rows = Mat<n_rows<N>, Columns>;

/// @brief Stiffness times strains, or times derivatives of strains.
///
/// A node's drilling strain is its angle plus what the linear membrane strains turn the mid-surface there.
template <int N, int Columns>
Rows<N, Columns> stiffness_times(const ShellStiffness<N>& k, const Rows<N, Columns>& e) {
  using Table = ShellTable<N>;
  constexpr int membrane = Table::n_membrane, bending = Table::n_bending, shear = Table::n_shear;
  const auto m = e.template topRows<membrane>();
  Rows<N, Columns> result;
  auto drilling = result.template bottomRows<N>();
  drilling = k.drilling * (e.template bottomRows<N>() + k.rotation_of_node * m);
  result.template topRows<membrane>() = k.membrane * m + k.rotation_of_node.transpose() * drilling;
  result.template middleRows<bending>(membrane) = k.bending * e.template middleRows<bending>(membrane);
  result.template middleRows<shear>(membrane + bending) =
      k.shear * e.template middleRows<shear>(membrane + bending);
  return result;
}

/// A shell in motion, everything that energy, force and tangent are made of.
template <int N>
struct Configuration {
  Mat<3, N> director;  ///< current
  ShellModes<N> v;     ///< current
  std::array<detail::DrillingAngle, N> angle;
  ShellStiffness<N> stiffness;
  Rows<N, 1> strain, stress;
  double energy;
};

/// Changes of the directors, (R - I) D.
template <int N>
Mat<3, N> director_increments(const ShellGeometry<N>& geometry, const ShellMotion<N>& motion) {
  Mat<3, N> increments;
  for (int i = 0; i < N; ++i)
    increments.col(i) = (motion.rotation[i] - Mat3::Identity()) * geometry.director.col(i);
  return increments;
}

/// Strains of the table, between the shape that the element would take freely and the present one.
template <int N>
Vec<n_shell_strains<N>> strains_from_free_shape(ShellModes<N> reference, ShellModes<N> change,
                                                double free_strain) {
  constexpr int n = ShellTable<N>::n_position_modes;
  const double growth = 2 * free_strain / (1 + std::sqrt(1 + 2 * free_strain));
  change.template leftCols<n>() -= growth * reference.template leftCols<n>();
  reference.template leftCols<n>() *= 1 + growth;
  return detail::shell_strains<N>(reference, change);
}

template <int N>
Configuration<N> configuration(const ShellSection& section, const ShellGeometry<N>& geometry,
                               const ShellMotion<N>& motion) {
  Configuration<N> c;
  const Mat<3, N> increments = director_increments(geometry, motion);
  const ShellModes<N> x = shell_modes<N>(geometry.x_ref, geometry.director);
  const ShellModes<N> change = shell_modes<N>(motion.u, increments);
  c.director = geometry.director + increments;
  c.v = x + change;
  c.angle = detail::drilling_angles(geometry, motion, x, change);
  c.stiffness = detail::shell_stiffness<N>(section, x, geometry.prestress);

  c.strain.template head<n_shell_strains<N>>() = strains_from_free_shape<N>(x, change, geometry.free_strain);
  for (int i = 0; i < N; ++i) c.strain[n_shell_strains<N> + i] = c.angle[i].value;
  c.stress = stiffness_times<N, 1>(c.stiffness, c.strain);
  constexpr int membrane = ShellTable<N>::n_membrane;
  c.energy = c.stress.dot(c.strain) / 2 + c.stiffness.prestress.dot(c.strain.template head<membrane>());
  c.stress.template head<membrane>() += c.stiffness.prestress;
  return c;
}

/// Derivatives of the strains of the table by the modes, row = strain.
template <int N>
Mat<n_shell_strains<N>, 3 * ShellTable<N>::n_modes> by_modes(const ShellModes<N>& v) {
  Mat<n_shell_strains<N>, 3 * ShellTable<N>::n_modes> gradient;
  gradient.setZero();
  for (const auto [k, m, n, factor] : ShellTable<N>::terms) {
    gradient.template block<1, 3>(k, 3 * m) += factor * v.col(n).transpose();
    gradient.template block<1, 3>(k, 3 * n) += factor * v.col(m).transpose();
  }
  return gradient;
}

/// Derivatives of the strains by displacements and spins.
template <int N>
Rows<N, 6 * N> strain_gradient(const Configuration<N>& c) {
  using Table = ShellTable<N>;
  constexpr int n = n_shell_strains<N>;
  const auto gradient = by_modes<N>(c.v);
  Rows<N, 6 * N> B;
  for (int i = 0; i < N; ++i) {
    Mat<n, 3> by_position = Mat<n, 3>::Zero();
    Mat<n, 3> by_director = Mat<n, 3>::Zero();
    for (int k = 0; k < Table::n_modes; ++k)
      (k < Table::n_position_modes ? by_position : by_director) +=
          Table::weight[k][i] * gradient.template middleCols<3>(3 * k);
    B.template block<n, 3>(0, 6 * i) = by_position;
    B.template block<n, 3>(0, 6 * i + 3) = -by_director * skew(c.director.col(i));
    B.row(n + i) = detail::drilling_row<N>(c.angle[i], i, c.v);
  }
  return B;
}

/// Second derivatives, contracted with the stresses, of the strains by nodal positions and directors: each
/// block of two nodes is a multiple of the identity.
template <int N>
struct DirectorHessian {
  Mat<N> position_position, position_director, director_director;
  Mat<3, N> by_director;  ///< first derivatives of the energy by the directors
};

template <int N>
DirectorHessian<N> director_hessian(const Configuration<N>& c) {
  using Table = ShellTable<N>;
  constexpr int n = Table::n_modes, nx = Table::n_position_modes, nd = n - nx;
  Mat<n> modes = Mat<n>::Zero();
  for (const auto [k, a, b, factor] : Table::terms) {
    modes(a, b) += factor * c.stress[k];
    modes(b, a) += factor * c.stress[k];
  }
  const Eigen::Map<const Eigen::Matrix<double, n, N, Eigen::RowMajor>> weight(Table::weight[0].data());
  const auto x = weight.template topRows<nx>();
  const auto d = weight.template bottomRows<nd>();
  return {x.transpose() * modes.template topLeftCorner<nx, nx>() * x,
          x.transpose() * modes.template topRightCorner<nx, nd>() * d,
          d.transpose() * modes.template bottomRightCorner<nd, nd>() * d,
          c.v * modes.template rightCols<nd>() * d};
}

/// Adds stresses times the symmetrised second derivatives of the strains.
template <int N>
void add_geometric_tangent(const Configuration<N>& c, Mat<6 * N>& K) {
  const DirectorHessian<N> h = director_hessian(c);
  for (int i = 0; i < N; ++i) {
    const Vec3 d_i = c.director.col(i);
    for (int j = 0; j < N; ++j) {
      const Vec3 d_j = c.director.col(j);
      K.template block<3, 3>(6 * i, 6 * j).diagonal().array() += h.position_position(i, j);
      K.template block<3, 3>(6 * i, 6 * j + 3) -= h.position_director(i, j) * skew(d_j);
      K.template block<3, 3>(6 * i + 3, 6 * j) += h.position_director(j, i) * skew(d_i);
      Mat3 spins = -d_j * d_i.transpose();  // -skew(d_i) skew(d_j) = d_i . d_j I - d_j d_i^T
      spins.diagonal().array() += d_i.dot(d_j);
      K.template block<3, 3>(6 * i + 3, 6 * j + 3) += h.director_director(i, j) * spins;
    }
    K.template block<3, 3>(6 * i + 3, 6 * i + 3) += detail::second_spin_derivative(h.by_director.col(i), d_i);
    detail::add_drilling_curvature<N>(c.angle[i], i, c.v, c.stress[n_shell_strains<N> + i], K);
  }
}

template <int N>
Mat<6 * N> tangent_of(const Configuration<N>& c, const Rows<N, 6 * N>& B) {
  Mat<6 * N> K = B.transpose() * stiffness_times<N, 6 * N>(c.stiffness, B);
  add_geometric_tangent(c, K);
  return (K + K.transpose()) / 2;  // what rounding left
}

template <int N>
ShellForces centre_forces(const Configuration<N>& c, const Vec3& prestress) {
  using Table = ShellTable<N>;
  constexpr int membrane = Table::n_membrane, bending = Table::n_bending, shear = Table::n_shear;
  ShellForces forces;
  forces.membrane = prestress + c.stiffness.membrane_force * c.strain.template head<membrane>();
  forces.moment = c.stiffness.moment * c.strain.template segment<bending>(membrane);
  forces.shear = c.stiffness.shear_force * c.strain.template segment<shear>(membrane + bending);
  return forces;
}

}  // namespace

template <int N>
Mat3 shell_frame(const Mat<3, N>& x_ref) {
  using Table = ShellTable<N>;
  const ShellModes<N> x = shell_modes<N>(x_ref, Mat<3, N>::Zero());
  const Vec3 axis1 = x.col(Table::yr).normalized();
  const Vec3 axis3 = x.col(Table::yr).cross(x.col(Table::ys)).normalized();
  Mat3 frame;
  frame << axis1, axis3.cross(axis1), axis3;
  return frame;
}

template <int N>
ShellResponse<N> evaluate_shell(const ShellSection& section, const ShellGeometry<N>& geometry,
                                const ShellMotion<N>& motion, Want want) {
  const Configuration<N> c = configuration(section, geometry, motion);
  const Rows<N, 6 * N> B = strain_gradient(c);
  ShellResponse<N> response;
  response.energy = c.energy;
  response.force = B.transpose() * c.stress;
  response.forces = centre_forces(c, geometry.prestress);
  if (want == Want::tangent) response.tangent = tangent_of(c, B);
  return response;
}

template <int N>
Extrapolated<6 * N> extrapolate_shell(const ShellSection& section, const ShellGeometry<N>& geometry,
                                      const ShellMotion<N>& before, const Vec<6 * N>& increment,
                                      const ShellMotion<N>& motion) {
  const Configuration<N> last = configuration(section, geometry, before);
  const Rows<N, 1> change = strain_gradient(last) * increment;
  Configuration<N> c = configuration(section, geometry, motion);
  c.stress = last.stress + stiffness_times<N, 1>(last.stiffness, change);
  const Rows<N, 6 * N> B = strain_gradient(c);
  return {B.transpose() * c.stress, tangent_of(c, B)};
}

template <int N>
double shell_area(const Mat<3, N>& x_ref) {
  return detail::area_of<N>(shell_modes<N>(x_ref, Mat<3, N>::Zero()));
}

template <int N>
Mat<6 * N> shell_mass(const ShellSection& section, const Mat<3, N>& x_ref) {
  const double h = section.thickness;
  const Mat<N> shapes = detail::shape_products<N>(shell_modes<N>(x_ref, Mat<3, N>::Zero()));
  Mat<6 * N> mass = Mat<6 * N>::Zero();
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) {
      const double m = section.density * h * shapes(i, j);
      mass.template block<3, 3>(6 * i, 6 * j).diagonal().setConstant(m);
      mass.template block<3, 3>(6 * i + 3, 6 * j + 3).diagonal().setConstant(m * h * h / 12);
    }
  }
  return mass;
}

template Mat3 shell_frame<3>(const Mat<3, 3>&);
template Mat3 shell_frame<4>(const Mat<3, 4>&);
template ShellResponse<3> evaluate_shell<3>(const ShellSection&, const ShellGeometry<3>&,
                                            const ShellMotion<3>&, Want);
template ShellResponse<4> evaluate_shell<4>(const ShellSection&, const ShellGeometry<4>&,
                                            const ShellMotion<4>&, Want);
template Extrapolated<18> extrapolate_shell<3>(const ShellSection&, const ShellGeometry<3>&,
                                               const ShellMotion<3>&, const Vec<18>&, const ShellMotion<3>&);
template Extrapolated<24> extrapolate_shell<4>(const ShellSection&, const ShellGeometry<4>&,
                                               const ShellMotion<4>&, const Vec<24>&, const ShellMotion<4>&);
template double shell_area<3>(const Mat<3, 3>&);
template double shell_area<4>(const Mat<3, 4>&);
template Mat<18> shell_mass<3>(const ShellSection&, const Mat<3, 3>&);
template Mat<24> shell_mass<4>(const ShellSection&, const Mat<3, 4>&);

}  // namespace tautline::element
