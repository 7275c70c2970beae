#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <tautline/element/shell.hpp>

#include "shell_model.hpp"

namespace tautline::element {

namespace {

using namespace testing_shell;

const double pi = std::acos(-1.);

template <class Nodes>
class Shell : public testing::Test {};
using BothShapes = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
struct ShapeName {
  template <class Nodes>
  static std::string GetName(int) {
    return Nodes::value == 3 ? "Triangle" : "Quadrilateral";
  }
};
TYPED_TEST_SUITE(Shell, BothShapes, ShapeName);

/// Solution of the linear problem with given displacements at `supported` dofs and no load.
template <int N>
VecX linear_solution_from(const ShellModel<N>& model, const VecX& given) {
  ShellModel<N> free = model;
  free.supported.clear();
  VecX fixed = VecX::Zero(model.n_dofs());
  for (const int dof : model.supported) fixed[dof] = given[dof];
  const auto lower = assemble(free, free.at_rest()).tangent;
  return fixed + linear_solution(model, -(lower.template selfadjointView<Eigen::Lower>() * fixed));
}

template <int N>
ShellState state_of(const ShellModel<N>& model, const VecX& displacements) {
  ShellState state = model.at_rest();
  move(state, displacements);
  return state;
}

// --- patch tests
// ------------------------------------------------------------------------------------------------

/// Patch of MacNeal & Harder (1985): rectangle 0.24 x 0.12 with four inner nodes that make every element
/// distorted; each quadrilateral is cut along a diagonal for triangles.
template <int N>
ShellModel<N> macneal_patch() {
  ShellModel<N> patch;
  patch.section = {1e6, 0.25, 1e-3, 0, 5. / 6, 0};
  patch.x = {{0, 0, 0},     {.24, 0, 0},   {.24, .12, 0}, {0, .12, 0},
             {.04, .02, 0}, {.18, .03, 0}, {.16, .08, 0}, {.08, .08, 0}};
  patch.normal.assign(8, Vec3(0, 0, 1));
  const std::array<std::array<int, 4>, 5> quadrilaterals{
      {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}, {4, 5, 6, 7}}};
  for (const auto& [a, b, c, d] : quadrilaterals) {
    if constexpr (N == 4) {
      patch.elements.push_back({a, b, c, d});
    } else {
      patch.elements.push_back({a, b, c});
      patch.elements.push_back({a, c, d});
    }
  }
  patch.support([](const Vec3& x) { return x[0] == 0 || x[0] == .24 || x[1] == 0 || x[1] == .12; },
                {0, 1, 2, 3, 4, 5});
  return patch;
}

using Field = std::function<Vec<6>(const Vec3&)>;

template <int N>
VecX nodal(const ShellModel<N>& model, const Field& field) {
  VecX values(model.n_dofs());
  for (int i = 0; i < model.n_nodes(); ++i) values.segment<6>(6 * i) = field(model.x[i]);
  return values;
}

/// Components in the patch's axes x, y of resultants in the element's frame.
template <int N>
Vec3 in_global_axes(const ShellModel<N>& model, int element, const Vec3& resultants) {
  const Mat<2> Q = shell_frame<N>(corners(model, element)).template topLeftCorner<2, 2>();
  Mat<2> tensor;
  tensor << resultants[0], resultants[2], resultants[2], resultants[1];
  tensor = (Q * tensor * Q.transpose()).eval();
  return {tensor(0, 0), tensor(1, 1), tensor(0, 1)};
}

template <int N>
Vec<2> in_global_axes(const ShellModel<N>& model, int element, const Vec<2>& shear) {
  return shell_frame<N>(corners(model, element)).template topLeftCorner<2, 2>() * shear;
}

/// Boundary values from `field`: inner nodes must follow it. Returns the state, scaled to be small.
template <int N>
ShellState patch_follows(const ShellModel<N>& patch, const Field& field) {
  const VecX exact = nodal(patch, field);
  const VecX found = linear_solution_from(patch, exact);
  EXPECT_LT((found - exact).norm(), 1e-9 * exact.norm());  // condition number times rounding
  return state_of(patch, exact);
}

}  // namespace

TYPED_TEST(Shell, MembranePatchIsUniform) {
  constexpr int N = TypeParam::value;
  const auto patch = macneal_patch<N>();
  const double e = 1e-9;  // u = e (x + y/2), v = e (y + x/2): Green's strain differs from it by e
  const ShellState state = patch_follows<N>(patch, [&](const Vec3& x) {
    return (Vec<6>() << e * (x[0] + x[1] / 2), e * (x[1] + x[0] / 2), 0, 0, 0, 0).finished();
  });
  for (int k = 0; k < static_cast<int>(patch.elements.size()); ++k) {
    const Vec3 force = in_global_axes(patch, k, evaluate(patch, state, k).forces.membrane);
    // plane stress: E h e/(1 - nu), G h e
    EXPECT_LT((force - Vec3(4. / 3, 4. / 3, .4) * 1e3 * e).norm(), 1e-7 * 1e3 * e);
  }
}

TYPED_TEST(Shell, BendingPatchIsUniform) {
  constexpr int N = TypeParam::value;
  const auto patch = macneal_patch<N>();
  const double a = 1e-7;  // w = a (x^2 + x y + y^2)/2
  const ShellState state = patch_follows<N>(patch, [&](const Vec3& x) {
    const double wx = a * (x[0] + x[1] / 2), wy = a * (x[1] + x[0] / 2);
    return (Vec<6>() << 0, 0, a * (x[0] * x[0] + x[0] * x[1] + x[1] * x[1]) / 2, wy, -wx, 0).finished();
  });
  const double rigidity = 1e6 * 1e-9 / (12 * (1 - .0625));
  for (int k = 0; k < static_cast<int>(patch.elements.size()); ++k) {
    const ShellForces forces = evaluate(patch, state, k).forces;
    // fibres on the side of the director are shortened by w'' > 0
    const Vec3 moment = in_global_axes(patch, k, forces.moment);
    EXPECT_LT((moment + rigidity * a * Vec3(1.25, 1.25, .375)).norm(), 1e-6 * rigidity * a);
    EXPECT_LT(forces.shear.norm(), 1e-6 * rigidity * a / .04);
  }
}

TYPED_TEST(Shell, ShearPatchIsUniform) {
  // Uniform shear without rotation needs couples spread over the area, so this state is given, not solved
  // for: resultants must be uniform and inner nodes free of forces. Very thick, as a triangle's bubble yields
  // under those couples, by (size/thickness)^2 = 1e-6.
  constexpr int N = TypeParam::value;
  auto patch = macneal_patch<N>();
  patch.section.thickness = 100;
  const double a = 1e-9;  // w = a (x - 2 y)
  const ShellState state = state_of(patch, nodal(patch, [&](const Vec3& x) {
                                      return (Vec<6>() << 0, 0, a * (x[0] - 2 * x[1]), 0, 0, 0).finished();
                                    }));
  const double kGh = 5. / 6 * 4e5 * 100;
  for (int k = 0; k < static_cast<int>(patch.elements.size()); ++k) {
    const ShellForces forces = evaluate(patch, state, k).forces;
    EXPECT_LT((in_global_axes(patch, k, forces.shear) - kGh * a * Vec<2>(1, -2)).norm(), 2e-6 * kGh * a);
    EXPECT_LT(forces.moment.norm(), 1e-12 * kGh * a);
  }
  const VecX force = assemble(patch, state).force;
  for (int node = 4; node < 8; ++node) EXPECT_LT(std::abs(force[6 * node + 2]), 2e-6 * kGh * a * .04);
}

TYPED_TEST(Shell, UniformTractionIsHeldByNodalForcesOfTheEdges) {
  // Patch test by traction: N11 = 1 N/m of prestress is held at the edges x = const by half of the side's
  // force at each node, and by nothing inside.
  constexpr int N = TypeParam::value;
  auto patch = macneal_patch<N>();
  patch.prestress(0, 0) = 1;
  const VecX force = assemble(patch, patch.at_rest()).force;
  VecX exact = VecX::Zero(patch.n_dofs());
  for (const int node : {0, 3}) exact[6 * node] = -.06;
  for (const int node : {1, 2}) exact[6 * node] = .06;
  EXPECT_LT((force - exact).norm(), 1e-14);
}

// --- states without stress
// ------------------------------------------------------------------------------------------------

namespace {

const ShellSection steel{2.1e11, 0.3, 0.01, 7850, 5. / 6, 1.2e-5};

/// A warped, curved piece of shell of some 3 m.
template <int N>
ShellModel<N> saddle(int n, const ShellSection& section) {
  return grid<N>(
      n, n, [](double r, double s) { return Vec3(3 * r, 2 * s + .3 * r * r, .8 * r * s - .4 * s * s); },
      section);
}

}  // namespace

TYPED_TEST(Shell, RigidMotionLeavesNoForce) {
  constexpr int N = TypeParam::value;
  const auto model = saddle<N>(3, steel);
  ShellState state = model.at_rest();
  const Mat3 Q = Eigen::AngleAxisd(3, Vec3(2, -1, 2) / 3).toRotationMatrix();
  for (int i = 0; i < model.n_nodes(); ++i) {
    state.u[i] = Q * model.x[i] - model.x[i] + Vec3(1, 2, 3);
    state.rotation[i] = Q;
  }
  const double rounding = 1e-14;  // coordinates of order 10 against elements of order 1
  EXPECT_LT(assemble(model, state).force.cwiseAbs().maxCoeff(), rounding * 2.1e11 * 0.01);
}

TYPED_TEST(Shell, OneElementHasNoMechanism) {
  // All but the six rigid motions meet stiffness; a warped element, thick enough that stiffnesses are
  // comparable.
  constexpr int N = TypeParam::value;
  const auto model = saddle<N>(3, {1, 0.3, 0.5, 1, 5. / 6, 0});
  const Mat<6 * N> tangent = evaluate(model, model.at_rest(), 4).tangent;
  const VecX values = Eigen::SelfAdjointEigenSolver<MatX>(tangent, Eigen::EigenvaluesOnly).eigenvalues();
  EXPECT_LT(values.head<6>().cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_GT(values[6], 1e-4);
}

TYPED_TEST(Shell, FreeExpansionMakesNoStress) {
  constexpr int N = TypeParam::value;
  auto model = saddle<N>(3, steel);
  model.free_strain = 1.2e-3;
  ShellState state = model.at_rest();
  const double growth = std::sqrt(1 + 2 * model.free_strain) - 1;  // Green's strain is growth + growth^2/2
  for (int i = 0; i < model.n_nodes(); ++i) state.u[i] = growth * model.x[i];
  EXPECT_LT(assemble(model, state).force.cwiseAbs().maxCoeff(), 1e-14 * 2.1e11 * 0.01);
  EXPECT_GT(assemble(model, model.at_rest()).force.norm(), 1e-4 * 2.1e11 * 0.01);
}

TYPED_TEST(Shell, PreventedExpansionCompresses) {
  constexpr int N = TypeParam::value;
  auto model = grid<N>(
      1, 1, [](double r, double s) { return Vec3(2 * r, s, 0); }, steel);
  model.free_strain = 1e-4;
  const Vec3 force = evaluate(model, model.at_rest(), 0).forces.membrane;
  const double expected = -2.1e11 * 0.01 * 1e-4 / (1 - 0.3);
  EXPECT_LT((force - Vec3(expected, expected, 0)).norm(), 1e-14 * 2.1e11 * 0.01);
}

// --- membrane
// ------------------------------------------------------------------------------------------------

TYPED_TEST(Shell, SmallStrainsKeepTheirDigits) {
  // Element of 1 m far from the origin, strain 1e-10, director turn 1e-10 over its length: both resultants
  // keep five digits (turns are differences of rotation matrices, whose diagonal is rounded at 1e-16).
  constexpr int N = TypeParam::value;
  const auto model = grid<N>(
      1, 1, [](double r, double s) { return Vec3(30 + r, 40 + s, 50); }, steel);
  ShellState state = model.at_rest();
  for (int i = 0; i < 4; ++i) {
    const double x = model.x[i][0] - 30;
    state.u[i] = Vec3(1e-10 * x, 0, -1e-10 * x * x / 2);
    state.rotation[i] = Eigen::AngleAxisd(1e-10 * x, Vec3(0, 1, 0)).toRotationMatrix();
  }
  const ShellForces forces = evaluate(model, state, 0).forces;
  const double D = 2.1e11 * 0.01 / (1 - .09);
  EXPECT_NEAR(forces.membrane[0] / (D * 1e-10), 1, 1e-5);
  EXPECT_NEAR(forces.moment[0] / (D * 1e-4 / 12 * 1e-10), 1, 1e-5);
}

TEST(ShellMembrane, OneQuadrilateralAcrossBendsInItsPlaneLikeABeam) {
  // In-plane pure bending of a strip by couples of forces, rectangles one deep and twice as long: the
  // element's linear modes are those of the beam, and its nodes turn with them, so that drilling costs
  // nothing.
  const double L = 10, b = 1, M = 1;
  auto strip = grid<4>(5, 1, [&](double r, double s) { return Vec3(L * r, b * (s - .5), 0); },
                       {1e6, 0.3, .1, 0, 5. / 6, 0});
  strip.support([](const Vec3& x) { return x[0] == 0; }, {0, 2, 3, 4});
  strip.supported.push_back(1);
  const VecX u = linear_solution(strip, strip.load(5, 0, M / b) + strip.load(11, 0, -M / b));
  const double EI = 1e6 * b * b * b * .1 / 12;
  // at the lower corner, Poisson's ratio moves the edge by nu kappa b^2/8 in respect of the axis at both ends
  EXPECT_NEAR(u[6 * 5 + 1] / (M * L * L / (2 * EI)), 1, 1e-9);
  EXPECT_NEAR(u[6 * 5 + 5] / (M * L / EI), 1, 1e-9);
}

TYPED_TEST(Shell, MomentAboutTheNormalIsCarriedAsACouple) {
  // Moments on the drilling rotations of the end of a strip that is clamped at the other.
  constexpr int N = TypeParam::value;
  const double L = 8, b = 1, M = 1;
  const int across = N == 4 ? 1 : 12;  // triangles of constant strain need a finer mesh
  const int n = 8 * across;
  auto strip = grid<N>(n, across, [&](double r, double s) { return Vec3(L * r, b * (s - .5), 0); },
                       {1e6, 0, .1, 0, 5. / 6, 0});
  strip.support([](const Vec3& x) { return x[0] == 0; }, {0, 1, 2, 3, 4, 5});
  VecX load = VecX::Zero(strip.n_dofs());
  for (int j = 0; j <= across; ++j) load += strip.load(n + (n + 1) * j, 5, M / (across + 1));
  const VecX u = linear_solution(strip, load);
  const double EI = 1e6 * b * b * b * .1 / 12;
  EXPECT_NEAR(u[6 * n + 1] / (M * L * L / (2 * EI)), 1, 0.03);
}

TYPED_TEST(Shell, PrestressCarriesTransverseLoadAlongItsDirection) {
  // Strip without bending stiffness worth mentioning, N11 along its length x: sag of a string, q L^2/(8 N).
  constexpr int N = TypeParam::value;
  const double L = 2, pull = 1e3, q = 1e-3;
  auto strip = grid<N>(20, 1, [&](double r, double s) { return Vec3(L * r, .1 * s, 0); },
                       {1e6, 0, 1e-4, 0, 5. / 6, 0});
  strip.prestress(0, 0) = pull;
  strip.support([&](const Vec3& x) { return near(x[0], 0) || near(x[0], L); }, {0, 1, 2, 3, 5});
  VecX load = VecX::Zero(strip.n_dofs());
  for (int i = 0; i < strip.n_nodes(); ++i) load[6 * i + 2] = q * .1 / 2 * L / 20;
  EXPECT_NEAR(linear_solution(strip, load)[6 * 10 + 2] / (q * L * L / (8 * pull)), 1, 1e-6);
}

// --- bending and shear
// ------------------------------------------------------------------------------------------------

TEST(ShellBending, StripMeetsTheTimoshenkoCantileverHoweverThin) {
  // n quadrilaterals in a row, nu = 0: each bends like the two-node beam with one shear strain, whose tip
  // deflection is P L^3/(3 EI) (1 - 1/(4 n^2)) + P L/(kGA) exactly.
  const double L = 10, b = 1, P = 1e-9;
  const int n = 8;
  for (const double h : {1., 1e-1, 1e-2, 1e-3}) {
    const ShellSection section{1e6, 0, h, 0, 5. / 6, 0};
    auto strip = grid<4>(
        n, 1, [&](double r, double s) { return Vec3(L * r, b * s, 0); }, section);
    strip.support([](const Vec3& x) { return x[0] == 0; }, {0, 1, 2, 3, 4, 5});
    const VecX u = linear_solution(strip, strip.load(n, 2, P / 2) + strip.load(2 * n + 1, 2, P / 2));
    const double I = b * h * h * h / 12;
    const double exact = P * L * L * L / (3e6 * I) * (1 - 1. / (4 * n * n)) + P * L / (5. / 6 * 5e5 * b * h);
    EXPECT_NEAR(u[6 * n + 2] / exact, 1, 1e-6) << h;  // condition (L/h)^2 n^4 times rounding
  }
}

TYPED_TEST(Shell, ClampedPlateDoesNotLockHoweverThinAndDistorted) {
  // Clamped square plate, force in the middle: w = 0.0056121 P L^2/D (Timoshenko & Woinowsky-Krieger, 1959:
  // 0.00560). Quarter, skewed inside; meshes such that the error of all thicknesses is below 2 %.
  constexpr int N = TypeParam::value;
  double previous = 0;
  const int n = N == 4 ? 8 : 14;
  for (const double h : {1e-2, 1e-3, 1e-4}) {
    const ShellSection section{1e6, 0.3, h, 0, 5. / 6, 0};
    const auto distorted = [](double r, double s) {
      const double bump = std::sin(pi * r) * std::sin(pi * s);
      return Vec3(.5 * r + .06 * bump, .5 * s - .08 * bump * r, 0);
    };
    auto plate = grid<N>(n, n, distorted, section);
    plate.support([](const Vec3& x) { return near(x[0], 0); }, {0, 4, 5});
    plate.support([](const Vec3& x) { return near(x[1], 0); }, {1, 3, 5});
    plate.support([](const Vec3& x) { return near(x[0], .5) || near(x[1], .5); }, {0, 1, 2, 3, 4, 5});
    const double D = 1e6 * h * h * h / (12 * (1 - .09));
    const double w = linear_solution(plate, plate.load(0, 2, D / 4))[2];
    EXPECT_NEAR(w / 0.0056121, 1, 0.02) << h;
    if (h < 1e-3) {
      EXPECT_NEAR(w / previous, 1, 1e-4);
    }  // shear contributes (h/L)^2 = 1e-6
    previous = w;
  }
}

// --- inertia
// ------------------------------------------------------------------------------------------------

TYPED_TEST(Shell, MassOfRigidMotionIsThatOfThePlate) {
  constexpr int N = TypeParam::value;
  const double a = 2, b = 1.5, h = .1;
  // a rectangle about the origin, cut into distorted elements
  const ShellSection section{1, 0, h, 10, 5. / 6, 0};
  const auto plate = grid<N>(
      3, 3,
      [&](double r, double s) {
        return Vec3(a * (r - .5 + .3 * r * (1 - r) * s * (1 - s)),
                    b * (s - .5 + .4 * r * (1 - r) * s * (1 - s)), 0);
      },
      section);
  MatX mass = MatX::Zero(plate.n_dofs(), plate.n_dofs());
  double area = 0;
  for (int e = 0; e < static_cast<int>(plate.elements.size()); ++e) {
    const Mat<6 * N> of_element = shell_mass<N>(section, corners(plate, e));
    area += shell_area<N>(corners(plate, e));
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j)
        mass.block<6, 6>(6 * plate.elements[e][i], 6 * plate.elements[e][j]) +=
            of_element.template block<6, 6>(6 * i, 6 * j);
  }
  EXPECT_NEAR(area, a * b, 1e-14);
  const auto inertia = [&](const Vec3& velocity, const Vec3& spin) {
    const VecX v =
        nodal(plate, [&](const Vec3& x) { return (Vec<6>() << velocity + spin.cross(x), spin).finished(); });
    return v.dot(mass * v);
  };
  const double m = 10 * h * a * b;
  EXPECT_NEAR(inertia(Vec3(1, 2, 3), Vec3::Zero()), 14 * m, 1e-13 * m);
  EXPECT_NEAR(inertia(Vec3::Zero(), Vec3(1, 0, 0)), m * (b * b + h * h) / 12, 1e-13 * m);
  EXPECT_NEAR(inertia(Vec3::Zero(), Vec3(0, 1, 0)), m * (a * a + h * h) / 12, 1e-13 * m);
  // about the normal the same h^2/12 comes on top, small against a^2 + b^2
  EXPECT_NEAR(inertia(Vec3::Zero(), Vec3(0, 0, 1)), m * (a * a + b * b + h * h) / 12, 1e-13 * m);
}

// --- published shells, large displacements: Sze, Liu & Lo (2004)
// ------------------------------------------------------------------------------------------------

namespace {

/// Cantilever of Sze et al. under a shear force at its end, n x 1 cells.
template <int N>
struct ShearedCantilever {
  int n;
  ShellModel<N> model;
  VecX load;

  explicit ShearedCantilever(int cells)
      : n(cells),
        model(grid<N>(n, 1, [](double r, double s) { return Vec3(10 * r, s, 0); },
                      {1.2e6, 0, 0.1, 0, 5. / 6, 0})) {
    model.support([](const Vec3& x) { return x[0] == 0; }, {0, 1, 2, 3, 4, 5});
    load = model.load(n, 2, 2) + model.load(2 * n + 1, 2, 2);
  }
};

}  // namespace

TYPED_TEST(Shell, SzeCantileverUnderEndShear) {
  ShearedCantilever<TypeParam::value> c(16);
  ShellState state = c.model.at_rest();
  const std::array<std::array<double, 2>, 4> table{
      {{3.015, .563}, {4.933, 1.604}, {6.031, 2.541}, {6.698, 3.286}}};
  for (int i = 0; i < 4; ++i) {
    equilibrate(c.model, c.load * (i + 1) / 4, state);
    EXPECT_NEAR(state.u[c.n][2] / table[i][0], 1, 3e-3);
    EXPECT_NEAR(-state.u[c.n][0] / table[i][1], 1, 3e-3);
  }
}

TYPED_TEST(Shell, NewtonConvergesQuadratically) {
  ShearedCantilever<TypeParam::value> c(8);
  ShellState state = c.model.at_rest();
  const History steps = equilibrate(c.model, c.load / 10, state);
  // The last step measures the error before it, the one before that the error one iteration earlier. Linear
  // convergence, even by a factor of 1000 in each iteration, would miss this.
  const std::size_t last = steps.size() - 1;
  ASSERT_LT(steps[last - 1], 1e-4);
  EXPECT_LT(steps[last], 10 * steps[last - 1] * steps[last - 1]);
}

TEST(ShellLarge, EndMomentRollsTheCantileverUpAtSecondOrder) {
  // Exact: a circle, U = L (1 - sin a/a), W = L (1 - cos a)/a, here for a half circle. Nodes of n elements
  // lie on a polygon; turns and chords are wrong by the order of 1/n^2.
  const double M = 25 * pi / 3;
  double error[2];
  for (const int level : {0, 1}) {
    const int n = level == 0 ? 12 : 24;
    auto strip =
        grid<4>(n, 1, [](double r, double s) { return Vec3(12 * r, s, 0); }, {1.2e6, 0, 0.1, 0, 5. / 6, 0});
    strip.support([](const Vec3& x) { return x[0] == 0; }, {0, 1, 2, 3, 4, 5});
    const VecX load = strip.load(n, 4, -M / 2) + strip.load(2 * n + 1, 4, -M / 2);
    ShellState state = strip.at_rest();
    for (int i = 1; i <= 4; ++i) equilibrate(strip, load * i / 4, state);
    error[level] = std::hypot(-state.u[n][0] - 12, state.u[n][2] - 24 / pi);
  }
  EXPECT_LT(error[1], 0.005 * 12);
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.1);
}

TYPED_TEST(Shell, SzeHingedRoofUpToItsLimit) {
  constexpr int N = TypeParam::value;
  const double R = 2540, half = 254, angle = 0.1;
  const int n = N == 4 ? 8 : 16;
  auto roof = grid<N>(
      n, n,
      [&](double r, double s) { return Vec3(half * r, R * std::sin(angle * s), R * std::cos(angle * s)); },
      {3102.75, 0.3, 12.7, 0, 5. / 6, 0});
  roof.support([&](const Vec3& x) { return near(x[1], R * std::sin(angle)); }, {0, 1, 2, 4, 5});
  mirror(roof, 0, [](const Vec3& x) { return near(x[0], 0); });
  mirror(roof, 1, [](const Vec3& x) { return near(x[1], 0); });
  const VecX load = roof.load(0, 2, -750);
  ShellState state = roof.at_rest();
  double factor = 0;
  const std::array<std::array<double, 2>, 4> table{
      {{3.087, .3473}, {5.802, .5647}, {8.237, .6908}, {10.358, .7412}}};
  for (const auto& [w, expected] : table)
    EXPECT_NEAR(equilibrate_at(roof, load, 2, -w, factor, state) / expected, 1, 0.01) << "w = " << w;
}

TEST(ShellLarge, SzeSlitAnnulusLifted) {
  // 0.1 of the full load lifts the slit edge by 4 to 6 of the plate's 10 units
  const int n = 40, m = 5;
  auto plate =
      grid<4>(n, m,
              [](double r, double s) {
                return Vec3((6 + 4 * s) * std::cos(2 * pi * r), (6 + 4 * s) * std::sin(2 * pi * r), 0);
              },
              {21e6, 0, 0.03, 0, 5. / 6, 0});
  VecX load = VecX::Zero(plate.n_dofs());
  for (int j = 0; j <= m; ++j) {
    for (int d = 0; d < 6; ++d) plate.supported.push_back(6 * (n + j * (n + 1)) + d);
    load += plate.load(j * (n + 1), 2, 0.08 * 4 / m * (j == 0 || j == m ? .5 : 1));
  }
  ShellState state = plate.at_rest();
  for (int i = 1; i <= 4; ++i) equilibrate(plate, load * i / 4, state);
  EXPECT_NEAR(state.u[0][2] / 4.277, 1, 0.02);
  EXPECT_NEAR(state.u[m * (n + 1)][2] / 5.876, 1, 0.02);
}

}  // namespace tautline::element
