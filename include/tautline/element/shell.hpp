#pragma once
/// @file
/// Three- and four-node shells of finite displacement and rotation. Theory: docs/theory/shell.md

#include <array>

#include <tautline/core/types.hpp>
#include <tautline/element/extrapolated.hpp>
#include <tautline/element/want.hpp>

namespace tautline::element {

/// Homogeneous isotropic shell.
struct ShellSection {
  double young_modulus = 0;      ///< [Pa]
  double poisson_ratio = 0;      ///< [-]
  double thickness = 0;          ///< [m]
  double density = 0;            ///< [kg/m^3]
  double shear_factor = 5. / 6;  ///< [-]
  double thermal_expansion = 0;  ///< [1/K]
};

/// A shell element of N = 3 or 4 nodes in its reference configuration.
template <int N>
struct ShellGeometry {
  Mat<3, N> x_ref;                ///< mid-surface, column = node [m]
  Mat<3, N> director;             ///< unit normals of the mid-surface at the nodes (averaged over neighbours)
  Vec3 prestress = Vec3::Zero();  ///< membrane resultants N11, N22, N12 in shell_frame, present at rest [N/m]
  double free_strain = 0;         ///< in-plane strain without stress, e.g. thermal [-]
};

template <int N>
struct ShellMotion {
  Mat<3, N> u = Mat<3, N>::Zero();  ///< displacements from the reference configuration [m]
  std::array<Mat3, N> rotation;     ///< rotations from it; orthogonal, global frame
};

/// Stress resultants at the centre, in axes 1, 2 of the current mid-surface (frame carried along).
struct ShellForces {
  Vec3 membrane{0, 0, 0};  ///< N11, N22, N12, second Piola-Kirchhoff [N/m]
  Vec3 moment{0, 0, 0};    ///< M11, M22, M12, positive: tension where the director points [N m/m]
  Vec<2> shear{0, 0};      ///< Q1, Q2, positive: along the director on a face of normal 1, 2 [N/m]
};

template <int N>
struct ShellResponse {
  double energy = 0;   ///< [J]
  Vec<6 * N> force;    ///< internal force, order (f1, m1, f2, m2, ...), moments conjugate to spatial spins
  Mat<6 * N> tangent;  ///< symmetrised, see docs/theory/conventions.md; untouched unless wanted
  ShellForces forces;
};

/// Frame of the reference mid-surface at the centre: axis 1 along the first side of a triangle, or along the
/// line that joins the middles of the sides 4-1 and 2-3 of a quadrilateral, axis 3 normal; columns.
template <int N>
Mat3 shell_frame(const Mat<3, N>& x_ref);

/// @brief Energy, internal force, tangent and stress resultants of a shell.
///
/// Membrane, bending and transverse shear strains of an inextensible director carried by the nodes'
/// rotations; small strains, displacements and rotations of any size.
template <int N>
ShellResponse<N> evaluate_shell(const ShellSection& section, const ShellGeometry<N>& geometry,
                                const ShellMotion<N>& motion, Want want);

/// Force and tangent after a motion from `before` to `motion` that was `increment` to first order, order as
/// the tangent's.
template <int N>
Extrapolated<6 * N> extrapolate_shell(const ShellSection& section, const ShellGeometry<N>& geometry,
                                      const ShellMotion<N>& before, const Vec<6 * N>& increment,
                                      const ShellMotion<N>& motion);

/// Reference area [m^2].
template <int N>
double shell_area(const Mat<3, N>& x_ref);

/// Consistent mass matrix, order as the tangent's; the same in every configuration [kg, kg m^2].
template <int N>
Mat<6 * N> shell_mass(const ShellSection& section, const Mat<3, N>& x_ref);

}  // namespace tautline::element
