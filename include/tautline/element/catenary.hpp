#pragma once
/// @file
/// Elastic catenary: a whole cable with its own weight and other dead loads along it as one element. Theory:
/// docs/theory/catenary.md

#include <tautline/core/types.hpp>
#include <tautline/element/want.hpp>

namespace tautline::element {

struct CatenaryProperties {
  double axial_stiffness = 0;    ///< EA [N], positive
  double unstressed_length = 0;  ///< L0 [m], positive
  double mass_per_length = 0;    ///< per unstressed length [kg/m]
  Vec3 line_load{0, 0, 0};       ///< dead load beside the weight, per unstressed length [N/m]
};

/// Answer of the catenary; everything from its potential, elastic and of the distributed weight, at its
/// least over all shapes between the two ends.
struct CatenaryResponse {
  double energy = 0;         ///< elastic energy minus work of the weight on displacements from x = 0 [J]
  Vec<6> force;              ///< d energy / du, weight and line load included: the nodes need no other [N]
  Mat<6> tangent;            ///< [N/m]; left untouched unless wanted
  double tension_start = 0;  ///< at the first end [N]
  double tension_end = 0;    ///< at the second end [N]
  double length = 0;         ///< of the stretched cable [m]
  double sag = 0;            ///< largest distance from the chord, along weight and line load [m]
  bool slack = false;        ///< the chord is shorter than the unstressed length
};

/// @brief Potential, nodal forces and tangent of an elastic catenary between two displaced ends.
///
/// Any direction of weight and line load, any inclination, slack or taut; without them it is the tension-only
/// cable. Source: Irvine (1981), Cable Structures, ch. 1; Jayaraman & Knudson (1981).
/// @param[in] acceleration  body force per mass, e.g. gravity (0, 0, -9.81) [m/s^2]
/// @param[in] x_ref         reference coordinates of the ends, column = node [m]
/// @param[in] u             displacements, shape (6) [m]
CatenaryResponse evaluate_catenary(const CatenaryProperties& properties, const Vec3& acceleration,
                                   const Mat<3, 2>& x_ref, const Vec<6>& u, Want want);

/// Points of the cable's shape in the current state at equal unstressed lengths, `parts` + 1 of them [m].
/// Slack and without weight it has no shape: the points are on the chord.
Points catenary_shape(const CatenaryProperties& properties, const Vec3& acceleration, const Mat<3, 2>& x_ref,
                      const Vec<6>& u, int parts);

}  // namespace tautline::element
