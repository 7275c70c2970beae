#pragma once
/// @file
/// Plane-stress law that carries no compression: tension field theory by relaxation of the energy. Theory:
/// docs/theory/membrane.md

#include <tautline/core/types.hpp>

namespace tautline::material {

enum class TensionState { taut, wrinkled, slack };

/// Answer of the tension field law; everything from the one relaxed energy.
struct TensionFieldResponse {
  double energy_per_area = 0;  ///< [N/m]
  Vec3 pk2_resultant;          ///< N11, N22, N12; no principal value is negative [N/m]
  Mat3 tangent;                ///< dN / dE [N/m]; on a switch that of the tauter side
  TensionState state = TensionState::taut;
};

/// @brief Relaxed plane-stress law: the sheet may shorten at no cost by wrinkling.
///
/// W(E) = min over wrinkling strains G, positive semidefinite, of the energy of plane_stress at E + G. Convex
/// and continuously differentiable, its gradient N is D (E + G - E0) + N0. Source: Pipkin (1994); for
/// anisotropic sheets Barsotti & Vannucci (2013); solution as a projection on a cone:
/// docs/theory/membrane.md. Arguments as of plane_stress.
/// @pre stiffness positive definite
TensionFieldResponse tension_field(const Mat3& stiffness, const Vec3& prestress, const Vec3& free_strain,
                                   const Vec3& green_strain);

}  // namespace tautline::material
