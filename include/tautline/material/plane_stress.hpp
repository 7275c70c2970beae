#pragma once
/// @file
/// Isotropic St. Venant-Kirchhoff law in plane stress, integrated over the thickness. Theory:
/// docs/theory/membrane.md

#include <tautline/core/types.hpp>

namespace tautline::material {

/// Entries of D = [[direct, coupling, 0], [coupling, direct, 0], [0, 0, shear]], for strains (E11, E22, 2
/// E12).
struct PlaneStressStiffness {
  double direct = 0;    ///< E h / (1 - nu^2) [N/m]
  double coupling = 0;  ///< nu E h / (1 - nu^2) [N/m]
  double shear = 0;     ///< E h / (2 (1 + nu)) [N/m]
};

/// @param[in] tension_stiffness  E h [N/m]
/// @param[in] poisson_ratio      between -1 and 1, exclusive
constexpr PlaneStressStiffness plane_stress_stiffness(double tension_stiffness, double poisson_ratio) {
  const double direct = tension_stiffness / (1 - poisson_ratio * poisson_ratio);
  return {direct, poisson_ratio * direct, (1 - poisson_ratio) * direct / 2};
}

struct PlaneStressResponse {
  double energy_per_area = 0;  ///< N0 : E + E : D : E / 2 [N/m]
  Vec3 pk2_resultant;          ///< N11, N22, N12 [N/m]
};

/// @brief Second Piola-Kirchhoff resultants N = N0 + D E and the energy they come from.
/// @param[in] prestress     N0: resultants at zero strain, N11, N22, N12 [N/m]
/// @param[in] green_strain  E11, E22, 2 E12 [-]
inline PlaneStressResponse plane_stress(const PlaneStressStiffness& stiffness, const Vec3& prestress,
                                        const Vec3& green_strain) {
  const Vec3& E = green_strain;
  const Vec3 elastic(stiffness.direct * E[0] + stiffness.coupling * E[1],
                     stiffness.coupling * E[0] + stiffness.direct * E[1], stiffness.shear * E[2]);
  return {E.dot(prestress + elastic / 2), prestress + elastic};
}

}  // namespace tautline::material
