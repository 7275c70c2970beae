#pragma once
/// @file
/// The beam in its own frame: law of small local deformations, and mass. Theory:
/// docs/theory/beam.md#local-law

#include <tautline/element/beam.hpp>

namespace tautline::element::detail {

/// Axial force, then the moments that bending and torsion by themselves make of the local rotations [N, N m].
using BeamStress = Vec<7>;

/// Answer to the local deformations (elongation, rotation vector of end 1, rotation vector of end 2).
struct BeamLocalResponse {
  double energy = 0;  ///< [J]
  BeamStress stress;
  Vec<7> force;    ///< conjugate to the deformations [N, N m]
  Mat<7> tangent;  ///< untouched unless wanted
};

/// @brief Linear bending and torsion, and the axial strain averaged along the shallow arch.
///
/// W = EA L (eps - free_strain)^2/2 + bending of both planes + GJ (twist)^2/(2 L),
/// eps = elongation/L + mean along the beam of (v'^2 + w'^2)/2.
/// @param[in] length       in the reference configuration [m]
/// @param[in] free_strain  axial strain without force [-]
/// @param[in] free_curvature  of the rotations about 2 and 3, without moment [1/m]
/// @param[in] instead  stresses that force and tangent are formed with; none: those of the deformation
BeamLocalResponse beam_local_law(const BeamSection& section, double length, double free_strain,
                                 const Vec<2>& free_curvature, const Vec<7>& deformation, Want want,
                                 const BeamStress* instead = nullptr);

/// Change of the stresses by a small change of the local deformations.
BeamStress beam_local_stress_rate(const BeamSection& section, double length, const Vec<7>& deformation,
                                  const Vec<7>& change);

/// Consistent mass matrix in the axes of the beam, order (u1, spin1, u2, spin2).
Mat<12> beam_local_mass(const BeamSection& section, double length);

}  // namespace tautline::element::detail
