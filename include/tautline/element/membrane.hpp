#pragma once
/// @file
/// Three-node prestressed membrane of finite displacement. Theory: docs/theory/membrane.md

#include <tautline/core/types.hpp>
#include <tautline/element/want.hpp>

namespace tautline::element {

/// Isotropic plane-stress membrane; stiffnesses and stresses per unit of width.
struct MembraneSection {
  double tension_stiffness = 0;  ///< E h [N/m]
  double poisson_ratio = 0;
  double mass_per_area = 0;  ///< [kg/m^2]
};

struct MembraneResponse {
  double energy = 0;        ///< [J], zero at zero displacement
  Vec<9> force;             ///< internal force, order (u1x,u1y,u1z,u2x,...) [N]
  Mat<9> tangent;           ///< [N/m]; left untouched unless wanted
  Vec3 pk2_resultant;       ///< second Piola-Kirchhoff resultants N11, N22, N12 in the element's frame [N/m]
  Vec<2> principal_cauchy;  ///< principal Cauchy resultants (force per current length), larger first [N/m]
};

/// Local frame of a membrane triangle: axis 1 along the first side, axis 3 normal; columns are the axes.
Mat3 membrane_frame(const Mat<3, 3>& x_ref);

/// @brief Energy, internal force and tangent of a prestressed membrane.
///
/// W = A (N0 : E + E : D : E / 2) with Green-Lagrange strain E (St. Venant-Kirchhoff, plane stress).
/// @param[in] prestress  N0: resultants N11, N22, N12 in membrane_frame(x_ref), present in the reference
/// configuration [N/m]
/// @param[in] x_ref      reference coordinates, column = node [m]
/// @param[in] u          displacements, shape (9) [m]
MembraneResponse evaluate_membrane(const MembraneSection& section, const Vec3& prestress,
                                   const Mat<3, 3>& x_ref, const Vec<9>& u, Want want);

/// Consistent mass matrix [kg].
Mat<9> membrane_mass(double mass_per_area, const Mat<3, 3>& x_ref);

}  // namespace tautline::element
