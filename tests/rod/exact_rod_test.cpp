#include <tautline/rod/exact_rod.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rod/antennas.hpp>

#include <tautline/rod/cantilever_model.hpp>
#include <tautline/rod/elastica.hpp>
#include <tautline/rod/report.hpp>

namespace tautline::rod {
namespace {

ExactOptions with(ExactForm form) {
  ExactOptions options;
  options.form = form;
  return options;
}

/// Cantilever of m equal links, length 1, EI = 1, its end pressed with nu; starts from the elastica's angles.
RodSolution press(double nu, int m, int mode = 1) {
  const Elastica elastica(nu, mode);
  VecX start(m), reactions = VecX::Zero(m);
  for (int k = 0; k < m; ++k) start[k] = elastica.angle((k + 1.0) / m);
  reactions[m - 1] = nu;
  return load_exact({VecX::Constant(m, 1.0 / m), VecX::Ones(m), {}}, reactions, start, {});
}

TEST(ExactRod, PressedAtItsEndIsTheElastica) {
  for (const double nu : {2.5, 3.0, 3.5, 12.0}) {
    for (const int m : {4, 7}) {
      const RodSolution found = press(nu, m);
      ASSERT_TRUE(found.summary.converged()) << found.summary.reason;
      const Elastica elastica(nu);
      EXPECT_NEAR(found.shape.x[m - 1], elastica.end_x(), 1e-12);
      EXPECT_NEAR(found.shape.y[m - 1], elastica.end_y(), 1e-12);
      for (const RodPoint& point : found.shape.curve)
        EXPECT_NEAR(point.angle, elastica.angle(point.s), 1e-11);
    }
  }
}

// Maddocks (1984): on the j-th buckled branch of the cantilever the second variation has index j - 1.
TEST(ExactRod, OnlyTheFirstBuckledShapeIsStable) {
  EXPECT_EQ(press(3.0, 4).stability.unstable, 0);
  EXPECT_EQ(press(12.0, 4).stability.unstable, 0);
  const RodSolution second = press(25.0, 6, 2);
  ASSERT_TRUE(second.summary.converged()) << second.summary.reason;
  EXPECT_NEAR(second.shape.y[5], Elastica(25.0, 2).end_y(), 1e-11);
  EXPECT_EQ(second.stability.unstable, 1);
}

struct Case {
  int antenna;
  ExactForm form;
  std::vector<double> reaction, angle, x, y, moment, length;
};

// Independent computation with 30 digits, rounded to the digits given.
const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {0,
       ExactForm::nodes_on_surface,
       {62.33929059, 38.63549736, 6.35802325, 17.64415810},
       {0.3924930277, 0.6484576666, 0.8103005059, 0.9019479156},
       {3.1593601907, 5.7328219435, 7.9469921713, 9.8778900383},
       {0.6654371210, 2.1910164957, 4.2103123047, 6.5048474406},
       {267.15497289, 184.51139563, 88.95264491, 40.48514070, 0},
       {3, 3, 3, 3}},
      {4,
       ExactForm::nodes_on_surface,
       {712.46641645, 300.48195963, 109.02738233, 2.04141982, 10.16439889, 50.47155207},
       {0.4027653882, 0.6611828054, 0.8159784039, 0.9277145452, 0.9926973875, 1.0459537720},
       {2.1830113644, 3.8878051284, 5.3550481938, 6.6353526453, 7.7753688435, 8.8080218389},
       {0.4765538617, 1.5115028717, 2.8676541157, 4.4027904728, 6.0456360653, 7.7581248715},
       {1560.95951026, 1003.81256879, 515.12339794, 282.26578340, 186.04747274, 86.43196795, 0},
       {2, 2, 2, 2, 2, 2}},
      {0,
       ExactForm::nodes_on_target,
       {62.35856381, 38.63655045, 6.35567881, 17.64639803},
       {0.3924497194, 0.6484490127, 0.8102983295, 0.9019382747},
       {3.1589822447, 5.7327226465, 7.9469522435, 9.8776719781},
       {0.6652779215, 2.1909405961, 4.2102699974, 6.5045602471},
       {267.15652387, 184.51947402, 88.95405838, 40.48595894, 0},
       {2.9995899281, 3.0002852429, 3.0000668420, 2.9996976385}},
      {4,
       ExactForm::nodes_on_target,
       {712.84108136, 300.44926880, 109.02582524, 2.04004702, 10.16509899, 50.47115249},
       {0.4027020995, 0.6611913421, 0.8159785405, 0.9277202913, 0.9926984003, 1.0459543556},
       {2.1826422952, 3.8878694720, 5.3550521566, 6.6354305700, 7.7753832391, 8.8080347176},
       {0.4763927389, 1.5115529031, 2.8676583600, 4.4028938849, 6.0456584515, 7.7581475586},
       {1560.97937147, 1003.86376422, 515.11145120, 282.26526424, 186.04238423, 86.43129886, 0},
       {1.9995973461, 2.0004845978, 1.9999242842, 2.0001236994, 1.9998971429, 1.9999994702}}};
  return all;
}

// Half a unit of the last digit given, plus rounding.
TEST(ExactRod, DesignsHaveTheValuesOfAComputationWithThirtyDigits) {
  for (const Case& expected : cases()) {
    const Umbrella umbrella = make_umbrella(options_of(antennas()[expected.antenna]));
    const RodSolution found = design_exact(umbrella, with(expected.form));
    ASSERT_TRUE(found.summary.converged()) << found.summary.reason;
    EXPECT_LE(found.summary.iterations(), 5);
    EXPECT_LT(largest_difference(found.shape.reaction, expected.reaction), 1e-8);
    EXPECT_LT(largest_difference(found.shape.angle, expected.angle), 1e-10);
    EXPECT_LT(largest_difference(found.shape.x, expected.x), 1e-10);
    EXPECT_LT(largest_difference(found.shape.y, expected.y), 1e-10);
    EXPECT_LT(largest_difference(found.shape.moment, expected.moment), 1e-8);
    EXPECT_LT(largest_difference(found.shape.rod.lengths, expected.length), 1e-10);
  }
}

TEST(ExactRod, DesignHasTheStiffnessesRecomputed) {
  const Umbrella umbrella = make_umbrella(options_of(antennas()[0]));
  const RodSolution found = design_exact(umbrella, {});
  EXPECT_LT(largest_difference(make_report(umbrella, found.shape).stiffness,
                               {252.9066, 177.3499, 33.9084, 110.3097}),
            5.1e-5);
}

class ExactDesign : public testing::TestWithParam<Antenna> {
 protected:
  const Umbrella umbrella_ = make_umbrella(options_of(GetParam()));
};
INSTANTIATE_TEST_SUITE_P(Paper, ExactDesign, testing::ValuesIn(antennas()));

TEST_P(ExactDesign, MeetsTheConditionsOfItsForm) {
  const RodSolution a = design_exact(umbrella_, with(ExactForm::nodes_on_surface));
  const RodSolution b = design_exact(umbrella_, with(ExactForm::nodes_on_target));
  ASSERT_TRUE(a.summary.converged()) << a.summary.reason;
  ASSERT_TRUE(b.summary.converged()) << b.summary.reason;
  EXPECT_LT(make_report(umbrella_, a.shape).node_error.cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(a.shape.rod.lengths, umbrella_.rod.lengths);
  const RodReport on_target = make_report(umbrella_, b.shape);
  EXPECT_LT(on_target.miss_x.cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT(on_target.miss_y.cwiseAbs().maxCoeff(), 1e-12);
  for (const RodSolution* design : {&a, &b}) {
    EXPECT_EQ(design->stability.unstable, 0);
    EXPECT_LT(std::abs(design->shape.moment[umbrella_.rod.links()]), 1e-9);
  }
}

// First integrals of EI theta'' = -N sin theta along a link: EI theta'^2/2 - N cos theta, and M + N Y.
TEST_P(ExactDesign, KeepsTheFirstIntegralsAlongEachLink) {
  const RodShape shape = design_exact(umbrella_, {}).shape;
  const VecX n = shape.axial_force();
  for (int k = 0; k < shape.rod.links(); ++k) {
    const double ei = shape.rod.bending_stiffness[k];
    const auto energy = [&](const RodPoint& p) {
      return p.moment * p.moment / (2 * ei) - n[k] * std::cos(p.angle);
    };
    const auto force = [&](const RodPoint& p) { return p.moment + n[k] * p.y; };
    const RodPoint& first = shape.curve[k * intervals_per_link];
    for (int i = 1; i <= intervals_per_link; ++i) {
      const RodPoint& point = shape.curve[k * intervals_per_link + i];
      EXPECT_NEAR(energy(point), energy(first), 1e-12 * n[0]);
      EXPECT_NEAR(force(point), force(first), 1e-12 * shape.moment[0]);
    }
  }
}

// Moments of the cut-off part, from the coordinates, against those integrated along the rod.
TEST_P(ExactDesign, MomentsAreThoseOfTheForcesBeyond) {
  const RodShape shape = design_exact(umbrella_, {}).shape;
  for (int k = 0; k < shape.rod.links(); ++k) {
    const double y = k == 0 ? shape.rod.root.y : shape.y[k - 1];
    double moment = 0;
    for (int i = k; i < shape.rod.links(); ++i) moment += shape.reaction[i] * (shape.y[i] - y);
    EXPECT_NEAR(shape.moment[k], moment, 1e-11 * shape.moment[0]);
  }
}

TEST_P(ExactDesign, TurnedToTheStopHasTheShapeDesigned) {
  for (const ExactForm form : {ExactForm::nodes_on_surface, ExactForm::nodes_on_target}) {
    const RodSolution design = design_exact(umbrella_, with(form));
    const VecX stiffness = make_report(umbrella_, design.shape).stiffness;
    const RodSolution turned = turn_exact(umbrella_, design.shape.rod.lengths, stiffness, with(form));
    ASSERT_TRUE(turned.summary.converged()) << turned.summary.reason;
    EXPECT_LT((turned.shape.x - design.shape.x).norm(), 1e-10);
    EXPECT_LT((turned.shape.y - design.shape.y).norm(), 1e-10);
    EXPECT_LT((turned.shape.reaction - design.shape.reaction).norm(), 1e-9 * design.shape.reaction.norm());
    EXPECT_NEAR(turned.stability.least, design.stability.least, 1e-9);
  }
}

// Two discretisations of the second variation, hat functions of the angle and cubics of the deflection, agree
// as well as their shapes do; most of the stability comes from the cables, which pull back a node that moves
// out.
TEST_P(ExactDesign, IsAsStableAsThatOfCantilevers) {
  const RodSolution exact = design_exact(umbrella_, {});
  const RodSolution cantilevers = design_cantilevers(umbrella_, {});
  EXPECT_NEAR(exact.stability.least, cantilevers.stability.least, 0.04);
  EXPECT_LT(judge_stability(exact.shape, VecX::Zero(GetParam().links)).least, exact.stability.least - 0.4);
}

// Recomputed: an exact design leaves 1.2 to 5.9 mm rms between the nodes.
TEST_P(ExactDesign, LeavesMillimetresBetweenTheNodes) {
  const double rms = make_report(umbrella_, design_exact(umbrella_, {}).shape).along.rms;
  EXPECT_GT(rms, 1.15e-3);
  EXPECT_LT(rms, 5.95e-3);
}

// A different model for the antennas that were not recomputed elsewhere: consistent cantilevers, eight and
// sixteen in each link, under the reactions found. Their error falls towards zero with the third power of
// their length.
TEST(ExactRod, IsTheLimitOfManyCantilevers) {
  for (const int antenna : {1, 2, 3, 5}) {
    const RodShape exact = design_exact(make_umbrella(options_of(antennas()[antenna])), {}).shape;
    const int m = exact.rod.links();
    const auto error = [&](int parts) {
      const int n = m * parts;
      Rod rod{VecX::Constant(n, 12.0 / n), VecX(n), exact.rod.root};
      VecX reactions = VecX::Zero(n), start(n);
      for (int i = 0; i < n; ++i) {
        rod.bending_stiffness[i] = exact.rod.bending_stiffness[i / parts];
        start[i] = exact.curve[(i + 1) * intervals_per_link / parts].angle;
        if ((i + 1) % parts == 0) reactions[i] = exact.reaction[i / parts];
      }
      const RodSolution found = load_cantilevers(rod, reactions, start, {});
      return std::hypot(found.shape.x[n - 1] - exact.x[m - 1], found.shape.y[n - 1] - exact.y[m - 1]);
    };
    const double coarse = error(8), fine = error(16);
    EXPECT_LT(fine, 5e-4);
    EXPECT_NEAR(std::log2(coarse / fine), 3, 0.1);
  }
}

TEST(ExactRod, BendsUnequalLinksToATable) {
  UmbrellaOptions options = options_of(antennas()[1]);
  options.lengths = {3, 2.8, 3.1, 2.7};
  options.cable.law = CableLaw::bilinear;
  options.cable.knee_strain = 0.5;
  options.cable.second_slope = 0.3;
  options.meridian.kind = MeridianKind::table;
  for (double x = 0; x <= 10; x += 0.5) {
    options.meridian.x.push_back(x);
    options.meridian.y.push_back(std::cosh(x / 8) * 8 - 8);
  }
  const Umbrella umbrella = make_umbrella(options);
  const RodSolution design = design_exact(umbrella, {});
  ASSERT_TRUE(design.summary.converged()) << design.summary.reason;
  const RodReport report = make_report(umbrella, design.shape);
  EXPECT_LT(report.node_error.cwiseAbs().maxCoeff(), 1e-12);
  const RodSolution turned = turn_exact(umbrella, umbrella.rod.lengths, report.stiffness, {});
  ASSERT_TRUE(turned.summary.converged()) << turned.summary.reason;
  EXPECT_LT((turned.shape.x - design.shape.x).norm(), 1e-9);
}

TEST(ExactRod, DesignsTwelveLinks) {
  UmbrellaOptions options = options_of(antennas()[5]);
  options.links = 12;
  options.lengths = {1};
  options.bending_stiffness = {3000};
  for (const ExactForm form : {ExactForm::nodes_on_surface, ExactForm::nodes_on_target}) {
    const RodSolution design = design_exact(make_umbrella(options), with(form));
    EXPECT_TRUE(design.summary.converged()) << design.summary.reason;
  }
}

// A node that must be pushed has no cable to turn with.
TEST(ExactRod, DoesNotTurnWithoutCables) {
  const Umbrella umbrella = make_umbrella(options_of(antennas()[0]));
  VecX stiffness = VecX::Constant(4, 100.0);
  stiffness[2] = std::numeric_limits<double>::quiet_NaN();
  const SolveSummary exact = turn_exact(umbrella, umbrella.rod.lengths, stiffness, {}).summary;
  const SolveSummary cantilevers = turn_cantilevers(umbrella, stiffness, {}).summary;
  for (const SolveSummary& summary : {exact, cantilevers}) {
    EXPECT_EQ(summary.status, SolveStatus::impossible);
    EXPECT_EQ(summary.reason, "cable 3 has no stiffness: no cable gives its node the reaction it needs");
  }
}

TEST(ExactRod, ReportsWhereTurningEnded) {
  const Umbrella umbrella = make_umbrella(options_of(antennas()[0]));
  ExactOptions options;
  options.max_iterations = 1;
  options.min_step = 0.01;
  const RodSolution turned = turn_exact(umbrella, umbrella.rod.lengths, VecX::Constant(4, 100.0), options);
  EXPECT_EQ(turned.summary.status, SolveStatus::too_many_iterations);
  EXPECT_NE(turned.summary.reason.find("the root turned to 0 of its way"), std::string::npos)
      << turned.summary.reason;
}

}  // namespace
}  // namespace tautline::rod
