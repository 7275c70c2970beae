#pragma once
/// @file
/// Uniaxial laws of cables, which carry tension only, and bars, which carry both. Theory:
/// docs/theory/cable.md

namespace tautline::material {

/// Answer of a uniaxial law; everything from the one energy EA <eps>^2 / 2, <.> the positive part in a cable,
/// in a bar the strain itself.
struct AxialResponse {
  double energy_per_length = 0;  ///< per unstressed length [N]
  double tension = 0;            ///< never negative in a cable [N]
  double slope = 0;              ///< d tension / d engineering strain [N]
  bool slack = true;             ///< engineering strain < 0; never in a bar
};

/// @brief sigma = E eps for both signs.
/// @param[in] axial_stiffness     EA [N]
/// @param[in] engineering_strain  l / L0 - 1 with unstressed length L0 [-]
constexpr AxialResponse linear_elastic(double axial_stiffness, double engineering_strain) {
  const double tension = axial_stiffness * engineering_strain;
  return {tension * engineering_strain / 2, tension, axial_stiffness, false};
}

/// @brief Tension-only bilinear law: sigma = E eps for eps > 0, else 0.
///
/// At eps = 0, where a cable is just as long as its span, the slope is that of the taut side. Parameters as
/// above. Source: Belov, eq. 3.10.
constexpr AxialResponse tension_only(double axial_stiffness, double engineering_strain) {
  return engineering_strain < 0 ? AxialResponse{} : linear_elastic(axial_stiffness, engineering_strain);
}

/// The law of a cable, tension only, or of a bar. Parameters as above.
constexpr AxialResponse axial_law(double axial_stiffness, double engineering_strain,
                                  bool carries_compression) {
  return carries_compression ? linear_elastic(axial_stiffness, engineering_strain)
                             : tension_only(axial_stiffness, engineering_strain);
}

}  // namespace tautline::material
