#include <cmath>
#include <numbers>
#include <tautline/model/section.hpp>

#include "model/models.hpp"

namespace tautline::model {
namespace {

using namespace testing_models;
using std::numbers::pi;

constexpr double young = 2e11, poisson = 0.3, density = 7850, shear_modulus = young / 2.6;

element::BeamSection beam_of(const SectionOptions& options) {
  Group group;
  set_section(group, options, {{"steel", {young, poisson, density}}});
  EXPECT_EQ(group.kind, ElementKind::beam);
  return group.beam;
}

/// Saint-Venant's series for a rectangle of sides a >= b (Timoshenko and Goodier, Theory of Elasticity, art.
/// 109).
double torsion_constant(double a, double b) {
  double sum = 0;
  for (int n = 1; n < 60; n += 2) sum += std::tanh(n * pi * a / (2 * b)) / std::pow(n, 5);
  return a * std::pow(b, 3) * (1.0 / 3 - 64 * b / (std::pow(pi, 5) * a) * sum);
}

TEST(TorsionSeries, GivesTheTabulatedFactors) {
  // Timoshenko and Goodier, art. 109: factor k1 of a b^3.
  EXPECT_NEAR(torsion_constant(1, 1), 0.1406, 5e-5);
  EXPECT_NEAR(torsion_constant(2, 1) / 2, 0.229, 5e-4);
  EXPECT_NEAR(torsion_constant(10, 1) / 10, 0.312, 1e-3);
}

TEST(RectangleSection, HasTheTorsionConstantOfTheExactSeries) {
  for (const auto& [width, height] : {std::pair{0.1, 0.1}, {0.2, 0.1}, {0.1, 0.2}, {0.15, 0.1}, {0.1, 1.0}}) {
    const double exact = torsion_constant(std::max(width, height), std::min(width, height));
    EXPECT_NEAR(beam_of(RectangleSectionOptions{"steel", width, height}).torsion_stiffness / shear_modulus,
                exact,
                5e-3 * exact)  // the error Roark states for the approximation
        << width << " x " << height;
  }
}

TEST(RectangleSection, BendsAboutAxisTwoWithTheCubeOfItsHeight) {
  const auto s = beam_of(RectangleSectionOptions{"steel", 0.1, 0.2});
  EXPECT_NEAR(s.axial_stiffness, young * 0.02, 1);
  EXPECT_NEAR(s.bending_stiffness_2, young * 0.1 * 0.008 / 12, 1e-6);
  EXPECT_NEAR(s.bending_stiffness_3, young * 0.2 * 0.001 / 12, 1e-6);
  EXPECT_NEAR(s.shear_stiffness_2, 5.0 / 6 * shear_modulus * 0.02, 1e-4);
  EXPECT_NEAR(s.shear_stiffness_3, 5.0 / 6 * shear_modulus * 0.02, 1e-4);
  EXPECT_NEAR(s.mass_per_length, density * 0.02, 1e-10);
  EXPECT_NEAR(s.rotary_inertia_2, density * 0.1 * 0.008 / 12, 1e-14);
  EXPECT_NEAR(s.rotary_inertia_3, density * 0.2 * 0.001 / 12, 1e-14);
}

TEST(RoundSection, HasTheClosedFormsOfTheCircle) {
  const auto s = beam_of(RoundSectionOptions{"steel", 0.1});
  EXPECT_NEAR(s.axial_stiffness, young * pi * 0.0025, 1e-5);
  EXPECT_NEAR(s.bending_stiffness_2, young * pi * std::pow(0.05, 4) / 4, 1e-6);
  EXPECT_EQ(s.bending_stiffness_2, s.bending_stiffness_3);
  EXPECT_NEAR(s.torsion_stiffness, shear_modulus * pi * std::pow(0.05, 4) / 2, 1e-6);
  // Cowper (1966): 6 (1 + nu) / (7 + 6 nu) = 7.8 / 8.8
  EXPECT_NEAR(s.shear_stiffness_2, 7.8 / 8.8 * shear_modulus * pi * 0.0025, 1e-4);
}

TEST(TubeSection, HasTheClosedFormsOfTheRing) {
  const double d = 0.1, t = 0.01;
  const auto s = beam_of(TubeSectionOptions{"steel", d, t});
  EXPECT_NEAR(s.axial_stiffness, young * pi * d * t, 1e-4);
  const double inertia = pi * d * t * (d * d + t * t) / 8;
  EXPECT_NEAR(s.bending_stiffness_2, young * inertia, 1e-6);
  EXPECT_NEAR(s.bending_stiffness_3, young * inertia, 1e-6);
  EXPECT_NEAR(s.torsion_stiffness, shear_modulus * 2 * inertia, 1e-6);
  EXPECT_NEAR(s.mass_per_length, density * pi * d * t, 1e-10);
}

TEST(TubeSection, HasCowpersShearFactorsBetweenTheThinRingAndTheSolidBar) {
  const auto factor = [](double thickness) {
    const auto s = beam_of(TubeSectionOptions{"steel", 0.1, thickness});
    return s.shear_stiffness_2 / (shear_modulus * pi * 0.1 * thickness);
  };
  EXPECT_NEAR(factor(1e-6), 2.6 / 4.9, 1e-9);  // Cowper (1966), thin ring: 2 (1 + nu) / (4 + 3 nu)
  EXPECT_NEAR(factor(0.1), 7.8 / 8.8, 1e-12);  // no hole left
}

TEST(SquareTubeSection, HasTheClosedFormsOfThinWalls) {
  const double a = 0.1, t = 0.004, outer = a + t, inner = a - t;
  const auto s = beam_of(SquareTubeSectionOptions{"steel", a, t});
  EXPECT_NEAR(s.axial_stiffness, young * (outer * outer - inner * inner), 1e-3);
  const double inertia = (std::pow(outer, 4) - std::pow(inner, 4)) / 12;
  EXPECT_NEAR(s.bending_stiffness_2, young * inertia, 1e-6);
  EXPECT_NEAR(s.bending_stiffness_3, young * inertia, 1e-6);
  // Bredt: 4 A^2 / (perimeter/t) with the area A = a^2 inside the middle line
  EXPECT_NEAR(s.torsion_stiffness, shear_modulus * 4 * std::pow(a, 4) * t / (4 * a), 1e-6);
  // Cowper (1966), thin-walled square tube: 20 (1 + nu) / (48 + 39 nu)
  EXPECT_NEAR(s.shear_stiffness_2, 26.0 / 59.7 * shear_modulus * 4 * a * t, 1e-3);
  EXPECT_NEAR(s.mass_per_length, density * 4 * a * t, 1e-10);
}

TEST(BeamSection, WithoutShearFlexibilityIsRigidInShear) {
  EXPECT_EQ(beam_of(RectangleSectionOptions{"steel", 0.1, 0.2, false}).shear_stiffness_2, 0);
  EXPECT_EQ(beam_of(RoundSectionOptions{"steel", 0.1, false}).shear_stiffness_3, 0);
  EXPECT_EQ(beam_of(TubeSectionOptions{"steel", 0.1, 0.01, false}).shear_stiffness_2, 0);
}

TEST(GeneralSection, IsTakenAsGiven) {
  const auto s = beam_of(GeneralBeamSectionOptions{1, 2, 3, 4, 5, 6, 7, 8, 9});
  EXPECT_EQ(s.axial_stiffness, 1);
  EXPECT_EQ(s.bending_stiffness_2, 2);
  EXPECT_EQ(s.bending_stiffness_3, 3);
  EXPECT_EQ(s.torsion_stiffness, 4);
  EXPECT_EQ(s.shear_stiffness_2, 5);
  EXPECT_EQ(s.shear_stiffness_3, 6);
  EXPECT_EQ(s.mass_per_length, 7);
  EXPECT_EQ(s.rotary_inertia_2, 8);
  EXPECT_EQ(s.rotary_inertia_3, 9);
}

CableSection cable_of(const CableSectionOptions& options) {
  Group group;
  set_section(group, options, {{"steel", {young, poisson, density}}});
  EXPECT_EQ(group.kind, ElementKind::cable);
  return group.cable;
}

TEST(CableSection, FollowsFromDiameterOrAreaOrIsGiven) {
  CableSectionOptions options;
  options.material = "steel";
  options.diameter = 0.02;
  EXPECT_NEAR(cable_of(options).axial_stiffness, young * pi * 1e-4, 1e-6);
  EXPECT_NEAR(cable_of(options).mass_per_length, density * pi * 1e-4, 1e-12);
  options.diameter.reset();
  options.area = 3e-4;
  EXPECT_NEAR(cable_of(options).axial_stiffness, young * 3e-4, 1e-6);
  options.mass_per_length = 9;
  EXPECT_EQ(cable_of(options).mass_per_length, 9);
  CableSectionOptions given;
  given.axial_stiffness = 5e5;
  EXPECT_EQ(cable_of(given).axial_stiffness, 5e5);
  EXPECT_EQ(cable_of(given).mass_per_length, 0);
}

TEST(MembraneSection, FollowsFromThicknessOrIsGiven) {
  Group group;
  MembraneSectionOptions options;
  options.material = "steel";
  options.thickness = 1e-3;
  set_section(group, options, {{"steel", {young, poisson, density}}});
  EXPECT_EQ(group.kind, ElementKind::membrane);
  EXPECT_NEAR(group.membrane.tension_stiffness, 2e8, 1e-6);
  EXPECT_EQ(group.membrane.poisson_ratio, poisson);
  EXPECT_NEAR(group.membrane.mass_per_area, 7.85, 1e-14);
  MembraneSectionOptions given;
  given.tension_stiffness = 6e5;
  given.poisson_ratio = 0.4;
  set_section(group, given, {});
  EXPECT_EQ(group.membrane.tension_stiffness, 6e5);
  EXPECT_EQ(group.membrane.poisson_ratio, 0.4);
  EXPECT_EQ(group.membrane.mass_per_area, 0) << "nothing is left of the section before";
}

/// Unstressed length of a cable of 2 m and E A = 1e6 N after `options`.
double unstressed(const GroupOptions& options) {
  Model model;
  model.nodes = {{0, 0, 0}, {0, 2, 0}};
  add_cable(model, add_cable_group(model, "cord", 1e6), 0, 1, 0.5);
  set_initial_state(model, 0, options);
  return model.unstressed_length(model.cables[0]);
}

TEST(InitialState, OfACableFollowsFromAnyOfItsFourStatements) {
  GroupOptions options;
  EXPECT_DOUBLE_EQ(unstressed(options), 2 / 1.5) << "stated by nobody: as it was";
  options.tension = 5e3;
  EXPECT_DOUBLE_EQ(unstressed(options), 2 / 1.005);
  options = {};
  options.force_density = 5e3;  // tension 1e4
  EXPECT_DOUBLE_EQ(unstressed(options), 2 / 1.01);
  options = {};
  options.prestrain = -0.2;
  EXPECT_DOUBLE_EQ(unstressed(options), 2 / 0.8);
  options = {};
  options.unstressed_length = 1.75;
  EXPECT_DOUBLE_EQ(unstressed(options), 1.75);
}

TEST(InitialState, OfOneGroupLeavesTheOthersAlone) {
  auto model = two_facets();
  GroupOptions options;
  options.tension = 2e3;
  set_initial_state(model, model.find_group("tie"), options);
  EXPECT_EQ(model.cables[0].initial_strain, 1e-3);
  EXPECT_DOUBLE_EQ(model.cables[1].initial_strain, 2e3 / 1e6);
}

TEST(InitialState, OfAMembraneIsThePrestressInEveryDirection) {
  auto model = two_facets();
  GroupOptions options;
  options.prestress = {250, 250};
  set_initial_state(model, model.find_group("cloth"), options);
  for (const auto& membrane : model.membranes) EXPECT_EQ(membrane.prestress, Vec3(250, 250, 0));
}

}  // namespace
}  // namespace tautline::model
