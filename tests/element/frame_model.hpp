#pragma once
// A handful of beams with dense matrices: just enough of a solver to hold the beam against closed forms.

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <stdexcept>
#include <tautline/element/beam.hpp>
#include <vector>

namespace tautline::element::testing_frame {

struct FrameState {
  Points u;
  std::vector<Mat3> rotation;
};

/// A chain of beams through the nodes `x`, all with the same section and orientation vector.
struct Frame {
  Points x;
  BeamSection section;
  Vec3 orientation{0, 0, 1};
  std::vector<int> supported;  ///< dofs 6 * node + (0..2 displacement, 3..5 rotation)

  int n_dofs() const { return 6 * static_cast<int>(x.size()); }
  int last() const { return 6 * (static_cast<int>(x.size()) - 1); }  ///< first dof of the last node

  FrameState at_rest() const {
    return {Points(x.size(), Vec3::Zero()), std::vector<Mat3>(x.size(), Mat3::Identity())};
  }
};

/// Straight chain of `n` beams of total length `L` along x.
inline Frame straight(int n, double L, const BeamSection& section) {
  Frame frame{{}, section, Vec3(0, 0, 1), {}};
  for (int i = 0; i <= n; ++i) frame.x.emplace_back(L * i / n, 0, 0);
  return frame;
}

/// Straight chain clamped at its first node.
inline Frame cantilever(int n, double L, const BeamSection& section) {
  Frame frame = straight(n, L, section);
  frame.supported = {0, 1, 2, 3, 4, 5};
  return frame;
}

inline BeamGeometry geometry_of(const Frame& frame, int element) {
  BeamGeometry geometry;
  geometry.x_ref << frame.x[element], frame.x[element + 1];
  geometry.frame = beam_frame(geometry.x_ref, frame.orientation);
  return geometry;
}

inline BeamResponse evaluate(const Frame& frame, const FrameState& state, int element) {
  BeamMotion motion;
  motion.u << state.u[element], state.u[element + 1];
  motion.rotation = {state.rotation[element], state.rotation[element + 1]};
  return evaluate_beam(frame.section, geometry_of(frame, element), motion, Want::tangent);
}

struct Assembled {
  VecX force;
  MatX tangent;
};

inline Assembled assemble(const Frame& frame, const FrameState& state) {
  Assembled sum{VecX::Zero(frame.n_dofs()), MatX::Zero(frame.n_dofs(), frame.n_dofs())};
  for (int e = 0; e + 1 < static_cast<int>(frame.x.size()); ++e) {
    const BeamResponse response = evaluate(frame, state, e);
    sum.force.segment<12>(6 * e) += response.force;
    sum.tangent.block<12, 12>(6 * e, 6 * e) += response.tangent;
  }
  return sum;
}

inline MatX mass(const Frame& frame) {
  MatX sum = MatX::Zero(frame.n_dofs(), frame.n_dofs());
  for (int e = 0; e + 1 < static_cast<int>(frame.x.size()); ++e) {
    const double length = (frame.x[e + 1] - frame.x[e]).norm();
    sum.block<12, 12>(6 * e, 6 * e) += beam_mass(frame.section, length, geometry_of(frame, e).frame);
  }
  return sum;
}

inline std::vector<int> free_dofs(const Frame& frame) {
  std::vector<int> dofs;
  for (int i = 0; i < frame.n_dofs(); ++i)
    if (std::find(frame.supported.begin(), frame.supported.end(), i) == frame.supported.end())
      dofs.push_back(i);
  return dofs;
}

inline void move(FrameState& state, const VecX& step) {
  for (int i = 0; i < static_cast<int>(state.u.size()); ++i) {
    state.u[i] += step.segment<3>(6 * i);
    const Vec3 spin = step.segment<3>(6 * i + 3);
    const double angle = spin.norm();
    if (angle > 0) state.rotation[i] = Eigen::AngleAxisd(angle, spin / angle) * state.rotation[i];
  }
}

/// Newton to equilibrium with `load`; forces and moments keep their directions.
inline void equilibrate(const Frame& frame, const VecX& load, FrameState& state) {
  const std::vector<int> dofs = free_dofs(frame);
  const VecX load_free = load(dofs);
  for (int iteration = 0; iteration < 40; ++iteration) {
    const Assembled sum = assemble(frame, state);
    const VecX residual = load_free - sum.force(dofs);
    const MatX tangent = sum.tangent(dofs, dofs);
    VecX step = VecX::Zero(frame.n_dofs());
    const VecX step_free = tangent.partialPivLu().solve(residual);
    step(dofs) = step_free;
    move(state, step);
    if (step.norm() < 1e-10 * frame.x.back().norm()) return;
  }
  throw std::runtime_error("Newton did not converge");
}

/// Follows `load` in equal steps from rest.
inline FrameState loaded(const Frame& frame, const VecX& load, int steps) {
  FrameState state = frame.at_rest();
  for (int i = 1; i <= steps; ++i) equilibrate(frame, load * i / steps, state);
  return state;
}

inline double lowest_eigenvalue(const Frame& frame, const FrameState& state) {
  const std::vector<int> dofs = free_dofs(frame);
  const MatX tangent = assemble(frame, state).tangent(dofs, dofs);
  return Eigen::SelfAdjointEigenSolver<MatX>(tangent, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

/// Lowest circular frequencies, ascending [rad/s].
inline VecX frequencies(const Frame& frame) {
  const std::vector<int> dofs = free_dofs(frame);
  const MatX tangent = assemble(frame, frame.at_rest()).tangent(dofs, dofs);
  const MatX inertia = mass(frame)(dofs, dofs);
  return Eigen::GeneralizedSelfAdjointEigenSolver<MatX>(tangent, inertia, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .cwiseSqrt();
}

}  // namespace tautline::element::testing_frame
