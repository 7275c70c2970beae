#include <tautline/element/beam.hpp>

#include <gtest/gtest.h>

namespace tautline::element {
namespace {

BeamSection stiff() {
  BeamSection section;
  section.axial_stiffness = 9e7;
  section.bending_stiffness_2 = 18750;
  section.bending_stiffness_3 = 607;
  section.torsion_stiffness = 800;
  return section;
}

BeamGeometry geometry() {
  BeamGeometry g;
  g.x_ref << 1.0, 1.05, 2.0, 2.06, 0.5, 0.52;
  g.frame = beam_frame(g.x_ref, Vec3(0, 0, 1));
  return g;
}

BeamMotion bent() {
  BeamMotion motion;
  motion.u << 0.3, 0.3001, -0.2, -0.2002, 0.1, 0.1003;
  motion.rotation[0] = Eigen::AngleAxisd(0.002, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  motion.rotation[1] = Eigen::AngleAxisd(0.004, Vec3(2, -1, 1).normalized()).toRotationMatrix();
  return motion;
}

TEST(BeamSecondVariation, IsTheQuadraticFormOfTheTangent) {
  const auto response = evaluate_beam(stiff(), geometry(), bent(), Want::tangent);
  Vec<12> v;
  for (int i = 0; i < 12; ++i) v[i] = std::sin(1.0 + 2.1 * i);
  const double expected = v.dot(response.tangent * v);
  EXPECT_NEAR(beam_second_variation(stiff(), geometry(), bent(), v), expected,
              1e-12 * response.tangent.norm() * 12);
}

TEST(BeamSecondVariation, OfAHeatedBeamIsTheQuadraticFormOfItsTangent) {
  BeamGeometry g = geometry();
  g.free_strain = 6e-4;
  const auto response = evaluate_beam(stiff(), g, bent(), Want::tangent);
  Vec<12> v;
  for (int i = 0; i < 12; ++i) v[i] = std::cos(0.3 + 1.7 * i);
  EXPECT_NEAR(beam_second_variation(stiff(), g, bent(), v), v.dot(response.tangent * v),
              1e-12 * response.tangent.norm() * 12);
  // and the free strain matters: the axial force of -54 kN acts on the turning chord
  EXPECT_GT(std::abs(beam_second_variation(stiff(), geometry(), bent(), v) - v.dot(response.tangent * v)),
            1e3);
}

// A rigid motion of an unstressed beam stores nothing. K has entries of 1e9 N/m, whose rounding leaves 1e-7
// J; from relative motions only the moments are left that the frame's rounding makes, 4 E I / L * 2e-16 =
// 2e-10 N m.
TEST(BeamSecondVariation, OfARigidMotionIsNothingToRounding) {
  const auto g = geometry();
  const Vec3 spin(0.3, -0.7, 0.5), shift(1, 2, -1);
  Vec<12> v;
  v << shift + spin.cross(g.x_ref.col(0)), spin, shift + spin.cross(g.x_ref.col(1)), spin;
  EXPECT_LT(std::abs(beam_second_variation(stiff(), g, BeamMotion{}, v)), 2e-10);
}

}  // namespace
}  // namespace tautline::element
