#pragma once
/// @file
/// Linear springs between two nodes at the same place, or between a node and the ground. Theory:
/// docs/theory/spring.md

#include <array>

#include <tautline/core/types.hpp>
#include <tautline/element/want.hpp>

namespace tautline::element {

struct SpringProperties {
  Vec3 stiffness = Vec3::Zero();             ///< along x, y, z [N/m]
  Vec3 rotational_stiffness = Vec3::Zero();  ///< about x, y, z [N m/rad]
};

/// Motion of the two nodes from the reference configuration; the ground is a first node that rests.
struct SpringMotion {
  Mat<3, 2> u = Mat<3, 2>::Zero();                                   ///< [m]
  std::array<Mat3, 2> rotation{Mat3::Identity(), Mat3::Identity()};  ///< orthogonal, global frame
};

struct SpringResponse {
  double energy = 0;            ///< [J]
  Vec<12> force;                ///< internal force, order (f1, m1, f2, m2) [N, N m]
  Mat<12> tangent;              ///< symmetrised, see docs/theory/conventions.md; untouched unless wanted
  Vec3 spring_force{0, 0, 0};   ///< on node 2, in the axes that turn with node 1 [N]
  Vec3 spring_moment{0, 0, 0};  ///< on node 2, in the axes that turn with node 1 [N m]
};

/// @brief Energy, internal force and tangent of a spring.
///
/// Axes x, y, z turn with node 1: W = d.K d/2 + theta.K_r theta/2 with d = R1^T (u2 - u1) and theta the
/// rotation vector of R1^T R2 (|theta| < pi). Objective when both nodes are at the same place.
SpringResponse evaluate_spring(const SpringProperties& properties, const SpringMotion& motion, Want want);

}  // namespace tautline::element
