// The ladder that every element climbs. A new element is one more line in `specimens()`.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <new>
#include <ostream>
#include <random>
#include <string>
#include <tautline/element/beam.hpp>
#include <tautline/element/cable.hpp>
#include <tautline/element/membrane.hpp>
#include <vector>

namespace tautline::element {

namespace {

/// Motion of the nodes: displacements, and for elements with spins the rotations.
struct Motion {
  MatX u;  // 3 x n
  std::vector<Mat3> rotation;
};

struct Answer {
  double energy;
  VecX force;
  MatX tangent;
};

/// Adapter of one element in one state.
struct Specimen {
  std::string name;
  bool has_spins = false;
  MatX x_ref;  // 3 x n
  Motion motion;
  /// Evaluates with given nodes; `order` renumbers them (the physical element stays the same).
  std::function<Answer(const Motion&, const std::vector<int>& order, Want)> evaluate;

  int n_nodes() const { return static_cast<int>(x_ref.cols()); }
  int n_dofs() const { return n_nodes() * (has_spins ? 6 : 3); }
  std::vector<int> natural_order() const {
    std::vector<int> order(n_nodes());
    for (int i = 0; i < n_nodes(); ++i) order[i] = i;
    return order;
  }
  Answer at(const Motion& m, Want want = Want::force) const { return evaluate(m, natural_order(), want); }
  Answer here(Want want = Want::tangent) const { return at(motion, want); }
};

void PrintTo(const Specimen& specimen, std::ostream* out) {
  *out << specimen.name;
}

Mat3 turn(const Vec3& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (angle == 0) return Mat3::Identity();
  return Eigen::AngleAxisd(angle, rotation_vector / angle).toRotationMatrix();
}

/// Adds displacements and spatial spins, R -> exp(skew(w)) R.
Motion moved(const Specimen& specimen, const VecX& step) {
  Motion m = specimen.motion;
  const int stride = specimen.has_spins ? 6 : 3;
  for (int i = 0; i < specimen.n_nodes(); ++i) {
    m.u.col(i) += step.segment<3>(stride * i);
    if (specimen.has_spins) m.rotation[i] = turn(step.segment<3>(stride * i + 3)) * m.rotation[i];
  }
  return m;
}

/// The whole element rotated by Q about the origin, then translated.
Motion moved_rigidly(const Specimen& specimen, const Mat3& Q, const Vec3& translation) {
  Motion m = specimen.motion;
  m.u = (Q * (specimen.x_ref + m.u) - specimen.x_ref).colwise() + translation;
  for (Mat3& R : m.rotation) R = Q * R;
  return m;
}

/// Runs a kernel into memory full of NaN, so that whatever it leaves unwritten shows.
template <class Response, class Kernel>
Response evaluated_over_nan(const Kernel& kernel) {
  static_assert(std::is_trivially_destructible_v<Response>);
  alignas(Response) std::array<double, (sizeof(Response) + 7) / 8> memory;
  memory.fill(std::numeric_limits<double>::quiet_NaN());
  return *::new (static_cast<void*>(memory.data())) Response(kernel());
}

template <class Response>
Answer answer_of(const Response& response, Want want) {
  return {response.energy, response.force, want == Want::tangent ? MatX(response.tangent) : MatX()};
}

template <int N>
Mat<3, N> reordered(const MatX& columns, const std::vector<int>& order) {
  Mat<3, N> result;
  for (int i = 0; i < N; ++i) result.col(i) = columns.col(order[i]);
  return result;
}

template <int N>
Vec<3 * N> flat(const Mat<3, N>& columns) {
  return Eigen::Map<const Vec<3 * N>>(columns.data());
}

Specimen cable(const std::string& name, double initial_strain, const Vec3& u_end) {
  Specimen s{name, false, MatX(3, 2), {MatX(3, 2), {}}, {}};
  s.x_ref << 1, 3, -2, 1, 0.5, 1;
  s.motion.u << 0.1, u_end[0], -0.2, u_end[1], 0.05, u_end[2];
  const CableProperties properties{2000, initial_strain};
  s.evaluate = [=, x = s.x_ref](const Motion& m, const std::vector<int>& order, Want want) {
    const auto response = evaluated_over_nan<CableResponse>([&] {
      return evaluate_cable(properties, reordered<2>(x, order), flat<2>(reordered<2>(m.u, order)), want);
    });
    return answer_of(response, want);
  };
  return s;
}

/// Resultants given in one frame as components in another frame of the same plane.
Vec3 in_frame(const Vec3& N, const Mat3& from, const Mat3& to) {
  Mat<2> tensor;
  tensor << N[0], N[2], N[2], N[1];
  const Mat<2> Q = to.leftCols<2>().transpose() * from.leftCols<2>();
  const Mat<2> turned = Q * tensor * Q.transpose();
  return {turned(0, 0), turned(1, 1), turned(0, 1)};
}

Specimen membrane(const std::string& name, double tension_stiffness, const Vec3& prestress) {
  Specimen s{name, false, MatX(3, 3), {MatX(3, 3), {}}, {}};
  s.x_ref << 0, 1.2, 0.3, 0.1, 0.2, 0.9, 0, 0.3, -0.2;
  s.motion.u << 0.05, -0.1, 0.2, 0.03, 0.15, -0.07, 0.1, -0.12, 0.21;
  const MembraneSection section{tension_stiffness, 0.3, 0};
  s.evaluate = [=, x = s.x_ref](const Motion& m, const std::vector<int>& order, Want want) {
    const Mat<3, 3> nodes = reordered<3>(x, order);
    const Vec3 N0 = in_frame(prestress, membrane_frame(x), membrane_frame(nodes));
    const auto response = evaluated_over_nan<MembraneResponse>(
        [&] { return evaluate_membrane(section, N0, nodes, flat<3>(reordered<3>(m.u, order)), want); });
    return answer_of(response, want);
  };
  return s;
}

Specimen beam(const std::string& name, const BeamSection& section, double bend) {
  Specimen s{name, true, MatX(3, 2), {MatX(3, 2), {}}, {}};
  s.x_ref << 1, 2.5, -2, -1, 0.5, 1;
  s.motion.u << 0.1, 0.13, -0.2, -0.1, 0.05, 0.1;
  s.motion.rotation = {turn(bend * Vec3(0.3, -0.8, 0.5)), turn(bend * Vec3(-0.4, 0.6, 0.7))};
  const Mat<3, 2> x = s.x_ref;
  const Mat3 frame = beam_frame(x, Vec3(0.2, 0.3, 1));
  s.evaluate = [=](const Motion& m, const std::vector<int>& order, Want want) {
    BeamGeometry geometry{reordered<2>(x, order), frame};
    if (order[0] == 1) geometry.frame << -frame.col(0), frame.col(1), -frame.col(2);
    const BeamMotion motion{reordered<2>(m.u, order), {m.rotation[order[0]], m.rotation[order[1]]}};
    const auto response =
        evaluated_over_nan<BeamResponse>([&] { return evaluate_beam(section, geometry, motion, want); });
    return answer_of(response, want);
  };
  return s;
}

std::vector<Specimen> specimens() {
  const BeamSection rigid_in_shear{5000, 30, 20, 10, 0, 0, 1, 1, 1};
  const BeamSection shear_flexible{5000, 30, 20, 10, 400, 300, 1, 1, 1};
  return {cable("CableTaut", 0.01, Vec3(0.3, 0.4, -0.2)),
          cable("CableThatStartsSlack", -0.05, Vec3(0.9, 0.8, 0.4)),
          membrane("MembraneElastic", 1000, Vec3::Zero()),
          membrane("MembranePrestressed", 1000, Vec3(40, 70, 25)),
          membrane("MembraneOfPrestressAlone", 0, Vec3(40, 70, 25)),
          beam("BeamSlightlyBent", rigid_in_shear, 1e-3),
          beam("BeamStronglyBent", rigid_in_shear, 1),
          beam("BeamFlexibleInShear", shear_flexible, 0.7)};
}

std::vector<VecX> directions(int n) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<VecX> result;
  for (int i = 0; i < 4; ++i)
    result.push_back(VecX::NullaryExpr(n, [&] { return uniform(engine); }).normalized());
  return result;
}

/// Derivative at 0 by the five-point formula: truncation h^4 f'''''/30, about 1e-10 of f' for h = 2e-3 and
/// states that change over lengths of order 1; rounding 1e-16 f/h.
template <class F>
auto derivative(const F& f) -> decltype(f(0.)) {
  const double h = 2e-3;
  return (8 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h);
}

class ElementLadder : public testing::TestWithParam<Specimen> {};

}  // namespace

TEST_P(ElementLadder, ForceIsTheDerivativeOfTheEnergy) {
  const Specimen& s = GetParam();
  const Answer answer = s.here();
  for (const VecX& d : directions(s.n_dofs())) {
    const double slope = derivative([&](double h) { return s.at(moved(s, h * d)).energy; });
    EXPECT_NEAR(slope, answer.force.dot(d), 1e-8 * answer.force.norm());
  }
}

TEST_P(ElementLadder, EnergyRemainderOfTheForceFallsWithTheSquareOfTheStep) {
  const Specimen& s = GetParam();
  const Answer answer = s.here();
  for (const VecX& d : directions(s.n_dofs())) {
    const auto remainder = [&](double h) {
      return s.at(moved(s, h * d)).energy - answer.energy - h * answer.force.dot(d);
    };
    const double slope = std::log2(std::abs(remainder(1e-4) / remainder(5e-5)));
    EXPECT_NEAR(slope, 2, 0.05);  // next term of the series: relative 1e-4 f'''/f''
  }
}

TEST_P(ElementLadder, TangentIsTheSymmetrisedDerivativeOfTheForce) {
  const Specimen& s = GetParam();
  const Answer answer = s.here();
  MatX derivatives(s.n_dofs(), s.n_dofs());
  for (int i = 0; i < s.n_dofs(); ++i)
    derivatives.col(i) =
        derivative([&](double h) -> VecX { return s.at(moved(s, h * VecX::Unit(s.n_dofs(), i))).force; });
  if (!s.has_spins) {
    EXPECT_LT((derivatives - answer.tangent).norm(), 1e-8 * answer.tangent.norm());
  }
  const MatX symmetric = (derivatives + derivatives.transpose()) / 2;
  EXPECT_LT((symmetric - answer.tangent).norm(), 1e-8 * answer.tangent.norm());
}

TEST_P(ElementLadder, TangentIsSymmetric) {
  const Answer answer = GetParam().here();
  EXPECT_LT((answer.tangent - answer.tangent.transpose()).norm(), 1e-14 * answer.tangent.norm());
}

TEST_P(ElementLadder, TranslationChangesNothing) {
  const Specimen& s = GetParam();
  const Answer before = s.here();
  const Answer after = s.at(moved_rigidly(s, Mat3::Identity(), Vec3(3, -2, 1)), Want::tangent);
  EXPECT_NEAR(after.energy, before.energy, 1e-12 * std::abs(before.energy));
  EXPECT_LT((after.force - before.force).norm(), 1e-11 * before.force.norm());
  EXPECT_LT((after.tangent - before.tangent).norm(), 1e-11 * before.tangent.norm());
}

TEST_P(ElementLadder, FiniteRotationRotatesTheForce) {
  const Specimen& s = GetParam();
  const Answer before = s.here();
  const double degree = std::acos(-1.) / 180;
  for (const double angle : {10., 90., 180., 200., 359., 900.}) {
    const Mat3 Q = turn(angle * degree * Vec3(2, -1, 2) / 3);
    const Answer after = s.at(moved_rigidly(s, Q, Vec3(0.5, 0.1, -0.3)), Want::tangent);
    MatX QQ = MatX::Zero(s.n_dofs(), s.n_dofs());
    for (int i = 0; i < s.n_dofs(); i += 3) QQ.block<3, 3>(i, i) = Q;
    // rounding of coordinates of order 5 against strains of order 1e-2
    EXPECT_NEAR(after.energy, before.energy, 1e-12 * before.force.norm());
    EXPECT_LT((after.force - QQ * before.force).norm(), 1e-12 * before.tangent.norm());
    EXPECT_LT((after.tangent - QQ * before.tangent * QQ.transpose()).norm(), 1e-11 * before.tangent.norm());
  }
}

TEST_P(ElementLadder, ForcesAndTheirMomentsAreInEquilibrium) {
  const Specimen& s = GetParam();
  const Answer answer = s.here();
  Vec3 force = Vec3::Zero();
  Vec3 moment = Vec3::Zero();
  const int stride = s.has_spins ? 6 : 3;
  for (int i = 0; i < s.n_nodes(); ++i) {
    const Vec3 f = answer.force.segment<3>(stride * i);
    const Vec3 x = s.x_ref.col(i) + s.motion.u.col(i);
    force += f;
    moment += x.cross(f);
    if (s.has_spins) moment += answer.force.segment<3>(stride * i + 3);
  }
  EXPECT_LT(force.norm(), 1e-13 * answer.force.norm());
  EXPECT_LT(moment.norm(), 1e-12 * answer.force.norm());
}

TEST_P(ElementLadder, ReversedAndCyclicNodeOrderChangeNothing) {
  const Specimen& s = GetParam();
  const Answer natural = s.here();
  const int n = s.n_nodes();
  const int stride = s.has_spins ? 6 : 3;
  for (const bool reverse : {false, true}) {
    for (int shift = 0; shift < n; ++shift) {
      if (n == 2 && reverse != (shift == 1)) continue;  // the two orders of two nodes
      std::vector<int> order(n);
      for (int i = 0; i < n; ++i) order[i] = (reverse && n > 2 ? n - i + shift : i + shift) % n;
      const Answer other = s.evaluate(s.motion, order, Want::tangent);
      EXPECT_NEAR(other.energy, natural.energy, 1e-12 * std::abs(natural.energy));
      for (int i = 0; i < n; ++i) {
        EXPECT_LT((other.force.segment(stride * i, stride) - natural.force.segment(stride * order[i], stride))
                      .norm(),
                  1e-11 * natural.force.norm());
        for (int j = 0; j < n; ++j)
          EXPECT_LT((other.tangent.block(stride * i, stride * j, stride, stride) -
                     natural.tangent.block(stride * order[i], stride * order[j], stride, stride))
                        .norm(),
                    1e-11 * natural.tangent.norm());
      }
    }
  }
}

TEST_P(ElementLadder, EveryOutputIsWrittenAndNotZero) {
  const Answer answer = GetParam().here();
  EXPECT_TRUE(std::isfinite(answer.energy));
  EXPECT_TRUE(answer.force.allFinite());
  EXPECT_TRUE(answer.tangent.allFinite());
  EXPECT_NE(answer.energy, 0);
  EXPECT_GT(answer.force.norm(), 0);
  EXPECT_GT(answer.tangent.norm(), 0);
}

TEST_P(ElementLadder, ForceIsTheSameWhetherTheTangentIsWantedOrNot) {
  const Answer with = GetParam().here(Want::tangent);
  const Answer without = GetParam().here(Want::force);
  EXPECT_EQ(with.energy, without.energy);
  EXPECT_EQ(with.force, without.force);
}

INSTANTIATE_TEST_SUITE_P(All, ElementLadder, testing::ValuesIn(specimens()),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace tautline::element
