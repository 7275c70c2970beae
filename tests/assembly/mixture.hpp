#pragma once
// A structure of every kind of element, and every kind of load on it.

#include "assembly/models.hpp"

namespace tautline::assembly::testing_models {

inline int add_shell_group(model::Model& model, const std::string& name) {
  auto& group = model.groups.emplace_back();
  group.name = name;
  group.kind = model::ElementKind::shell;
  group.shell.young_modulus = 2e9;
  group.shell.poisson_ratio = 0.3;
  group.shell.thickness = 0.01;
  group.shell.density = 800;
  group.shell.thermal_expansion = 1e-5;
  return static_cast<int>(model.groups.size()) - 1;
}

inline model::Load on(const std::string& name) {
  model::Load result;
  result.name = "load";
  result.on = {name};
  return result;
}

/// A distorted quadrilateral beside a triangle of cloth, and of shell, a beam with an end on an arm, a cable,
/// a bar, a catenary, a mass on an arm; every node away from the axes.
inline model::Model mixture() {
  model::Model model;
  model.nodes = {{0.3, 0.2, 0.1}, {4.1, 0.4, 0.3}, {3.6, 1.9, 0.5}, {0.1, 3.2, -0.2}, {5.9, 2.8, 0.4},
                 {2.1, 2.2, 4.0}, {2.3, 1.8, 4.4}, {7.0, 0.5, 3.0}, {7.2, 0.9, 3.3}};
  const int cloth = add_membrane_group(model, "cloth"), shell = add_shell_group(model, "shell"),
            rod = add_beam_group(model, "rod"), rope = add_cable_group(model, "rope"),
            bar = add_cable_group(model, "bar"), line = add_cable_group(model, "line", 1e5, 2.0);
  model.groups[cloth].membrane.thermal_expansion = 1e-5;
  for (const int group : {rod, rope, bar, line}) model.groups[group].thermal_expansion = 1e-5;
  model.groups[bar].kind = model::ElementKind::bar;
  model.groups[line].kind = model::ElementKind::catenary;
  auto& mass = model.groups.emplace_back();
  mass.name = "mass";
  mass.kind = model::ElementKind::mass;
  mass.mass.mass = 7;
  model.membranes.push_back({{0, 1, 2, 3}, cloth, Vec3(300, 200, 20)});
  model.membranes.push_back({{1, 4, 2}, cloth, Vec3(300, 200, 20)});
  model.shells.push_back({{0, 1, 2, 3}, shell, Vec3::Zero(), 0, {}, 0});
  model.shells.push_back({{1, 4, 2}, shell, Vec3::Zero(), 1, {}, 0});
  model::find_directors(model);
  add_beam(model, rod, 4, 6);
  add_cable(model, rope, 3, 5, 1e-3);
  add_cable(model, bar, 0, 5, -1e-3);
  add_cable(model, line, 5, 7, -0.08);
  model.masses.push_back({{8}, static_cast<int>(model.groups.size()) - 1});
  model.links.push_back({5, 6, false, {}, -1});
  model.links.push_back({7, 8, false, {}, -1});
  add_beam(model, rod, 1, 7);
  model.selections["edge"].edges = {{0, 1}, {2, 3}};
  return model;
}

inline Boundary held(const model::Model& model, std::vector<model::Load> loads) {
  std::vector<int> nodes;
  for (int i = 0; i < static_cast<int>(model.nodes.size()); ++i)
    if (i != 6 && i != 8) nodes.push_back(i);  // these follow
  return {{support(nodes, clamped)}, std::move(loads)};
}

/// Every kind of load there is, on the mixture.
inline std::vector<model::Load> all_loads() {
  auto lines = on("rod"), gas = on("cloth"), snow = on("shell"), heat = on("rope"), warm = on("rod"),
       ice = on("line"), rope = on("rope"), edge = on("edge");
  lines.line_force = {3, -20, 50};
  lines.line_moment = {1, 2, 3};
  gas.pressure = 400;
  snow.surface_force = {10, 20, -30};
  heat.temperature_change = 30;
  warm.temperature_field = [](const Vec3& x) { return 3 * x.x() + x.y(); };
  warm.temperature_gradient = [](const Vec3&) { return Vec3(3, 1, 0); };
  ice.line_force = {1, 2, -4};
  rope.line_force = {5, 6, 7};
  edge.line_force = {-5, 6, 7};
  return {
      lines, gas, snow, heat, warm, ice, rope, edge, load(6, {1, 2, 3}, {4, 5, 6}), weight({1, 2, -9.81})};
}

}  // namespace tautline::assembly::testing_models
