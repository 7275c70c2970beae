#include <algorithm>

#include <tautline/element/cable.hpp>
#include <tautline/material/tension_only.hpp>

#include "detail/chord.hpp"

namespace tautline::element {

namespace {

/// A cable's chord with its strain and law.
struct Stretched {
  detail::Chord chord;
  double unstressed_length;   ///< L0 [m]
  double engineering_strain;  ///< l / L0 - 1
  material::AxialResponse law;
};

Stretched stretch(const CableProperties& properties, const Mat<3, 2>& x_ref, const Vec<6>& u) {
  const detail::Chord chord = detail::chord(x_ref, u.head<3>(), u.tail<3>());
  const double eps0 = properties.initial_strain;
  const double strain = eps0 + (1 + eps0) * chord.elongation / chord.length_ref;
  return {chord, chord.length_ref / (1 + eps0), strain,
          material::axial_law(properties.axial_stiffness, strain, properties.carries_compression)};
}

/// Tangent of both ends from the block that links them.
Mat<6> two_ended(const Mat3& block) {
  Mat<6> matrix;
  matrix << block, -block, -block, block;
  return matrix;
}

/// Tangent with a tension that need not be that of the stretch.
Mat<6> tangent_of(const Stretched& cable, double tension) {
  const Vec3& n = cable.chord.direction;
  const double material = cable.law.slope / cable.unstressed_length;
  const double geometric = tension / cable.chord.length;
  return two_ended((material - geometric) * n * n.transpose() + geometric * Mat3::Identity());
}

Vec<6> pull(double tension, const Vec3& direction) {
  Vec<6> force;
  force << -tension * direction, tension * direction;
  return force;
}

}  // namespace

CableResponse evaluate_cable(const CableProperties& properties, const Mat<3, 2>& x_ref, const Vec<6>& u,
                             Want want) {
  const Stretched cable = stretch(properties, x_ref, u);

  CableResponse response;
  response.energy = cable.law.energy_per_length * cable.unstressed_length;
  response.tension = cable.law.tension;
  response.slack = cable.law.slack;
  if (cable.law.slack) {  // also where the ends coincide and there is no direction
    response.force.setZero();
    if (want == Want::tangent) response.tangent.setZero();
    return response;
  }
  response.force = pull(cable.law.tension, cable.chord.direction);
  if (want == Want::tangent) response.tangent = tangent_of(cable, cable.law.tension);
  return response;
}

Extrapolated<6> extrapolate_cable(const CableProperties& properties, const Mat<3, 2>& x_ref,
                                  const Vec<6>& before, const Vec<6>& increment, const Vec<6>& u) {
  const Stretched cable = stretch(properties, x_ref, u), last = stretch(properties, x_ref, before);
  if (cable.law.slack) return {Vec<6>::Zero(), Mat<6>::Zero()};
  const double elongation = last.chord.direction.dot(increment.tail<3>() - increment.head<3>());
  const double linear =
      properties.axial_stiffness * (last.engineering_strain + elongation / last.unstressed_length);
  const double tension = properties.carries_compression ? linear : std::max(linear, 0.0);
  return {pull(tension, cable.chord.direction), tangent_of(cable, tension)};
}

Vec<6> cable_force_by_unstressed_length(const CableProperties& properties, const Mat<3, 2>& x_ref,
                                        const Vec<6>& u) {
  const Stretched cable = stretch(properties, x_ref, u);
  if (cable.law.slack) return Vec<6>::Zero();
  const double strain_by_length = -(1 + cable.engineering_strain) / cable.unstressed_length;
  const Vec3 pull = cable.law.slope * strain_by_length * cable.chord.direction;
  Vec<6> derivative;
  derivative << -pull, pull;
  return derivative;
}

Mat<6> cable_mass(double mass_per_length, double unstressed_length) {
  const double sixth = mass_per_length * unstressed_length / 6;
  const Mat3 I = Mat3::Identity();
  Mat<6> mass;
  mass << 2 * sixth * I, sixth * I, sixth * I, 2 * sixth * I;
  return mass;
}

}  // namespace tautline::element
