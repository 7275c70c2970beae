#pragma once
/// @file
/// Elastic law in plane stress, integrated over the thickness: isotropic, orthotropic, with prestress and
/// free strain. Theory: docs/theory/membrane.md

#include <cmath>

#include <tautline/core/types.hpp>

namespace tautline::material {

/// Stiffnesses along the material axes 1 and 2.
struct OrthotropicStiffness {
  double tension_1 = 0;      ///< E1 h [N/m]
  double tension_2 = 0;      ///< E2 h [N/m]
  double poisson_ratio = 0;  ///< nu12: contraction along 2 under stress along 1; nu12^2 < E1 / E2
  double shear = 0;          ///< G12 h [N/m]
};

/// D of an orthotropic sheet in its material axes, for strains (E11, E22, 2 E12) [N/m].
inline Mat3 plane_stress_stiffness(const OrthotropicStiffness& s) {
  const double nu21 = s.tension_1 == 0 ? 0 : s.poisson_ratio * s.tension_2 / s.tension_1;
  const double share = 1 / (1 - s.poisson_ratio * nu21);
  const double coupling = s.poisson_ratio * s.tension_2 * share;
  Mat3 D;
  D << s.tension_1 * share, coupling, 0, coupling, s.tension_2 * share, 0, 0, 0, s.shear;
  return D;
}

/// D of an isotropic sheet, in any axes [N/m].
/// @param[in] tension_stiffness  E h [N/m]
/// @param[in] poisson_ratio      between -1 and 1, exclusive
inline Mat3 plane_stress_stiffness(double tension_stiffness, double poisson_ratio) {
  const double direct = tension_stiffness / (1 - poisson_ratio * poisson_ratio);
  const double coupling = poisson_ratio * direct;
  Mat3 D;
  D << direct, coupling, 0, coupling, direct, 0, 0, 0, (1 - poisson_ratio) * direct / 2;
  return D;
}

/// Takes strains (E11, E22, 2 E12) to axes turned by `angle` from axis 1 towards axis 2 [rad].
inline Mat3 strain_rotation(double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  Mat3 T;
  T << c * c, s * s, c * s, s * s, c * c, -c * s, -2 * c * s, 2 * c * s, c * c - s * s;
  return T;
}

struct PlaneStressResponse {
  double energy_per_area = 0;  ///< N0 : E + (E - E0) : D : (E - E0) / 2 [N/m]
  Vec3 pk2_resultant;          ///< N11, N22, N12 [N/m]
};

/// @brief Second Piola-Kirchhoff resultants N = N0 + D (E - E0) and the energy they come from.
/// @param[in] stiffness     D, symmetric [N/m]
/// @param[in] prestress     N0: N11, N22, N12 [N/m]
/// @param[in] free_strain   E0: strain that needs no stress, E11, E22, 2 E12 [-]
/// @param[in] green_strain  E: E11, E22, 2 E12 [-]
inline PlaneStressResponse plane_stress(const Mat3& stiffness, const Vec3& prestress, const Vec3& free_strain,
                                        const Vec3& green_strain) {
  const Vec3 elastic_strain = green_strain - free_strain;
  const Vec3 elastic = stiffness * elastic_strain;
  return {green_strain.dot(prestress) + elastic_strain.dot(elastic) / 2, prestress + elastic};
}

}  // namespace tautline::material
