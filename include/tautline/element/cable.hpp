#pragma once
/// @file
/// Two-node tension-only cable, or bar, of finite displacement. Theory: docs/theory/cable.md

#include <tautline/core/types.hpp>
#include <tautline/element/extrapolated.hpp>
#include <tautline/element/want.hpp>

namespace tautline::element {

/// What the cable law needs to know of one cable.
struct CableProperties {
  double axial_stiffness = 0;  ///< EA [N], positive
  /// Engineering strain in the reference configuration, l_ref / L0 - 1 with unstressed length L0 [-].
  /// Negative where the cable starts slack.
  double initial_strain = 0;
  bool carries_compression = false;  ///< a bar: sigma = E eps for both signs
};

/// Answer of the cable; everything from the one energy W = EA L0 <eps>^2 / 2, eps = l/L0 - 1, <.> the
/// positive part.
struct CableResponse {
  double energy = 0;   ///< [J]
  Vec<6> force;        ///< dW/du, order (u1x,u1y,u1z,u2x,...) [N]
  Mat<6> tangent;      ///< d force / du [N/m]; left untouched unless wanted
  double tension = 0;  ///< EA <eps> [N]; negative only in a bar
  bool slack = false;  ///< eps < 0; never in a bar
};

/// @brief Energy, internal force, tangent and tension of a cable.
///
/// Engineering strain, bilinear law sigma = E eps for eps > 0, else 0 (Belov, eq. 3.10); a bar carries both
/// signs. The elongation is formed from displacement differences, so that the tension of a short stiff tie
/// keeps its digits.
/// @param[in] x_ref  reference coordinates, shape (3, 2), column = node [m]; distinct points
/// @param[in] u      displacements, shape (6) [m]
CableResponse evaluate_cable(const CableProperties& properties, const Mat<3, 2>& x_ref, const Vec<6>& u,
                             Want want);

/// Force and tangent after a motion from `before` to `u` that was `increment` to first order. The tension of
/// a cable is foretold as if it could push, and cut off at zero.
Extrapolated<6> extrapolate_cable(const CableProperties& properties, const Mat<3, 2>& x_ref,
                                  const Vec<6>& before, const Vec<6>& increment, const Vec<6>& u);

/// d force / d L0 at fixed ends and EA, shape (6) [N/m]: the right-hand side of tie tuning. Zero when slack.
Vec<6> cable_force_by_unstressed_length(const CableProperties& properties, const Mat<3, 2>& x_ref,
                                        const Vec<6>& u);

/// Consistent mass matrix [kg] of a cable of `unstressed_length` [m] and `mass_per_length` of that [kg/m].
Mat<6> cable_mass(double mass_per_length, double unstressed_length);

}  // namespace tautline::element
