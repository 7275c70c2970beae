#pragma once
/// @file
/// Three- and four-node prestressed membranes of finite displacement. Theory: docs/theory/membrane.md

#include <tautline/core/types.hpp>
#include <tautline/element/extrapolated.hpp>
#include <tautline/element/want.hpp>
#include <tautline/material/tension_field.hpp>

namespace tautline::element {

/// Membrane of a group; stiffnesses and stresses per unit of width, in the material axes 1 and 2.
struct MembraneSection {
  double tension_stiffness = 0;    ///< E1 h [N/m]
  double poisson_ratio = 0;        ///< nu12: contraction along 2 under stress along 1
  double mass_per_area = 0;        ///< [kg/m^2]
  double tension_stiffness_2 = 0;  ///< E2 h [N/m]; 0: isotropic
  double shear_stiffness = 0;      ///< G12 h [N/m]; read where the section is orthotropic
  double thermal_expansion = 0;    ///< along axis 1 [1/K]
  double thermal_expansion_2 = 0;  ///< along axis 2 [1/K]; isotropic sections use the first for both
  bool wrinkling = false;          ///< carries no compression: relaxed energy of tension field theory
  bool orthotropic() const { return tension_stiffness_2 > 0; }
};

/// Law of one membrane element, in its own frame: N = N0 + D (E - E0).
struct MembraneLaw {
  Mat3 stiffness;                   ///< D, for strains (E11, E22, 2 E12) [N/m]; symmetric
  Vec3 prestress = Vec3::Zero();    ///< N0: N11, N22, N12 present in the reference configuration [N/m]
  Vec3 free_strain = Vec3::Zero();  ///< E0: strain without stress, e.g. thermal [-]
  bool wrinkling = false;
};

/// @brief Law of an element whose material axis 1 makes `angle` with axis 1 of its frame (towards axis 2).
/// @param[in] prestress           in the element's frame [N/m]
/// @param[in] temperature_change  [K]
MembraneLaw membrane_law(const MembraneSection& section, double angle, const Vec3& prestress,
                         double temperature_change);

using MembraneState = material::TensionState;

template <int N>
struct MembraneResponse {
  double energy = 0;   ///< [J]
  Vec<3 * N> force;    ///< internal force, order (u1x,u1y,u1z,u2x,...) [N]
  Mat<3 * N> tangent;  ///< [N/m]; left untouched unless wanted
  Vec3 pk2_resultant;  ///< second Piola-Kirchhoff N11, N22, N12 in the frame, mean over the element [N/m]
  Vec<2> principal_cauchy;  ///< principal Cauchy resultants (force per current length), larger first [N/m]
  MembraneState state = MembraneState::taut;  ///< at the centre
};

/// Local frame: axis 1 along the first side of a triangle, or along the line that joins the middles of the
/// sides 4-1 and 2-3 of a quadrilateral; axis 3 normal; columns are the axes.
template <int N>
Mat3 membrane_frame(const Mat<3, N>& x_ref);

/// @brief Energy, internal force and tangent of a prestressed membrane of N = 3 or 4 nodes.
///
/// W = integral of N0 : E + (E - E0) : D : (E - E0) / 2 over the reference area, Green-Lagrange strain E
/// (St. Venant-Kirchhoff, plane stress); with `wrinkling` the relaxed energy of that.
/// @param[in] x_ref  reference coordinates, column = node [m]; quadrilaterals counter-clockwise, convex
/// @param[in] u      displacements [m]
template <int N>
MembraneResponse<N> evaluate_membrane(const MembraneLaw& law, const Mat<3, N>& x_ref, const Vec<3 * N>& u,
                                      Want want);

/// Force and tangent after a motion from `before` to `u` that was `increment` to first order.
template <int N>
Extrapolated<3 * N> extrapolate_membrane(const MembraneLaw& law, const Mat<3, N>& x_ref,
                                         const Vec<3 * N>& before, const Vec<3 * N>& increment,
                                         const Vec<3 * N>& u);

/// Reference area [m^2].
template <int N>
double membrane_area(const Mat<3, N>& x_ref);

/// Consistent mass matrix [kg].
template <int N>
Mat<3 * N> membrane_mass(double mass_per_area, const Mat<3, N>& x_ref);

}  // namespace tautline::element
