#include <Eigen/Geometry>
#include <tautline/element/beam.hpp>

#include "detail/beam_local.hpp"
#include "detail/chord.hpp"
#include "detail/rotation.hpp"

namespace tautline::element {

namespace {

using detail::skew;
using detail::SpinToRotationVector;

/// @brief A beam seen from its corotational frame.
///
/// "Local motion" below means displacements and spins in the axes of the frame, order (u1, spin1, u2, spin2).
struct Corotated {
  detail::Chord chord;
  Mat3 frame;                     ///< columns: axes 1, 2, 3
  std::array<Vec3, 2> axis2;      ///< the ends' own second axes, local components
  Vec3 mean_axis2;                ///< mean of the two; its third component is zero
  std::array<Vec3, 2> rotations;  ///< rotation vectors of the ends relative to the frame, local components
  Mat<3, 12> frame_spin;          ///< spin of the frame by local motion, G^T of Battini & Pacoste
  /// Elongation and spins of the ends relative to the frame, by local motion.
  Mat<7, 12> relative_motion;
};

Mat3 corotational_frame(const Vec3& axis1, const Vec3& mean_axis2) {
  const Vec3 axis3 = axis1.cross(mean_axis2).normalized();
  Mat3 frame;
  frame << axis1, axis3.cross(axis1), axis3;
  return frame;
}

/// Spin of the frame. Axis 1 follows the chord; axis 3 stays normal to the mean of the ends' second axes.
Mat<3, 12> spin_of_frame(const Corotated& c) {
  const double l = c.chord.length;
  const double eta = c.mean_axis2[0] / c.mean_axis2[1];
  Mat<3, 12> spin = Mat<3, 12>::Zero();
  spin(1, 2) = 1 / l;
  spin(1, 8) = -1 / l;
  spin(2, 1) = -1 / l;
  spin(2, 7) = 1 / l;
  spin.row(0) = eta * spin.row(1);
  for (int end = 0; end < 2; ++end) {
    const Vec3& q = c.axis2[end];
    spin(0, 6 * end + 3) = q[1] / (2 * c.mean_axis2[1]);
    spin(0, 6 * end + 4) = -q[0] / (2 * c.mean_axis2[1]);
  }
  return spin;
}

Corotated corotate(const BeamGeometry& geometry, const BeamMotion& motion) {
  Corotated c;
  c.chord = detail::chord(geometry.x_ref, motion.u.col(0), motion.u.col(1));
  const Mat3 triads[] = {motion.rotation[0] * geometry.frame, motion.rotation[1] * geometry.frame};
  c.frame = corotational_frame(c.chord.direction, triads[0].col(1) + triads[1].col(1));
  for (int end = 0; end < 2; ++end) {
    const Mat3 relative = c.frame.transpose() * triads[end];
    c.rotations[end] = detail::rotation_vector(relative);
    c.axis2[end] = relative.col(1);
  }
  c.mean_axis2 = (c.axis2[0] + c.axis2[1]) / 2;
  c.frame_spin = spin_of_frame(c);
  c.relative_motion.setZero();
  c.relative_motion(0, 0) = -1;
  c.relative_motion(0, 6) = 1;
  for (int end = 0; end < 2; ++end) {
    c.relative_motion.middleRows<3>(1 + 3 * end) = -c.frame_spin;
    c.relative_motion.block<3, 3>(1 + 3 * end, 3 + 6 * end) += Mat3::Identity();
  }
  return c;
}

/// Derivative of frame_spin^T M by local motion at fixed M, seen from the frame.
Mat<12> lever_derivative(const Corotated& c, const Vec3& M) {
  using Row = Mat<1, 12>;
  const double l = c.chord.length;
  const double q2 = c.mean_axis2[1];
  const double eta = c.mean_axis2[0] / q2;
  const Row d_length = c.relative_motion.row(0);
  const Mat<3, 12> d_axis2[] = {-skew(c.axis2[0]) * c.relative_motion.middleRows<3>(1),
                                -skew(c.axis2[1]) * c.relative_motion.middleRows<3>(4)};
  const Row d_q1 = (d_axis2[0].row(0) + d_axis2[1].row(0)) / 2;
  const Row d_q2 = (d_axis2[0].row(1) + d_axis2[1].row(1)) / 2;

  Mat<12> derivative = Mat<12>::Zero();
  derivative.row(1) = M[2] / (l * l) * d_length;
  derivative.row(2) = M[0] / (l * q2) * (d_q1 - eta * d_q2) - (eta * M[0] + M[1]) / (l * l) * d_length;
  derivative.row(7) = -derivative.row(1);
  derivative.row(8) = -derivative.row(2);
  for (int end = 0; end < 2; ++end) {
    const Vec3& q = c.axis2[end];
    const double factor = M[0] / (2 * q2);
    derivative.row(6 * end + 3) = factor * (d_axis2[end].row(1) - q[1] / q2 * d_q2);
    derivative.row(6 * end + 4) = -factor * (d_axis2[end].row(0) - q[0] / q2 * d_q2);
  }
  return derivative;
}

/// Q M Q^T, block by block, of a symmetric matrix given in the axes Q.
Mat<12> rotated(const Mat<12>& local, const Mat3& Q) {
  Mat<12> global;
  for (int i = 0; i < 12; i += 3) {
    for (int j = 0; j <= i; j += 3) {
      const Mat3 block = Q * local.block<3, 3>(i, j) * Q.transpose();
      global.block<3, 3>(i, j) = block;
      global.block<3, 3>(j, i) = block.transpose();
    }
  }
  return global;
}

/// What the law says of one moment of a motion, everything that force and tangent are made of.
struct Moment {
  Corotated c;
  Vec<7> deformation;
  std::array<SpinToRotationVector, 2> by_spin;
  detail::BeamLocalResponse law;
  Vec<7> spin_force;  ///< conjugate to the elongation and the relative spins
  Vec<12> force;      ///< local
};

Moment evaluate_moment(const BeamSection& section, const BeamGeometry& geometry, const BeamMotion& motion,
                       Want want, const detail::BeamStress* stress = nullptr) {
  Corotated c = corotate(geometry, motion);
  const std::array by_spin{SpinToRotationVector(c.rotations[0]), SpinToRotationVector(c.rotations[1])};
  Vec<7> deformation;
  deformation << c.chord.elongation, c.rotations[0], c.rotations[1];
  const auto law = detail::beam_local_law(section, c.chord.length_ref, geometry.free_strain,
                                          geometry.free_curvature, deformation, want, stress);
  Vec<7> spin_force;
  spin_force << law.force[0], by_spin[0].matrix().transpose() * law.force.segment<3>(1),
      by_spin[1].matrix().transpose() * law.force.segment<3>(4);
  const Vec<12> force = c.relative_motion.transpose() * spin_force;
  return {c, deformation, by_spin, law, spin_force, force};
}

/// Derivative of the spin force by elongation and relative spins: the stiffness of what the beam feels.
Mat<7> relative_tangent(const Moment& m) {
  Mat<7> relative = m.law.tangent;
  for (int end = 0; end < 2; ++end) {
    const int at = 1 + 3 * end;
    relative.middleCols<3>(at) = (relative.middleCols<3>(at) * m.by_spin[end].matrix()).eval();
    relative.middleRows<3>(at) = (m.by_spin[end].matrix().transpose() * relative.middleRows<3>(at)).eval();
  }
  for (int end = 0; end < 2; ++end) {
    const int at = 1 + 3 * end;
    relative.block<3, 3>(at, at) += m.by_spin[end].derivative_of_transpose_times(m.law.force.segment<3>(at));
  }
  return relative;
}

/// What turning the frame under the forces present adds; not symmetric.
Mat<12> frame_tangent(const Moment& m) {
  Mat<12> tangent = -lever_derivative(m.c, m.spin_force.segment<3>(1) + m.spin_force.segment<3>(4));
  for (int at = 0; at < 12; at += 3)
    tangent.middleRows<3>(at) -= skew(m.force.segment<3>(at)) * m.c.frame_spin;
  return tangent;
}

/// Symmetrised derivative of the local internal force by local motion.
Mat<12> local_tangent(const Moment& m) {
  const Mat<12> tangent =
      m.c.relative_motion.transpose() * (relative_tangent(m) * m.c.relative_motion) + frame_tangent(m);
  return (tangent + tangent.transpose()) / 2;
}

/// Stresses after a small motion of the ends, to first order.
detail::BeamStress stress_after(const BeamSection& section, const BeamGeometry& geometry,
                                const BeamMotion& motion, const Vec<12>& increment) {
  const Moment m = evaluate_moment(section, geometry, motion, Want::force);
  Vec<12> local;
  for (int at = 0; at < 12; at += 3) local.segment<3>(at) = m.c.frame.transpose() * increment.segment<3>(at);
  Vec<7> change = m.c.relative_motion * local;
  for (int end = 0; end < 2; ++end)
    change.segment<3>(1 + 3 * end) = (m.by_spin[end].matrix() * change.segment<3>(1 + 3 * end)).eval();
  return m.law.stress + detail::beam_local_stress_rate(section, m.c.chord.length_ref, m.deformation, change);
}

/// Blocks of three turned from local to global axes.
Vec<12> rotated(const Vec<12>& local, const Mat3& Q) {
  Vec<12> global;
  for (int at = 0; at < 12; at += 3) global.segment<3>(at) = Q * local.segment<3>(at);
  return global;
}

BeamForces section_forces(const Vec<12>& local_force) {
  BeamForces forces;
  forces.axial = local_force[6];
  forces.shear = local_force.segment<2>(7);
  forces.torque = local_force[9];
  forces.end_moment << local_force.segment<3>(3), local_force.segment<3>(9);
  return forces;
}

}  // namespace

Mat3 beam_frame(const Mat<3, 2>& x_ref, const Vec3& orientation) {
  const Vec3 axis1 = (x_ref.col(1) - x_ref.col(0)).normalized();
  Vec3 normal = Vec3::Zero();
  for (const Vec3& wish : {orientation, Vec3(0, 0, 1), Vec3(1, 0, 0)}) {
    normal = wish - axis1 * axis1.dot(wish);
    if (normal.norm() > 1e-6 * wish.norm()) break;
  }
  const Vec3 axis2 = normal.cross(axis1).normalized();
  Mat3 frame;
  frame << axis1, axis2, axis1.cross(axis2);
  return frame;
}

BeamResponse evaluate_beam(const BeamSection& section, const BeamGeometry& geometry, const BeamMotion& motion,
                           Want want) {
  const Moment m = evaluate_moment(section, geometry, motion, want);
  BeamResponse response;
  response.energy = m.law.energy;
  response.force = rotated(m.force, m.c.frame);
  response.forces = section_forces(m.force);
  response.frame = m.c.frame;
  if (want == Want::tangent) response.tangent = rotated(local_tangent(m), m.c.frame);
  return response;
}

Extrapolated<12> extrapolate_beam(const BeamSection& section, const BeamGeometry& geometry,
                                  const BeamMotion& before, const Vec<12>& increment,
                                  const BeamMotion& motion) {
  const detail::BeamStress stress = stress_after(section, geometry, before, increment);
  const Moment m = evaluate_moment(section, geometry, motion, Want::tangent, &stress);
  return {rotated(m.force, m.c.frame), rotated(local_tangent(m), m.c.frame)};
}

double beam_second_variation(const BeamSection& section, const BeamGeometry& geometry,
                             const BeamMotion& motion, const Vec<12>& velocity) {
  const Moment m = evaluate_moment(section, geometry, motion, Want::tangent);
  Vec<12> local;
  for (int at = 0; at < 12; at += 3) local.segment<3>(at) = m.c.frame.transpose() * velocity.segment<3>(at);
  const Vec<7> relative = m.c.relative_motion * local;
  return relative.dot(relative_tangent(m) * relative) + local.dot(frame_tangent(m) * local);
}

Mat<12> beam_mass(const BeamSection& section, double length, const Mat3& frame) {
  return rotated(detail::beam_local_mass(section, length), frame);
}

}  // namespace tautline::element
