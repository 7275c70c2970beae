// Stresses foretold by the last increment. Theory: docs/theory/newton.md#stresses-foretold
#include <gtest/gtest.h>

#include <cmath>
#include <tautline/core/rotation.hpp>
#include <tautline/element/beam.hpp>
#include <tautline/element/cable.hpp>
#include <tautline/element/membrane.hpp>
#include <tautline/element/shell.hpp>

namespace tautline::element {
namespace {

/// Force with the stresses of a motion itself, and with those foretold from the start by a step of size h.
struct Forces {
  VecX own, foretold;
};

/// What a step foretells is exact where it has no length and else wrong by the square of it.
template <class ForcesOf>
void expect_second_order(const ForcesOf& after_step) {
  const auto miss = [&](double h) {
    const Forces forces = after_step(h);
    return (forces.own - forces.foretold).norm();
  };
  EXPECT_LT(miss(0), 1e-12 * after_step(0).own.norm());
  EXPECT_NEAR(std::log2(miss(2e-3) / miss(1e-3)), 2, 0.02);  // next term: relative 1e-3
}

TEST(ForetoldStress, OfACable) {
  const CableProperties bar{5000, 0.02, true};
  Mat<3, 2> x;
  x << 0, 1, 0, 2, 0, -1;
  Vec<6> u, d;
  u << 0.1, 0.2, -0.1, 0.3, 0, 0.2;
  d << 1, -2, 0.5, 0.7, 1.5, 2;
  expect_second_order([&](double h) -> Forces {
    return {evaluate_cable(bar, x, u + h * d, Want::force).force,
            extrapolate_cable(bar, x, u, h * d, u + h * d).force};
  });
  // a cable that the step slackens has a tension of zero, not a compression
  const CableProperties cable{5000, 0.02, false};
  Vec<6> towards = Vec<6>::Zero(), slack = Vec<6>::Zero();
  towards.head<3>() = 0.5 * Vec3(1, 2, -1);
  EXPECT_EQ(extrapolate_cable(cable, x, slack, towards, slack).force.norm(), 0);
}

template <int N>
void expect_of_a_membrane(const Mat<3, N>& x) {
  Mat3 stiffness;
  stiffness << 1000, 300, 20, 300, 1500, -30, 20, -30, 400;
  const MembraneLaw law{stiffness, {20, 10, 5}, {0.01, 0.02, 0}, false};
  const Vec<3 *N> u = Vec<3 * N>::NullaryExpr(
                      [](Eigen::Index i) { return 0.1 * std::sin(3. + 2. * double(i)); }),
                  d = Vec<3 * N>::NullaryExpr([](Eigen::Index i) { return std::cos(1. + 5. * double(i)); });
  expect_second_order([&](double h) -> Forces {
    return {evaluate_membrane<N>(law, x, u + h * d, Want::force).force,
            extrapolate_membrane<N>(law, x, u, h * d, u + h * d).force};
  });
  EXPECT_LT((extrapolate_membrane<N>(law, x, u, 0 * d, u).tangent -
             evaluate_membrane<N>(law, x, u, Want::tangent).tangent)
                .norm(),
            1e-10);
}

TEST(ForetoldStress, OfAMembrane) {
  Mat<3, 4> x;
  x << 0, 1, 1.1, -0.1, 0, 0.1, 1, 0.9, 0, 0.2, 0.1, 0;
  expect_of_a_membrane<4>(x);
  expect_of_a_membrane<3>(x.leftCols<3>());
}

Mat3 turned(const Mat3& rotation, const Vec3& spin) {
  return rotation_of(spin) * rotation;
}

TEST(ForetoldStress, OfABeam) {
  const BeamSection section{5000, 30, 20, 10, 400, 300, 1, 1, 1};
  BeamGeometry geometry;
  geometry.x_ref << 1, 2.5, -2, -1, 0.5, 1;
  geometry.frame = beam_frame(geometry.x_ref, {0.2, 0.3, 1});
  geometry.free_strain = 0.01;
  geometry.free_curvature = {0.1, -0.2};
  BeamMotion motion;
  motion.u << 0.1, 0.13, -0.2, -0.1, 0.05, 0.1;
  motion.rotation = {rotation_of({0.3, -0.8, 0.5}), rotation_of({-0.4, 0.6, 0.7})};
  const Vec<12> d = Vec<12>::NullaryExpr([](Eigen::Index i) { return std::cos(1. + 5. * double(i)); });
  const auto moved = [&](double h) {
    BeamMotion m = motion;
    m.u += h * (Mat<3, 2>() << d.segment<3>(0), d.segment<3>(6)).finished();
    m.rotation = {turned(motion.rotation[0], h * d.segment<3>(3)),
                  turned(motion.rotation[1], h * d.segment<3>(9))};
    return m;
  };
  expect_second_order([&](double h) -> Forces {
    return {evaluate_beam(section, geometry, moved(h), Want::force).force,
            extrapolate_beam(section, geometry, motion, h * d, moved(h)).force};
  });
  EXPECT_LT((extrapolate_beam(section, geometry, motion, 0 * d, motion).tangent -
             evaluate_beam(section, geometry, motion, Want::tangent).tangent)
                .norm(),
            1e-8);
}

template <int N>
void expect_of_a_shell(const Mat<3, N>& x) {
  const ShellSection section{1e5, 0.3, 0.05, 1};
  ShellGeometry<N> geometry;
  geometry.x_ref = x;
  geometry.director = shell_frame<N>(x).col(2).replicate(1, N);
  geometry.prestress = {20, 10, 5};
  geometry.free_strain = 0.01;
  ShellMotion<N> motion;
  const Vec<6 * N> d = Vec<6 * N>::NullaryExpr([](Eigen::Index i) { return std::cos(1. + 5. * double(i)); });
  for (int i = 0; i < N; ++i) {
    motion.u.col(i) = 0.05 * Vec3(std::sin(i), std::cos(2. * i), std::sin(5. * i));
    motion.rotation[static_cast<std::size_t>(i)] = rotation_of(Vec3(0.1 * i, 0.2, -0.1 * i));
  }
  const auto moved = [&](double h) {
    ShellMotion<N> m = motion;
    for (int i = 0; i < N; ++i) {
      m.u.col(i) += h * d.template segment<3>(6 * i);
      auto& rotation = m.rotation[static_cast<std::size_t>(i)];
      rotation = turned(rotation, h * d.template segment<3>(6 * i + 3));
    }
    return m;
  };
  expect_second_order([&](double h) -> Forces {
    return {evaluate_shell<N>(section, geometry, moved(h), Want::force).force,
            extrapolate_shell<N>(section, geometry, motion, h * d, moved(h)).force};
  });
  const Mat<6 * N> tangent = evaluate_shell<N>(section, geometry, motion, Want::tangent).tangent;
  EXPECT_LT((extrapolate_shell<N>(section, geometry, motion, 0 * d, motion).tangent - tangent).norm(),
            1e-12 * tangent.norm());
}

TEST(ForetoldStress, OfAShell) {
  Mat<3, 4> x;
  x << 0, 1, 1.1, -0.1, 0, 0.1, 1, 0.9, 0, 0.05, 0.1, 0;
  expect_of_a_shell<4>(x);
  expect_of_a_shell<3>(x.leftCols<3>());
}

}  // namespace
}  // namespace tautline::element
