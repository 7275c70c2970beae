// The rule of collapse on random columns and trusses, askew in space, after dead load, heat and motions,
// beside closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tautline/core/types.hpp>
#include <tautline/deck/deck.hpp>
#include <tautline/output/results.hpp>
#include <tautline/steps/run.hpp>

#include "output/temporary_directory.hpp"

namespace tautline::steps {
namespace {

using Json = nlohmann::ordered_json;
using output::test::put;
using output::test::TemporaryDirectory;

constexpr double pi = std::numbers::pi;

/// The same numbers on every machine.
class Chance {
 public:
  explicit Chance(unsigned seed) : engine_(seed) {}
  double between(double low, double high) { return low + (high - low) * engine_() / 4294967296.0; }
  int below(int n) { return static_cast<int>(between(0, n)); }
  double decade(double low, double high) { return std::pow(10.0, between(low, high)); }
  Vec3 vector(double size) { return Vec3(between(-size, size), between(-size, size), between(-size, size)); }
  Mat3 axes() {
    return Eigen::Quaterniond(between(-1, 1), between(-1, 1), between(-1, 1), between(-1, 1))
        .normalized()
        .toRotationMatrix();
  }

 private:
  std::mt19937 engine_;
};

std::string text(const Vec3& v) {
  return fmt::format("[{:.16g}, {:.16g}, {:.16g}]", v.x(), v.y(), v.z());
}

/// A deck, the exact critical load factor, and how far the program's structure is from the exact one.
struct Problem {
  std::string name, deck;
  double exact = 0, tolerance = 0;
  bool disturbed = false;
};

/// What acted before the step: nothing, half of the load, heat, a motion of the whole, all of it.
enum History { none, dead, heat, motion, all, n_histories };

/// A column of the end conditions 0 to 3, slender enough for its shortening to be told.
Problem column(Chance& chance, int ends, History before, int disturbance) {
  const char* const foot[] = {"[x, y, z, rx]", "all", "all", "all"};
  const char* const head[] = {"[y, z]", "", "[y, z, rx, ry, rz]", "[y, z]"};
  const double effective[] = {1, 2, 0.5, 0.699156}, k = effective[ends];
  const Mat3 axes = chance.axes();
  const Vec3 e = axes.col(0), n = axes.col(1), p = chance.vector(5), go = chance.vector(1);
  const double length = chance.decade(-1, 1.5), bending = chance.decade(0, 5),
               slenderness = chance.between(60, 300), unit = chance.decade(-2, 2),
               part = before == dead || before == all ? chance.between(0, 0.6) : 0;
  const double euler = pi * pi * bending / std::pow(k * length, 2);
  const bool has_head = ends != 1;
  const std::string watched = has_head ? "m" : "h";
  std::string acting;
  if (before == dead || before == all) acting += "dead, ";
  if (before == heat || before == all) acting += "heat, ";
  if (before == motion || before == all) acting += has_head ? "go, go_head" : "go";
  std::string deck =
      fmt::format("model:\n  nodes: {{p: {}, m: {}, h: {}}}\n  elements: {{c: [[p, m], [m, h]]}}\n", text(p),
                  text(p + length / 2 * e), text(p + length * e));
  deck += fmt::format(
      "sections: {{c: {{kind: beam, axial_stiffness: {:.12g}, bending_stiffness_2: {:.12g}, "
      "bending_stiffness_3: {:.12g}, "
      "torsion_stiffness: {:.12g}, mass_per_length: 1, thermal_expansion: 1.0e-5}}}}\n",
      bending * std::pow(slenderness / length, 2), bending, 2.2 * bending, bending);
  deck += fmt::format(
      "groups: {{c: {{section: c, orientation: {}}}, p: {{nodes: [p]}}, m: {{nodes: [m]}}, h: {{nodes: "
      "[h]}}}}\n",
      text(n));
  deck += fmt::format("supports:\n  - {{name: p, on: [p], fix: {}, x_axis: {}, y_axis: {}}}\n", foot[ends],
                      text(e), text(n));
  if (has_head)
    deck += fmt::format("  - {{name: h, on: [h], fix: {}, x_axis: {}, y_axis: {}}}\n", head[ends], text(e),
                        text(n));
  deck +=
      fmt::format("loads:\n  - {{name: grow, on: [h], force: {}}}\n  - {{name: dead, on: [h], force: {}}}\n",
                  text(-euler * unit * e), text(-euler * part * e));
  deck += fmt::format("  - {{name: heat, on: [c], temperature_change: {:.6g}}}\n", chance.between(-60, 60));
  deck += fmt::format("  - {{name: lateral, on: [{}], force: {}}}\n", watched, text(1e-4 * euler * n));
  deck += fmt::format("  - {{name: go, on: [p], displacement: {}}}\n", text(length * go));
  if (has_head)
    deck += fmt::format("  - {{name: go_head, on: [h], displacement: {}}}\n",
                        text(length * (go - go.dot(e) * e)));
  deck += fmt::format("steps:\n  - {{kind: mesh, subdivisions: 6}}\n  - {{kind: equilibrium, loads: [{}]}}\n",
                      acting);
  deck +=
      fmt::format("  - {{kind: collapse, loads: [grow], monitor: [{}]{}{}}}\n", watched,
                  disturbance & 1 ? fmt::format(", imperfection: {{amplitude: {:.6g}}}", 1e-3 * length) : "",
                  disturbance & 2 ? ", disturbance: [lateral]" : "");
  // Shortening and thermal strain change the length, and Euler's load by twice as much; 12 elements, 2e-4.
  const double strain = std::pow(pi / k / slenderness, 2) + 6e-4;
  return {fmt::format("column {} history {} disturbance {}", ends, static_cast<int>(before), disturbance),
          deck, (1 - part) / unit, 2 * strain + 2e-4, disturbance != 0};
}

/// A shallow truss of two bars, l^3 = l0 L^2 at its limit (see verification/path_two_bar_truss).
Problem truss(Chance& chance, History before) {
  const Mat3 axes = chance.axes();
  const Vec3 e = axes.col(0), y = axes.col(1), up = axes.col(2), middle = chance.vector(5),
             go = chance.vector(1);
  const double span = chance.decade(-1, 1), rise = span * chance.between(0.05, 0.25),
               stiffness = chance.decade(4, 7), unit = chance.decade(-2, 2),
               part = before == dead ? chance.between(0, 0.5) : 0;
  const double l0 = std::hypot(span, rise), l = std::cbrt(l0 * span * span),
               z = std::sqrt(l * l - span * span);
  const double limit = 2 * stiffness * (l0 - l) * z / (l0 * l), exact = (1 - part) / unit;
  std::string deck =
      fmt::format("model:\n  nodes: {{a: {}, b: {}, t: {}}}\n  elements: {{c: [[a, t], [t, b]]}}\n",
                  text(middle - span * e), text(middle + span * e), text(middle + rise * up));
  deck += fmt::format("sections: {{c: {{kind: bar, axial_stiffness: {:.12g}, mass_per_length: 1}}}}\n",
                      stiffness);
  deck += "groups: {c: {section: c}, f: {nodes: [a, b]}, t: {nodes: [t]}}\n";
  deck += fmt::format(
      "supports:\n  - {{name: f, on: [f], fix: pinned}}\n  - {{name: t, on: [t], fix: [y], x_axis: {}, "
      "y_axis: {}}}\n",
      text(e), text(y));
  deck +=
      fmt::format("loads:\n  - {{name: grow, on: [t], force: {}}}\n  - {{name: dead, on: [t], force: {}}}\n",
                  text(-limit * unit * up), text(-limit * part * up));
  deck += fmt::format(
      "  - {{name: go, on: [f], displacement: {}}}\n  - {{name: go_top, on: [t], displacement: {}}}\n",
      text(span * go), text(span * go.dot(y) * y));
  deck += fmt::format("steps:\n  - {{kind: equilibrium, loads: [{}]}}\n", before == dead     ? "dead"
                                                                          : before == motion ? "go, go_top"
                                                                                             : "");
  deck += fmt::format("  - {{kind: collapse, loads: [grow], monitor: [t], linear_factor: {:.12g}}}\n",
                      exact * chance.between(0.95, 1.6));
  return {fmt::format("truss history {}", static_cast<int>(before)), deck, exact, 1e-6, false};
}

Json collapse_of(const Problem& problem) {
  const TemporaryDirectory here("collapse");
  put(here.file("deck.yaml"), "title: " + problem.name + "\n" + problem.deck +
                                  "output: {report: false, fields: false, tables: false}\n");
  Progress silent;
  EXPECT_EQ(run(deck::read_deck(here.file("deck.yaml")), {here.file("out"), false, ""}, silent),
            ExitCode::done);
  return output::read_results(here.file("out") + "/results.json")["steps"].back();
}

/// A bow a / (1 - p) grows 1.5 times in a step of 0.05 where p passes 0.90: the rule ends at most three steps
/// below the critical load. Where nothing disturbs, only the critical load itself ends it, in its step.
void check(const Problem& problem) {
  SCOPED_TRACE(problem.name + "\n" + problem.deck);
  const Json step = collapse_of(problem);
  const double rule = step["critical_lambda"], width = 0.05 * step["linear_lambda"].get<double>();
  const char* key = step.contains("limit_lambda") ? "limit_lambda" : "bifurcation_lambda";
  ASSERT_TRUE(step.contains(key));
  EXPECT_NEAR(step[key].get<double>() / problem.exact, 1, problem.tolerance);
  EXPECT_LE(rule, step[key].get<double>() * (1 + 1e-9));
  EXPECT_LE(rule, problem.exact * (1 + problem.tolerance));
  EXPECT_GE(rule, problem.exact * (1 - problem.tolerance) - (problem.disturbed ? 3.05 : 1) * width);
}

TEST(CollapseRule, LiesBelowEulersLoadOfRandomColumnsWhateverActedBefore) {
  Chance chance(20261130);
  for (int i = 0; i < 12; ++i)
    check(column(chance, i % 4, static_cast<History>(i % n_histories), chance.below(4)));
}

TEST(CollapseRule, LiesBelowTheLimitOfRandomTrusses) {
  Chance chance(7);
  for (const auto before : {none, dead, motion}) check(truss(chance, before));
}

}  // namespace
}  // namespace tautline::steps
