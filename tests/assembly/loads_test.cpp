#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>
#include <tautline/core/error.hpp>
#include <tautline/model/section.hpp>

#include "assembly/dense.hpp"
#include "assembly/load_audit.hpp"
#include "assembly/mixture.hpp"

namespace tautline::assembly {
namespace {

using namespace testing_models;

/// What the supports carry of a load, all nodes held, as force and as moment about the origin.
Resultant carried(const model::Model& model, const model::Load& load) {
  System with(model), without(model);
  with.begin_stage(held(model, {load}));
  with.set_lambda(1);
  without.begin_stage(held(model, {}));
  without.set_lambda(1);
  const auto a = with.reactions(), b = without.reactions();
  Resultant sum;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    sum.force -= a.force[i] - b.force[i];
    sum.moment -= a.moment[i] - b.moment[i] + model.nodes[i].cross(a.force[i] - b.force[i]);
  }
  return sum;
}

void expect_carried(const model::Model& model, const model::Load& load, const Vec3& force,
                    const Vec3& moment) {
  const auto found = carried(model, load);
  // stiff elements leave 1e-16 of E A in the reactions
  EXPECT_LT((found.force - force).norm(), 1e-11 * (force.norm() + 1e2)) << found.force.transpose();
  EXPECT_LT((found.moment - moment).norm(), 1e-11 * (moment.norm() + 1e3)) << found.moment.transpose();
}

/// By subdivision of the square into n x n cells: integral of f over a bilinear quadrilateral, dA as a
/// vector.
template <class F>
auto over_quadrilateral(const std::array<Vec3, 4>& x, const F& f) {
  constexpr int n = 400;
  decltype(f(x[0], x[0])) sum = decltype(sum)::Zero();
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double a = (i + 0.5) / n, b = (j + 0.5) / n;
      const Vec3 at = (1 - a) * (1 - b) * x[0] + a * (1 - b) * x[1] + a * b * x[2] + (1 - a) * b * x[3];
      const Vec3 u = (1 - b) * (x[1] - x[0]) + b * (x[2] - x[3]),
                 v = (1 - a) * (x[3] - x[0]) + a * (x[2] - x[1]);
      sum += f(at, u.cross(v) / (n * n));
    }
  return sum;
}

TEST(Loads, OfLinesArriveWithTheirForceAndMoment) {
  const auto model = mixture();
  for (const std::string name : {"rod", "rope", "bar", "edge"}) {
    auto load = on(name);
    load.line_force = {3, -2, 5};
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    const auto add = [&](int a, int b) {
      const Vec3 f = (model.nodes[a] - model.nodes[b]).norm() * load.line_force;
      force += f;
      moment += ((model.nodes[a] + model.nodes[b]) / 2).cross(f);
    };
    const auto selected = model.select(name);
    for (const int i : selected.cables) add(model.cables[i].nodes[0], model.cables[i].nodes[1]);
    for (const int i : selected.beams) add(model.beams[i].nodes[0], model.beams[i].nodes[1]);
    for (const auto& [a, b] : selected.edges) add(a, b);
    SCOPED_TRACE(name);
    expect_carried(model, load, force, moment);
  }
}

TEST(Loads, AlongACatenaryArriveInAll) {
  const auto model = mixture();
  auto load = on("line");
  load.line_force = {3, -2, 5};
  const double length = (model.nodes[7] - model.nodes[5]).norm();
  EXPECT_LT((carried(model, load).force - length * load.line_force).norm(), 1e-9);
}

TEST(Loads, OnDistortedAndWarpedFacetsArriveWithTheirForceAndMoment) {
  const auto model = mixture();
  const std::array<Vec3, 4> x{model.nodes[0], model.nodes[1], model.nodes[2], model.nodes[3]};
  const Vec3 area = (model.nodes[4] - model.nodes[1]).cross(model.nodes[2] - model.nodes[1]) / 2,
             centre = (model.nodes[1] + model.nodes[4] + model.nodes[2]) / 3;
  for (const std::string name : {"cloth", "shell"}) {
    SCOPED_TRACE(name);
    auto gas = on(name);
    gas.pressure = 40;
    // the sum over cells is the integral of this polynomial but for 1/n^2 of its second derivative
    const auto both = over_quadrilateral(x, [](const Vec3& at, const Vec3& dA) {
      Vec<6> v;
      v << dA, at.cross(dA);
      return v;
    });
    const auto found = carried(model, gas);
    EXPECT_LT((found.force - 40 * (both.head<3>() + area)).norm(), 1e-4);
    EXPECT_LT((found.moment - 40 * (both.tail<3>() + centre.cross(area))).norm(), 2e-3);
  }
}

/// A plane trapezium, area 8 m2, centroid at (5/3, 13/12): formulas of polygons.
model::Model trapezium(bool as_shell) {
  model::Model model;
  model.nodes = {{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {0, 3, 0}};
  if (as_shell) {
    const int group = add_shell_group(model, "facet");
    model.shells.push_back({{0, 1, 2, 3}, group, Vec3::Zero(), 0, {}, 0});
    model::find_directors(model);
    return model;
  }
  const int group = add_membrane_group(model, "facet");
  model.groups[group].membrane.thermal_expansion = 1e-5;
  model.membranes.push_back({{0, 1, 2, 3}, group, Vec3(1000, 1000, 0)});
  return model;
}

TEST(Loads, OnATrapeziumActInItsCentroid) {
  const Vec3 centroid(5.0 / 3, 13.0 / 12, 0);
  for (const bool as_shell : {false, true}) {
    const auto model = trapezium(as_shell);
    auto load = on("facet");
    load.surface_force = {1, 2, -3};
    expect_carried(model, load, 8 * load.surface_force, centroid.cross(8 * load.surface_force));
    const double mass = as_shell ? 8 * 800 * 0.01 : 8 * 1.2;
    const Vec3 g(1, 2, -9.81);
    expect_carried(model, weight(g), mass * g, centroid.cross(mass * g));
  }
}

TEST(Loads, TakeTheMeanOfATemperatureOverADistortedQuadrilateral) {
  // Polygon integrals over the trapezium: of x 40/3, of x^2 32, of x y 12, of y^2 40/3, by the area 8.
  const auto mean = [](const std::function<double(const Vec3&)>& field) {
    System system(trapezium(false));
    auto load = on("facet");
    load.temperature_field = field;
    system.begin_stage({{support({0, 1, 2, 3})}, {load}});
    system.set_lambda(1);
    return system.model().membranes[0].temperature_change;
  };
  EXPECT_NEAR(mean([](const Vec3& x) { return 10 * x.x(); }), 10 * 40.0 / 3 / 8, 1e-13 * 20);
  EXPECT_NEAR(mean([](const Vec3& x) { return x.x() * x.x(); }), 32.0 / 8, 1e-13 * 5);
  EXPECT_NEAR(mean([](const Vec3& x) { return x.x() * x.y(); }), 12.0 / 8, 1e-13 * 5);
  EXPECT_NEAR(mean([](const Vec3& x) { return x.y() * x.y(); }), 40.0 / 3 / 8, 1e-13 * 5);
}

TEST(Loads, OfWeightArriveWithTheMassesOfAllElements) {
  const auto model = mixture();
  const Vec3 g(1, 2, -9.81);
  const auto found = carried(model, weight(g));
  EXPECT_LT((found.force - model::total_mass(model) * g).norm(), 1e-9 * model::total_mass(model));
}

TEST(Loads, NamedTwiceActOnce) {
  auto model = mixture();
  model.selections["same"].beams = {0, 1};
  model.selections["turned"].edges = {{1, 0}};
  auto load = on("rod");
  load.line_force = {3, -2, 5};
  const Vec3 once = carried(model, load).force;
  load.on = {"rod", "same", "rod"};
  EXPECT_LT((carried(model, load).force - once).norm(), 1e-9);
  load.on = {"edge"};
  const Vec3 edges = carried(model, load).force;
  load.on = {"edge", "turned"};
  EXPECT_LT((carried(model, load).force - edges).norm(), 1e-9);
}

std::vector<double> residual_in(System& system, const model::State& state) {
  system.set_lambda(1);
  system.set_state(state);
  const VecX zero = VecX::Zero(system.n_dofs());
  const VecX found = residual_at(system, zero);
  return {found.data(), found.data() + found.size()};
}

/// What acts at the end of a stage is the same wherever the stage begins.
TEST(Loads, AreFormedOnTheStructureAsDrawn) {
  const auto model = mixture();
  const Boundary boundary{{support({0, 3}, clamped)}, all_loads()};
  System fresh(model), moved(model);
  const auto there = [&](double size) {
    std::vector<double> x(static_cast<std::size_t>(fresh.n_dofs()));
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = size * std::sin(1.7 * static_cast<double>(i) + 0.3);
    return fresh.kinematics().moved(model::State::reference(model), x);
  };
  const auto state = there(0.05);
  fresh.begin_stage(boundary);
  const auto expected = residual_in(fresh, state);
  moved.set_state(there(0.4));
  moved.begin_stage(boundary);
  const auto found = residual_in(moved, state);
  double largest = 0;
  for (const double value : expected) largest = std::max(largest, std::abs(value));
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-13 * largest) << i;
}

/// A rope that is cut longer is heavier by what was added: at once, not in the step after.
TEST(Loads, OfWeightGoByTheLengthsAtTheEndOfTheStage) {
  model::Model model;
  model.nodes = {{0, 0, 0}, {0, 0, -2}};
  const int rope = add_cable_group(model, "rope", 1e4, 3.0);
  add_cable(model, rope, 0, 1, 1e-3);
  System system(model);
  const Boundary boundary{{support({0})}, {weight({0, 0, -9.81})}};
  solve(system, boundary);
  system.set_target_strains({2.0 / 2.001 - 1});
  solve(system, boundary);
  EXPECT_NEAR(system.reactions().force[0].z(), 3.0 * 2.001 * 9.81, 1e-7);
  const auto start = system.begin_stage(boundary);
  EXPECT_LT(start.force, 1e-7);
}

TEST(Loads, OnANodeTiedToAnArmTakeTheMomentToTheSupport) {
  // A bare node at the end of a rigid arm: nothing but the arm takes the moment up.
  auto model = cantilever(2, 2.0, {1e7, 2e4, 1e4, 5e3, 0, 0, 3.0, 0, 0});
  model.nodes.emplace_back(2, 0.5, 0.3);
  model.links.push_back({2, 3, false, {}, -1});
  System system(model);
  const Vec3 force(0.3, 0.2, -0.1), moment(1, -2, 3);
  solve(system, clamped_root(load(3, force, moment)));
  const auto reactions = system.reactions();
  const auto x = model::positions(system.model(), system.state());
  EXPECT_LT((reactions.moment[0] + x[3].cross(force) + moment).norm(), 1e-6);
}

TEST(LoadAudit, KnowsEveryLoadOfTheMixture) {
  const auto model = mixture();
  System system(model);
  EXPECT_NO_THROW(system.begin_stage({{support({0, 3}, clamped)}, all_loads()}));
}

TEST(LoadAudit, KnowsLoadsOfOneUnitOrNone) {
  const auto model = mixture();
  for (const double pressure : {0.0, 1.0, -1.0}) {
    auto gas = on("cloth");
    gas.pressure = pressure;
    System system(model);
    EXPECT_NO_THROW(system.begin_stage({{support({0, 3}, clamped)}, {gas}})) << pressure;
  }
  for (const double size : {1e-6, 0.5, 1.0}) {
    auto snow = on("shell"), wind = on("rod");
    snow.surface_force = Vec3(0, 0, size);
    wind.line_force = Vec3(size, 0, 0);
    System system(model);
    EXPECT_NO_THROW(system.begin_stage({{support({0, 3}, clamped)}, {snow, wind, weight({0, size, 0})}}))
        << size;
  }
}

TEST(LoadAudit, FindsAMomentThatNothingTakesUp) {
  model::Model model;
  model.nodes = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  const int rope = add_cable_group(model, "rope");
  add_cable(model, rope, 0, 1, 1e-3);
  add_cable(model, rope, 1, 2, 1e-3);
  System system(model);
  EXPECT_THROW(system.begin_stage({{support({0, 2})}, {load(1, {0, 0, 0}, {0, 0, 1})}}), std::logic_error);
}

TEST(LoadAudit, FindsOneNameAmongManyThoughTheSumIsRight) {
  model::Model model;
  for (int i = 0; i <= 40; ++i) model.nodes.emplace_back(i, 0, 0);
  const int rope = add_cable_group(model, "rope");
  for (int i = 0; i < 40; ++i) add_cable(model, rope, i, i + 1, 1e-3);
  Boundary boundary{{support({0, 40})}, {}};
  for (int i = 1; i < 40; ++i) {
    boundary.loads.push_back(load(i, {1e9, 0, 1e9}));
    boundary.loads.back().name = std::to_string(i);
  }
  System system(model);
  EXPECT_NO_THROW(system.begin_stage(boundary));
  boundary.loads[17].moment = {0, 0, 1};  // nothing takes these up, and they are opposite
  boundary.loads[18].moment = {0, 0, -1};
  boundary.loads[17].force = boundary.loads[18].force = {0, 1e-3, 0};
  try {
    system.begin_stage(boundary);
    ADD_FAILURE() << "nothing was found";
  } catch (const std::logic_error& error) {
    EXPECT_NE(std::string(error.what()).find("\"18\""), std::string::npos) << error.what();
  }
}

TEST(LoadFaults, AreToldAltogether) {
  auto model = mixture();
  model.supports.push_back(support({0, 3}, clamped));
  auto spin = load(5, {0, 0, 0}, {0, 0, 1});
  spin.name = "on a leader";  // turns with the beam at the end of its arm
  model.loads = {spin};
  EXPECT_NO_THROW(model::validate(model));

  model::Model net;
  net.nodes = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const int cloth = add_membrane_group(net, "cloth");
  net.groups[cloth].membrane.mass_per_area = 0;
  net.membranes.push_back({{0, 1, 2, 3}, cloth, Vec3(1, 1, 0)});
  net.supports.push_back(support({0, 3}));
  net.selections["diagonal"].edges = {{0, 2}};
  net.selections["side"].edges = {{0, 1}};
  net.selections["nothing"] = {};
  auto moment = load(1, {0, 0, 0}, {0, 0, 1}), along = on("diagonal"), twist = on("side"),
       far = on("nothing");
  moment.name = "moment";
  moment.where = {"deck.yaml", 12, 5};
  along.name = "along";
  along.line_force = {1, 0, 0};
  twist.name = "twist";
  twist.line_moment = {1, 0, 0};
  far.name = "far";
  far.force = {1, 0, 0};
  auto pull = weight({0, 0, -9.81});
  pull.name = "weight";
  net.loads = {moment, along, twist, far, pull};
  try {
    model::validate(net);
    FAIL() << "five loads act on nothing";
  } catch (const ModelError& error) {
    const std::string text = error.what();
    for (const char* part : {"deck.yaml:12:5: load \"moment\": nothing at node 2",
                             "load \"along\": the edge from", "load \"twist\": nothing at",
                             "load \"far\": it acts on nodes", "load \"weight\": acceleration acts on mass"})
      EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
}

}  // namespace
}  // namespace tautline::assembly
