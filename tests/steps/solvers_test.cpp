// Whoever finds the end of a stage, it is the same stage: what is prescribed, what acts, what is reported.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <tautline/deck/deck.hpp>
#include <tautline/output/results.hpp>
#include <tautline/steps/run.hpp>

#include "output/temporary_directory.hpp"

namespace tautline::steps {
namespace {

using Json = nlohmann::ordered_json;
using output::test::contents;
using output::test::put;
using output::test::TemporaryDirectory;

/// A structure, and the last stage of its last step, which is followed in several ways.
struct Stage {
  std::string name, deck;
  int step;  ///< number of the step that is followed in several ways
};

const std::string net = R"(
model:
  nodes: {a: [0, 0, 0], m: [1, 0, 0], b: [2, 0, 0], c: [1, 1, 0.4], d: [1, -1, 0.4]}
  elements: {line: [[a, m], [m, b]], cross: [[c, m], [m, d]]}
sections: {rope: {kind: cable, axial_stiffness: 1.0e5, mass_per_length: 0.1, thermal_expansion: 1.0e-5}}
groups: {line: {section: rope, tension: 200}, cross: {section: rope, tension: 300}, m: {nodes: [m]}, b: {nodes: [b]},
  ends: {nodes: [a, b, c, d]}}
supports: [{name: ends, on: [ends], fix: pinned}]
loads:
  - {name: move, on: [b], displacement: [0.02, 0, 0.3]}
  - {name: pull, on: [m], force: [20, 0, -100]}
  - {name: heat, on: [line], temperature_change: -150}
  - {name: gravity, acceleration: [0, 0, -9.81]}
output: {report: false, fields: false}
)";

const std::string frame = R"(
model:
  nodes: {a: [0, 0, 0], b: [1, 0.5, 0.2], c: [2, 0, 1], prop: [1, 0.5, -1]}
  elements: {rod: [[a, b], [b, c]], prop: [[b, prop]]}
sections:
  bar: {kind: beam, axial_stiffness: 1.0e5, bending_stiffness_2: 100, bending_stiffness_3: 150, torsion_stiffness: 80,
    mass_per_length: 1}
groups: {rod: {section: bar, orientation: [0, 0, 1]}, prop: {section: bar, orientation: [1, 0, 0]}, a: {nodes: [a]},
  b: {nodes: [b]}, c: {nodes: [c]}, foot: {nodes: [prop]}}
supports: [{name: a, on: [a], fix: all}, {name: c, on: [c], fix: pinned}, {name: foot, on: [foot], fix: [x, y, z, rx, ry, rz]}]
loads:
  - {name: push, on: [b], force: [3, 10, -20]}
  - {name: turn, on: [a], rotation: [0, 0.2, 0.1]}
  - {name: shift, on: [c], displacement: [0.05, -0.02, 0]}
output: {report: false, fields: false}
)";

const std::string tent = R"(
model:
  nodes: {a: [0, 0, 0], b: [2, 0, 0.3], c: [2, 2, 0], d: [0, 2, 0.3], m: [1, 1, 0.3]}
  elements: {cloth: [[a, b, m], [b, c, m], [c, d, m], [d, a, m]]}
sections: {cloth: {kind: membrane, tension_stiffness: 5.0e4, poisson_ratio: 0.3, mass_per_area: 1}}
groups: {cloth: {section: cloth, prestress: [500, 500]}, m: {nodes: [m]}, corners: {nodes: [a, b, c, d]}, c: {nodes: [c]}}
supports: [{name: corners, on: [corners], fix: pinned}]
loads:
  - {name: wind, on: [cloth], pressure: 150}
  - {name: move, on: [c], displacement: [0.05, 0.05, 0.1]}
output: {report: false, fields: false}
)";

void PrintTo(const Stage& stage, std::ostream* out) {
  *out << stage.name;
}

std::vector<Stage> stages() {
  return {
      {"force", net + "steps: [{kind: equilibrium, loads: [pull], monitor: [m, b]}]\n", 0},
      {"motion", net + "steps: [{kind: equilibrium, loads: [move], monitor: [m, b]}]\n", 0},
      {"motion_and_force", net + "steps: [{kind: equilibrium, loads: [move, pull], monitor: [m, b]}]\n", 0},
      {"heat_and_weight", net + "steps: [{kind: equilibrium, loads: [heat, gravity], monitor: [m, b]}]\n", 0},
      {"motion_taken_over",
       net + "steps: [{kind: equilibrium, loads: [move]}, "
             "{kind: equilibrium, loads: [move, pull, heat], monitor: [m, b]}]\n",
       1},
      {"turned_support", frame + "steps: [{kind: equilibrium, loads: [turn, push], monitor: [b, c]}]\n", 0},
      {"motions_alone", frame + "steps: [{kind: equilibrium, loads: [turn, shift], monitor: [b, c]}]\n", 0},
      {"release",
       frame + "steps: [{kind: equilibrium, stages: [{name: propped, hold: [prop]}, {name: free}], "
               "loads: [push, shift], monitor: [b, c]}]\n",
       0},
      {"wind_on_a_moved_tent", tent + "steps: [{kind: equilibrium, loads: [wind, move], monitor: [m, c]}]\n",
       0},
  };
}

struct Outcome {
  Json step;
  std::string nodes;  ///< nodes.csv
};

/// @param keys  more of them for the step that is followed in several ways
Outcome run_deck(const Stage& stage, const std::string& keys, const std::vector<std::string>& changes) {
  const TemporaryDirectory here("solvers_" + stage.name);
  std::string deck = stage.deck;
  deck.insert(deck.rfind("monitor:"), keys);
  put(here.file("deck.yaml"), "title: " + stage.name + "\n" + deck);
  Progress silent;
  const auto code =
      run(deck::read_deck(here.file("deck.yaml"), changes), {here.file("out"), false, ""}, silent);
  EXPECT_EQ(code, ExitCode::done) << stage.name;
  const Json results = output::read_results(here.file("out") + "/results.json");
  return {results["steps"].back(), contents(here.file("out") + "/nodes.csv")};
}

/// Numbers of one tree against those of another. `size` of what is zero in one of them.
void expect_near(const Json& a, const Json& b, double tolerance, const std::string& where) {
  if (a.is_number()) {
    EXPECT_NEAR(a.get<double>(), b.get<double>(), tolerance * std::max(1.0, std::abs(b.get<double>())))
        << where;
    return;
  }
  ASSERT_EQ(a.size(), b.size()) << where;
  if (a.is_object())
    for (const auto& [key, value] : a.items()) {
      ASSERT_TRUE(b.contains(key)) << where << '/' << key;
      expect_near(value, b[key], tolerance, where + '/' + key);
    }
  if (a.is_array())
    for (std::size_t i = 0; i < a.size(); ++i)
      expect_near(a[i], b[i], tolerance, where + '/' + std::to_string(i));
}

std::vector<double> numbers_of(const std::string& table) {
  std::vector<double> numbers;
  std::string field;
  for (const char c : table + ",") {
    if (c != ',' && c != '\n') {
      field += c;
      continue;
    }
    char* end = nullptr;
    const double value = std::strtod(field.c_str(), &end);
    if (!field.empty() && *end == '\0') numbers.push_back(value);
    field.clear();
  }
  return numbers;
}

class EveryStage : public ::testing::TestWithParam<Stage> {};

/// Newton's method ends with residuals of 1e-9 of the forces, hence 1e-6 of what is of size one; forces are
/// some hundred newtons, to which the tolerance is relative.
TEST_P(EveryStage, EndsAlikeWhicheverSolverGotThere) {
  constexpr double tolerance = 1e-5;
  const Stage& stage = GetParam();
  const auto by_newton = run_deck(stage, "", {});
  struct Way {
    std::string name, keys;
    std::vector<std::string> changes;
  };
  std::vector<Way> ways{
      {"arc_length", "control: arc_length, ", {}},
      {"spherical", "control: arc_length, arc_length: {constraint: spherical}, ", {}},
  };
  for (const char* fallback : {"descent", "dynamic_relaxation"}) {
    std::vector<std::string> changes{"solver.max_iterations=1", "solver.min_step=0.9"};  // no room for Newton
    for (int k = 0; k <= stage.step; ++k)
      changes.push_back("steps." + std::to_string(k) + ".fallback=" + fallback);
    ways.push_back({fallback, "", changes});
  }
  for (const auto& way : ways) {
    SCOPED_TRACE(stage.name + " by " + way.name);
    const auto found = run_deck(stage, way.keys, way.changes);
    const Json &last = found.step["stages"].back(), &path = found.step["path"];
    EXPECT_EQ(last["lambda"], 1.0);
    EXPECT_EQ(last["status"], "done");
    if (!way.changes.empty()) {
      EXPECT_TRUE(last.contains(way.name)) << "the fallback was needed";
    }
    ASSERT_FALSE(path.empty());
    EXPECT_EQ(path.back()["lambda"], 1.0);
    expect_near(path.back()["monitors"], by_newton.step["path"].back()["monitors"], tolerance, "monitors");
    expect_near(found.step["reactions"], by_newton.step["reactions"], tolerance, "reactions");
    expect_near(path.back()["reactions"], by_newton.step["reactions"], tolerance, "reactions of the path");
    const auto a = numbers_of(found.nodes), b = numbers_of(by_newton.nodes);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "number " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Stages, EveryStage, ::testing::ValuesIn(stages()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace tautline::steps
