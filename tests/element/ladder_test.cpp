// The ladder that every element climbs. A new element is a file specimens_<element>.cpp and a line in
// `specimens()`.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "specimen.hpp"

namespace tautline::element {

namespace {

std::vector<Specimen> specimens() {
  std::vector<Specimen> all;
  for (const auto& of_element : {cable_specimens(), membrane_specimens(), beam_specimens(),
                                 catenary_specimens(), spring_specimens(), shell_specimens()})
    all.insert(all.end(), of_element.begin(), of_element.end());
  return all;
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

/// Elements of which no node is first by nature.
class ReversibleElement : public ElementLadder {};

std::vector<Specimen> reversible_specimens() {
  auto all = specimens();
  std::erase_if(all, [](const Specimen& s) { return !s.may_reverse_nodes; });
  return all;
}

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
  const Vec3 way(3, -2, 1);
  const Answer after = s.at(moved_rigidly(s, Mat3::Identity(), way), Want::tangent);
  const double work = s.field_force.dot(way);
  EXPECT_NEAR(after.energy + work, before.energy, 1e-12 * (std::abs(before.energy) + std::abs(work)));
  EXPECT_LT((after.force - before.force).norm(), 1e-11 * before.force.norm());
  EXPECT_LT((after.tangent - before.tangent).norm(), 1e-11 * before.tangent.norm());
}

TEST_P(ElementLadder, FiniteRotationRotatesTheForce) {
  const Specimen& s = GetParam();
  const Answer before = s.here();
  const Vec3 way(0.5, 0.1, -0.3);
  const double degree = std::acos(-1.) / 180;
  for (const double angle : {10., 90., 180., 200., 359., 900.}) {
    const Mat3 Q = turn(angle * degree * Vec3(2, -1, 2) / 3);
    const Specimen in_turned_field = s.in_turned_field ? s.in_turned_field(Q) : s;
    const Answer after = in_turned_field.at(moved_rigidly(s, Q, way), Want::tangent);
    const double work = (Q * s.field_force).dot(way);
    MatX QQ = MatX::Zero(s.n_dofs(), s.n_dofs());
    for (int i = 0; i < s.n_dofs(); i += 3) QQ.block<3, 3>(i, i) = Q;
    // rounding of coordinates of order 5 against strains of order 1e-2
    EXPECT_NEAR(after.energy + work, before.energy, 1e-12 * before.force.norm());
    EXPECT_LT((after.force - QQ * before.force).norm(), 1e-12 * before.tangent.norm());
    EXPECT_LT((after.tangent - QQ * before.tangent * QQ.transpose()).norm(), 1e-11 * before.tangent.norm());
  }
}

TEST_P(ElementLadder, ForcesAndTheirMomentsAreInEquilibrium) {
  const Specimen& s = GetParam();
  const Answer answer = s.here();
  const MatX x = s.x_ref + s.motion.u;
  Vec3 force = s.field_force;  // internal forces carry the field's
  Vec3 moment = Vec3::Zero();
  const int stride = s.has_spins ? 6 : 3;
  for (int i = 0; i < s.n_nodes(); ++i) {
    const Vec3 f = answer.force.segment<3>(stride * i);
    force += f;
    moment += (x.col(i) - x.col(0)).head<3>().cross(f);
    if (s.has_spins) moment += answer.force.segment<3>(stride * i + 3);
  }
  EXPECT_LT(force.norm(), 1e-13 * answer.force.norm());
  // The field pulls somewhere in the plane of the chord and itself, so that its moment turns about their
  // normal.
  const Vec3 normal = Vec3(x.rightCols<1>() - x.col(0)).cross(s.field_force);
  if (!normal.isZero(0)) moment -= normal * moment.dot(normal) / normal.squaredNorm();
  EXPECT_LT(moment.norm(), 1e-12 * answer.force.norm());
}

TEST_P(ReversibleElement, ReversedAndCyclicNodeOrderChangeNothing) {
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
INSTANTIATE_TEST_SUITE_P(All, ReversibleElement, testing::ValuesIn(reversible_specimens()),
                         [](const auto& instance) { return instance.param.name; });

}  // namespace tautline::element
