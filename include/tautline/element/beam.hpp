#pragma once
/// @file
/// Two-node three-dimensional beam of finite rotation, corotational. Theory: docs/theory/beam.md

#include <array>
#include <tautline/core/types.hpp>
#include <tautline/element/extrapolated.hpp>
#include <tautline/element/want.hpp>

namespace tautline::element {

/// Stiffnesses and inertias of a straight, prismatic beam. Local axis 1 runs along the beam; 2 and 3 are
/// principal.
struct BeamSection {
  double axial_stiffness = 0;      ///< E A [N]
  double bending_stiffness_2 = 0;  ///< E I about local axis 2 (bending in the 1-3 plane) [N m^2]
  double bending_stiffness_3 = 0;  ///< E I about local axis 3 (bending in the 1-2 plane) [N m^2]
  double torsion_stiffness = 0;    ///< G J [N m^2]
  double shear_stiffness_2 = 0;    ///< k G A along local axis 2 [N]; 0 means Euler-Bernoulli (rigid in shear)
  double shear_stiffness_3 = 0;    ///< k G A along local axis 3 [N]; 0 means Euler-Bernoulli
  double mass_per_length = 0;      ///< rho A [kg/m]
  double rotary_inertia_2 = 0;     ///< rho I about local axis 2 [kg m]
  double rotary_inertia_3 = 0;     ///< rho I about local axis 3 [kg m]
};

/// A beam in its reference configuration.
struct BeamGeometry {
  Mat<3, 2> x_ref;  ///< end coordinates, column = node [m]
  Mat3 frame;       ///< columns: local axes 1, 2, 3 in the reference configuration, right-handed, orthonormal
  double free_strain = 0;  ///< axial strain without force, e.g. thermal [-]
  /// Change of the rotations about local axes 2 and 3 along the beam without moment, e.g. thermal [1/m].
  Vec<2> free_curvature{0, 0};
};

/// Motion of the two ends: displacements and rotations from the reference configuration.
struct BeamMotion {
  Mat<3, 2> u = Mat<3, 2>::Zero();                                   ///< [m]
  std::array<Mat3, 2> rotation{Mat3::Identity(), Mat3::Identity()};  ///< orthogonal, global frame
};

/// BeamResponse::force in the corotational frame. Axial force, shear and torque are those of the second end
/// (minus those of the first): the forces on the section whose outward normal is local axis 1.
struct BeamForces {
  double axial = 0;    ///< tension positive [N]
  Vec<2> shear{0, 0};  ///< along local 2 and 3 [N]
  double torque = 0;   ///< about local 1 [N m]
  /// Internal moments of the ends about local 1, 2, 3, column = node [N m]. In a beam bent by equal moments
  /// the two columns are opposite.
  Mat<3, 2> end_moment = Mat<3, 2>::Zero();
};

struct BeamResponse {
  double energy = 0;  ///< [J]
  Vec<12> force;      ///< internal force, order (f1, m1, f2, m2), moments conjugate to spatial spins [N, N m]
  /// Second derivative of the energy in the exponential chart at the current rotation (symmetric); equals the
  /// derivative of `force` with respect to displacements and spatial spins, symmetrised. Untouched unless
  /// wanted.
  Mat<12> tangent;
  BeamForces forces;
  Mat3 frame;  ///< corotational frame, columns local axes 1, 2, 3 in the current configuration
};

/// @brief Frame of a beam from its ends and an orientation vector: axis 1 along the beam, axis 3 the part of
/// `orientation` normal to it, axis 2 = 3 x 1. A zero or parallel orientation falls back to global z, then
/// global x.
Mat3 beam_frame(const Mat<3, 2>& x_ref, const Vec3& orientation);

/// @brief Energy, internal force, tangent and section forces of a beam.
///
/// Small strains, displacements and rotations of any size; rotations of the ends relative to the chord must
/// stay below pi. No allocation.
BeamResponse evaluate_beam(const BeamSection& section, const BeamGeometry& geometry, const BeamMotion& motion,
                           Want want);

/// Force and tangent after a motion from `before` to `motion` that was `increment` to first order, order as
/// the tangent's.
Extrapolated<12> extrapolate_beam(const BeamSection& section, const BeamGeometry& geometry,
                                  const BeamMotion& before, const Vec<12>& increment,
                                  const BeamMotion& motion);

/// @brief v^T K v for a motion v of the ends, order as the tangent's [J if v is in m and rad].
///
/// Formed from the relative motion of the ends, not from K: where a stiff beam moves almost rigidly, K's
/// entries are large, cancel, and leave their rounding.
double beam_second_variation(const BeamSection& section, const BeamGeometry& geometry,
                             const BeamMotion& motion, const Vec<12>& velocity);

/// @brief Consistent mass matrix with rotary inertia in the global frame [kg, kg m, kg m^2].
///
/// Translations by the cubic of Euler-Bernoulli; sections turn with its slope, or, where the beam shears,
/// linearly from end to end.
/// Order (u1, spin1, u2, spin2); `frame` as in BeamResponse::frame.
Mat<12> beam_mass(const BeamSection& section, double length, const Mat3& frame);

}  // namespace tautline::element
