#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <tautline/element/beam.hpp>

#include "frame_model.hpp"

namespace tautline::element {

namespace {

using namespace testing_frame;

const double pi = std::acos(-1.);

/// Unit bending stiffnesses, practically inextensible, rigid in shear.
BeamSection slender(double axial_stiffness = 1e8) {
  return {axial_stiffness, 1, 1, 1, 0, 0, 1, 0, 0};
}

VecX load_on(const Frame& frame, int dof, double value) {
  return value * VecX::Unit(frame.n_dofs(), dof);
}

/// Load at which the straight column of length 1 loses stability: bisection on the lowest eigenvalue of the
/// tangent.
double critical_load(Frame frame, double low, double high) {
  const auto compressed = [&](double P) {
    FrameState state = frame.at_rest();
    for (std::size_t i = 0; i < frame.x.size(); ++i)
      state.u[i][0] = -P / frame.section.axial_stiffness * frame.x[i][0];
    return lowest_eigenvalue(frame, state);
  };
  while (high - low > 1e-7 * high) {
    const double middle = (low + high) / 2;
    (compressed(middle) > 0 ? low : high) = middle;
  }
  return low;
}

}  // namespace

// --- small displacements
// --------------------------------------------------------------------------------------------

TEST(BeamLinear, OneElementMeetsTheTimoshenkoCantilever) {
  const double L = 2, P = 1e-6;
  const BeamSection section{1e6, 300, 200, 100, 5e3, 4e3, 0, 0, 0};
  const Frame frame = cantilever(1, L, section);
  // nonlinear terms are relative (w/L)^2 = 1e-18
  const FrameState along_2 = loaded(frame, load_on(frame, 7, P), 1);
  EXPECT_NEAR(along_2.u[1][1], P * L * L * L / (3 * 200) + P * L / 5e3, 1e-12 * P);
  const FrameState along_3 = loaded(frame, load_on(frame, 8, P), 1);
  EXPECT_NEAR(along_3.u[1][2], P * L * L * L / (3 * 300) + P * L / 4e3, 1e-12 * P);
  const FrameState torque = loaded(frame, load_on(frame, 9, P), 1);
  EXPECT_NEAR(torque.rotation[1](2, 1), P * L / 100, 1e-12 * P);
  const FrameState pull = loaded(frame, load_on(frame, 6, P), 1);
  EXPECT_NEAR(pull.u[1][0] / (P * L / 1e6), 1, 1e-12);
}

TEST(BeamLinear, SectionForcesFollowTheirSigns) {
  const double L = 2, P = 1e-6;
  const Frame frame = cantilever(1, L, {1e6, 300, 200, 100, 0, 0, 0, 0, 0});
  VecX load = VecX::Zero(12);
  load.segment<4>(6) << 5 * P, 2 * P, 3 * P, 4 * P;  // tension, along 2, along 3, torque
  const BeamForces forces = evaluate(frame, loaded(frame, load, 1), 0).forces;
  const double tolerance = 1e-6 * P;  // rotations of some 1e-8 turn the forces by as much
  EXPECT_NEAR(forces.axial, 5 * P, tolerance);
  EXPECT_NEAR(forces.shear[0], 2 * P, tolerance);
  EXPECT_NEAR(forces.shear[1], 3 * P, tolerance);
  EXPECT_NEAR(forces.torque, 4 * P, tolerance);
  EXPECT_NEAR(forces.end_moment(2, 0), -2 * P * L, 5 * tolerance);  // clamp against the force along 2
  EXPECT_NEAR(forces.end_moment(1, 0), 3 * P * L, 5 * tolerance);   // and along 3
  EXPECT_NEAR(forces.end_moment(0, 0), -4 * P, tolerance);
  EXPECT_NEAR(forces.end_moment.col(1).tail<2>().norm(), 0, tolerance);
}

TEST(BeamLinear, ShortStiffBeamKeepsTheDigitsOfItsAxialForce) {
  BeamGeometry geometry;
  geometry.x_ref << 12, 12, 15, 15, 3.02, 3;
  geometry.frame = beam_frame(geometry.x_ref, Vec3::Zero());
  const double length = geometry.x_ref(2, 0) - geometry.x_ref(2, 1);
  const double EA = 1e6 * length;
  BeamMotion motion;
  motion.u << 0.3, 0.3, -0.2, -0.2, 0.1, 0.1 - 1e-10;
  const double elongation = motion.u(2, 0) - motion.u(2, 1);
  const auto response = evaluate_beam({EA, 1, 1, 1, 0, 0, 0, 0, 0}, geometry, motion, Want::force);
  EXPECT_NEAR(response.forces.axial, EA * elongation / length, 1e-12);
}

// --- free strain
// --------------------------------------------------------------------------------------------

TEST(BeamFreeStrain, MakesTheThermalForceOfAHeldBar) {
  // steel, alpha = 12e-6/K, dT = 50 K: N = -EA alpha dT, W = EA L (alpha dT)^2/2; the cold stiffness EA/L
  // remains
  const double EA = 2e8, free_strain = 12e-6 * 50;
  BeamGeometry geometry;
  geometry.x_ref << 1, 3, 2, 2, 0, 0;
  geometry.frame = beam_frame(geometry.x_ref, Vec3(0, 0, 1));
  geometry.free_strain = free_strain;
  const auto held = evaluate_beam({EA, 30, 20, 10, 0, 0, 0, 0, 0}, geometry, {}, Want::tangent);
  EXPECT_NEAR(held.forces.axial, -120000, 1e-9);
  EXPECT_NEAR(held.force[6], -120000, 1e-9);
  EXPECT_NEAR(held.force[0], 120000, 1e-9);
  EXPECT_NEAR(held.energy, EA * 2 * free_strain * free_strain / 2, 1e-12);
  EXPECT_NEAR(held.tangent(6, 6), EA / 2, 1e-6);
}

TEST(BeamFreeStrain, ExpandsFreelyWithoutStress) {
  // both signs, in any position: u2 - u1 = L free_strain along the turned axis
  const Vec3 d0(1, 2, 2);
  for (const double free_strain : {6e-4, -3e-3, 0.1}) {
    BeamGeometry geometry;
    geometry.x_ref << Vec3(5, -2, 1), Vec3(5, -2, 1) + d0;
    geometry.frame = beam_frame(geometry.x_ref, Vec3(0, 0, 1));
    geometry.free_strain = free_strain;
    const Mat3 Q = Eigen::AngleAxisd(1.2, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    BeamMotion motion;
    motion.u << Vec3(0.1, 0.2, 0.3), Vec3(0.1, 0.2, 0.3) + (1 + free_strain) * Q * d0 - d0;
    motion.rotation = {Q, Q};
    const auto loose = evaluate_beam({1e6, 30, 20, 10, 400, 300, 0, 0, 0}, geometry, motion, Want::force);
    EXPECT_LT(loose.force.norm(), 1e6 * 2e-15);  // rounding of displacements of some 1 m
    EXPECT_LT(loose.energy, 1e-20);
  }
}

// --- large displacements
// --------------------------------------------------------------------------------------------

TEST(BeamLarge, EndMomentRollsTheCantileverUpToACircle) {
  // Exact: u/L = sin a/a - 1, v/L = (1 - cos a)/a, a full circle at a = 2 pi. The element bends exactly, and
  // its chord is L (1 - c^2/6) instead of L sin(c)/c with c = a/(2 n): coordinates are wrong by the factor
  // c^4/120.
  for (const int n : {5, 10, 20}) {
    const Frame frame = cantilever(n, 1, slender(1e4));
    FrameState state = frame.at_rest();
    for (int step = 1; step <= 20; ++step) {
      const double a = 2 * pi * step / 20;
      equilibrate(frame, load_on(frame, frame.last() + 5, a), state);
      const double c = a / (2 * n);
      const double tolerance = 1.2 * std::pow(c, 4) / 120 + 1e-9;
      EXPECT_NEAR(state.u.back()[0], std::sin(a) / a - 1, tolerance) << "t = " << step / 20.;
      EXPECT_NEAR(state.u.back()[1], (1 - std::cos(a)) / a, tolerance) << "t = " << step / 20.;
    }
  }
}

TEST(BeamLarge, TipForceBendsTheCantileverIntoTheElasticaAtFourthOrder) {
  // Mattiasson (1981), Int. J. Numer. Meth. Engng 17, 145-153: elliptic integrals. As in the roll-up the
  // error goes with the fourth power of the turn of one element, at most PL^2/(EI n); the strain P/EA leaves
  // less than 1e-7.
  struct Point {
    double load, w, u;
  };
  const std::array<Point, 4> table{{{1, 0.3017207738, 0.05643323628},
                                    {2, 0.4934574804, 0.1606417208},
                                    {5, 0.7137915236, 0.3876283607},
                                    {10, 0.8106090249, 0.5549955978}}};
  for (const Point& point : table) {
    const auto error = [&](int n) {
      const Frame frame = cantilever(n, 1, slender());
      const FrameState state = loaded(frame, load_on(frame, frame.last() + 2, point.load), 10);
      return std::hypot(state.u.back()[2] - point.w, state.u.back()[0] + point.u);
    };
    const double coarse = error(8), fine = error(16);
    EXPECT_LT(coarse, 5e-5) << point.load;
    EXPECT_GT(std::log2(coarse / fine), 3.9) << point.load;
  }
}

TEST(BeamLarge, BendOf45DegreesConvergesToThePublishedTip) {
  // Problem of Bathe & Bolourchi (1979), Int. J. Numer. Meth. Engng 14, 961-986. The many published digits
  // belong to geometrically exact beams of spectral convergence along the parabola through three points of
  // the arc (Kynema, test Static_CurvedCompositeBeamBending). Straight elements inscribed in it: error of
  // second order, which Richardson's extrapolation removes; what remains is of fourth order, (turn of an
  // element)^4 = (pi/4/16)^4 = 6e-6.
  const BeamSection section{1e7, 8.333e5, 8.333e5, 8.333e5, 41.6667e5, 41.6667e5, 0, 0, 0};
  const double x1 = 38.2683, y1 = 7.61205, x2 = 70.7107, y2 = 29.2893;
  const auto tip = [&](int n) -> Vec3 {
    Frame frame{{}, section, Vec3(0, 0, 1), {0, 1, 2, 3, 4, 5}};
    for (int i = 0; i <= n; ++i) {
      const double x = x2 * i / n;
      const double y = y1 * x * (x - x2) / (x1 * (x1 - x2)) + y2 * x * (x - x1) / (x2 * (x2 - x1));
      frame.x.emplace_back(x, y, 0);
    }
    return loaded(frame, load_on(frame, frame.last() + 2, 600), 6).u.back();
  };
  const Vec3 published(-23.6459716009, -13.7208006040, 53.5776450627);
  const Vec3 t8 = tip(8), t16 = tip(16), t32 = tip(32);
  EXPECT_NEAR(std::log2((t8 - published).norm() / (t16 - published).norm()), 2, 0.02);
  EXPECT_NEAR(std::log2((t16 - published).norm() / (t32 - published).norm()), 2, 0.02);
  EXPECT_LT((t32 + (t32 - t16) / 3 - published).norm(), 1e-5 * published.norm());
}

TEST(BeamLarge, BendOf45DegreesAlongTheArcAgreesWithOtherCodes) {
  // Circular arc, torsion constant 0.141 of the square. Geometrically exact elements of Exudyn, 32 of them:
  // tip at (46.90, 15.56, 53.60); their and our errors at 32 elements are of some 0.01.
  const BeamSection section{1e7, 1e7 / 12, 1e7 / 12, 0.141 * 5e6, 5e6, 5e6, 0, 0, 0};
  Frame frame{{}, section, Vec3(0, 0, 1), {0, 1, 2, 3, 4, 5}};
  for (int i = 0; i <= 32; ++i) {
    const double angle = pi / 4 * i / 32;
    frame.x.emplace_back(100 * std::sin(angle), 100 * (1 - std::cos(angle)), 0);
  }
  const FrameState state = loaded(frame, load_on(frame, frame.last() + 2, 600), 6);
  EXPECT_LT((frame.x.back() + state.u.back() - Vec3(46.90, 15.56, 53.60)).norm(), 0.02);
}

// --- stability
// ------------------------------------------------------------------------------------------------------

TEST(BeamStability, FourElementsMeetTheEulerLoadOfACantilever) {
  const double exact = pi * pi / 4;
  const double load = critical_load(cantilever(4, 1, slender()), exact / 2, 2 * exact);
  EXPECT_NEAR(load / exact, 1, 1e-3);
}

TEST(BeamStability, FourElementsMeetTheEulerLoadOfAPinnedColumn) {
  Frame frame = straight(4, 1, slender());
  frame.supported = {0, 1, 2, 3, frame.last() + 1, frame.last() + 2};
  const double exact = pi * pi;
  EXPECT_NEAR(critical_load(frame, exact / 2, 2 * exact) / exact, 1, 1e-3);
}

TEST(BeamStability, ShearFlexibilityLowersTheCriticalLoadAsEngesserFound) {
  // Engesser: 1/P = 1/P_Euler + 1/kGA , here P = 0.835 P_Euler. Where shear prevails the element's deflection
  // is a straight line, whose geometric stiffness is wrong by (pi/8)^2/12 = 1.3 %, here for the 17 % that
  // shear contributes.
  BeamSection section = slender();
  section.shear_stiffness_2 = section.shear_stiffness_3 = 50;
  Frame frame = straight(8, 1, section);
  frame.supported = {0, 1, 2, 3, frame.last() + 1, frame.last() + 2};
  const double exact = 1 / (1 / (pi * pi) + 1. / 50);
  EXPECT_NEAR(critical_load(frame, exact / 2, 2 * exact) / exact, 1, 2.2e-3);
}

// --- mass
// -----------------------------------------------------------------------------------------------------------

TEST(BeamMass, PinnedBeamMeetsTheEulerBernoulliFrequency) {
  BeamSection section{1e6, 3, 2, 1, 0, 0, 0.5, 0, 0};
  section.rotary_inertia_2 = section.rotary_inertia_3 = 1e-9;  // torsion needs some inertia
  Frame frame = straight(8, 2, section);
  frame.supported = {0, 1, 2, 3, frame.last() + 1, frame.last() + 2};
  const VecX omega = frequencies(frame);
  // omega = (pi/L)^2 sqrt(EI/m); the cubic element's error is of the order (pi/8)^4/1440 = 2e-5
  EXPECT_NEAR(omega[0] / (pi * pi / 4 * std::sqrt(2 / 0.5)), 1, 3e-5);
  EXPECT_NEAR(omega[1] / (pi * pi / 4 * std::sqrt(3 / 0.5)), 1, 3e-5);
}

TEST(BeamMass, RigidMotionHasTheKineticEnergyOfABar) {
  const BeamSection section{0, 0, 0, 0, 0, 0, 0.5, 0.3, 0.2};
  const double L = 4;
  Mat<3, 2> x;
  x << 1, 1 + L * 2. / 3, 0, -L / 3, 0, L * 2. / 3;
  const Mat3 frame = beam_frame(x, Vec3(0, 0, 1));
  const Mat<12> mass = beam_mass(section, L, frame);
  EXPECT_LT((mass - mass.transpose()).norm(), 1e-14);
  const auto kinetic = [&](const Vec3& velocity, const Vec3& spin) {
    Vec<12> v;
    const Vec3 arm = frame.col(0) * L / 2;
    v << velocity - spin.cross(arm), spin, velocity + spin.cross(arm), spin;
    return v.dot(mass * v) / 2;
  };
  EXPECT_NEAR(kinetic(Vec3(1, -2, 2), Vec3::Zero()), 0.5 * L * 9 / 2, 1e-13);
  // about the middle: polar inertia along the axis, m L^3/12 + rotary inertia across it
  EXPECT_NEAR(kinetic(Vec3::Zero(), frame.col(0)), (0.3 + 0.2) * L / 2, 1e-13);
  EXPECT_NEAR(kinetic(Vec3::Zero(), frame.col(1)), (0.5 * L * L * L / 12 + 0.3 * L) / 2, 1e-13);
  EXPECT_NEAR(kinetic(Vec3::Zero(), frame.col(2)), (0.5 * L * L * L / 12 + 0.2 * L) / 2, 1e-13);
}

// --- frame
// ----------------------------------------------------------------------------------------------------------

TEST(BeamFrame, HasAxis3TowardsTheOrientation) {
  Mat<3, 2> x;
  x << 0, 2, 0, 0, 0, 0;
  const Mat3 frame = beam_frame(x, Vec3(5, 0, 3));
  EXPECT_LT((frame - Mat3::Identity()).norm(), 1e-15);
}

TEST(BeamFrame, IsOrthonormalForAnAlmostParallelOrientation) {
  Mat<3, 2> x;
  x << 0, 2, 0, 1, 0, 3;
  const Mat3 frame = beam_frame(x, Vec3(2, 1, 3 + 1e-5));
  EXPECT_LT((frame.transpose() * frame - Mat3::Identity()).norm(), 1e-15);
}

TEST(BeamFrame, FallsBackToGlobalAxesWithoutAUsefulOrientation) {
  Mat<3, 2> along_x, along_z;
  along_x << 0, 2, 0, 0, 0, 0;
  along_z << 0, 0, 0, 0, 0, 2;
  EXPECT_LT((beam_frame(along_x, Vec3::Zero()) - Mat3::Identity()).norm(), 1e-15);
  EXPECT_LT((beam_frame(along_x, Vec3(4, 0, 0)) - Mat3::Identity()).norm(), 1e-15);
  const Mat3 upright = beam_frame(along_z, Vec3::Zero());
  EXPECT_LT((upright.col(0) - Vec3(0, 0, 1)).norm(), 1e-15);
  EXPECT_LT((upright.col(2) - Vec3(1, 0, 0)).norm(), 1e-15);
  EXPECT_NEAR(upright.determinant(), 1, 1e-15);
}

}  // namespace tautline::element
