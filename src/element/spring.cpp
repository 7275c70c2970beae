#include <tautline/element/spring.hpp>

#include "detail/rotation.hpp"

namespace tautline::element {

namespace {

using detail::skew;

/// The springs against displacement, seen globally.
struct Translation {
  Vec3 lever;      ///< from the first to the second node, u2 - u1 [m]
  Vec3 local;      ///< force in the axes of node 1 [N]
  Vec3 force;      ///< on the second node [N]
  Mat3 stiffness;  ///< in global axes [N/m]
};

/// The springs against rotation, seen globally.
struct Rotation {
  double energy;
  Vec3 local;      ///< moment in the axes of node 1 [N m]
  Vec3 moment;     ///< on the second node [N m]
  Mat3 stiffness;  ///< derivative of `local` by the relative spin, in global axes, not symmetric [N m]
};

Translation translation(const SpringProperties& properties, const SpringMotion& motion) {
  const Mat3& R = motion.rotation[0];
  const Vec3 lever = motion.u.col(1) - motion.u.col(0);
  const Vec3 local = properties.stiffness.cwiseProduct(R.transpose() * lever);
  return {lever, local, R * local, R * properties.stiffness.asDiagonal() * R.transpose()};
}

Rotation rotation(const SpringProperties& properties, const SpringMotion& motion) {
  const Mat3& R = motion.rotation[0];
  const Vec3 theta = detail::rotation_vector(R.transpose() * motion.rotation[1]);
  const detail::SpinToRotationVector by_spin(theta);
  const Vec3 gradient = properties.rotational_stiffness.cwiseProduct(theta);
  const Mat3 T = by_spin.matrix();
  const Mat3 stiffness = T.transpose() * properties.rotational_stiffness.asDiagonal() * T +
                         by_spin.derivative_of_transpose_times(gradient);
  const Vec3 local = T.transpose() * gradient;
  return {gradient.dot(theta) / 2, local, R * local, R * stiffness * R.transpose()};
}

/// Symmetrised derivative of the force by displacements and spins, order (u1, spin1, u2, spin2).
Mat<12> tangent_of(const Translation& t, const Rotation& r) {
  using Rows = Mat<3, 12>;
  const Mat3 I = Mat3::Identity();
  Rows d_lever, spin, spin_1;
  d_lever << -I, Mat3::Zero(), I, Mat3::Zero();
  spin << Mat3::Zero(), -I, Mat3::Zero(), I;
  spin_1 << Mat3::Zero(), I, Mat3::Zero(), Mat3::Zero();
  // The axes turn with node 1 and take force and moment along.
  const Rows d_force = t.stiffness * (d_lever + skew(t.lever) * spin_1) - skew(t.force) * spin_1;
  const Rows d_moment = r.stiffness * spin - skew(r.moment) * spin_1;
  Mat<12> tangent;
  tangent << -d_force, skew(t.force) * d_lever - skew(t.lever) * d_force - d_moment, d_force, d_moment;
  return (tangent + tangent.transpose()) / 2;
}

}  // namespace

SpringResponse evaluate_spring(const SpringProperties& properties, const SpringMotion& motion, Want want) {
  const Translation t = translation(properties, motion);
  const Rotation r = rotation(properties, motion);
  SpringResponse response;
  response.energy = t.force.dot(t.lever) / 2 + r.energy;
  response.force << -t.force, -r.moment - t.lever.cross(t.force), t.force, r.moment;
  response.spring_force = t.local;
  response.spring_moment = r.local;
  if (want == Want::tangent) response.tangent = tangent_of(t, r);
  return response;
}

}  // namespace tautline::element
