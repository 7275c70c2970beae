#pragma once
/// @file
/// Uniaxial law that carries tension only. Theory: docs/theory/cable.md

namespace tautline::material {

/// Answer of the tension-only law; everything from the one energy EA <eps>^2 / 2, <.> the positive part.
struct TensionOnlyResponse {
  double energy_per_length = 0;  ///< per unstressed length [N]
  double tension = 0;            ///< never negative [N]
  double slope = 0;              ///< d tension / d engineering strain [N]
  bool slack = true;             ///< engineering strain <= 0
};

/// @brief Tension-only bilinear law: sigma = E eps for eps > 0, else 0.
///
/// At eps = 0 the slope is that of the slack side. Source: Belov, eq. 3.10.
/// @param[in] axial_stiffness     EA [N]
/// @param[in] engineering_strain  l / L0 - 1 with unstressed length L0 [-]
constexpr TensionOnlyResponse tension_only(double axial_stiffness, double engineering_strain) {
  if (engineering_strain <= 0) return {};
  const double tension = axial_stiffness * engineering_strain;
  return {tension * engineering_strain / 2, tension, axial_stiffness, false};
}

}  // namespace tautline::material
