#pragma once
// Small structures that several tests of the model share.

#include <string>
#include <tautline/element/beam.hpp>
#include <tautline/model/model.hpp>

namespace tautline::model::testing_models {

/// Adds a group of cables and returns its index.
inline int add_cable_group(Model& model, const std::string& name, double axial_stiffness = 1e6,
                           double mass_per_length = 0.5) {
  Group group;
  group.name = name;
  group.kind = ElementKind::cable;
  group.cable = {axial_stiffness, mass_per_length};
  model.groups.push_back(group);
  return static_cast<int>(model.groups.size()) - 1;
}

inline int add_beam_group(Model& model, const std::string& name) {
  Group group;
  group.name = name;
  group.kind = ElementKind::beam;
  group.beam = {1e7, 2e4, 1e4, 5e3, 0, 0, 3.0, 0.01, 0.02};
  model.groups.push_back(group);
  return static_cast<int>(model.groups.size()) - 1;
}

inline int add_membrane_group(Model& model, const std::string& name) {
  Group group;
  group.name = name;
  group.kind = ElementKind::membrane;
  group.membrane = {5e5, 0.3, 1.2};
  model.groups.push_back(group);
  return static_cast<int>(model.groups.size()) - 1;
}

inline void add_cable(Model& model, int group, int a, int b, double initial_strain = 0) {
  model.cables.push_back({{a, b}, group, initial_strain, static_cast<int>(model.cables.size())});
}

inline void add_beam(Model& model, int group, int a, int b) {
  Mat<3, 2> x_ref;
  x_ref << model.nodes[a], model.nodes[b];
  model.beams.push_back({{a, b},
                         group,
                         element::beam_frame(x_ref, model.groups[group].orientation),
                         static_cast<int>(model.beams.size())});
}

inline void add_membrane(Model& model, int group, int a, int b, int c, const Vec3& prestress = Vec3::Zero()) {
  model.membranes.push_back({{a, b, c}, group, prestress, static_cast<int>(model.membranes.size())});
}

/// Two facets with the shared side 1-2, in space; a cable "ridge" on that side, a cable "tie" that is no side
/// (0-3), a beam "strut" on the side 2-3 and a beam "mast" below node 0. Node 4 is the foot of the mast.
inline Model two_facets() {
  Model model;
  model.nodes = {{0, 0, 0}, {2, 0.1, 0.3}, {0.2, 1.7, 0.4}, {2.1, 1.9, -0.2}, {0, 0, -1}};
  const int cloth = add_membrane_group(model, "cloth"), ridge = add_cable_group(model, "ridge"),
            tie = add_cable_group(model, "tie"), strut = add_beam_group(model, "strut"),
            mast = add_beam_group(model, "mast");
  add_membrane(model, cloth, 0, 1, 2, {300, 100, 40});
  add_membrane(model, cloth, 2, 1, 3, {50, 400, -70});
  add_cable(model, ridge, 1, 2, 1e-3);
  add_cable(model, tie, 0, 3, 2e-3);
  add_beam(model, strut, 2, 3);
  add_beam(model, mast, 0, 4);
  model.selections["anchors"].nodes = {3, 4};
  model.selections["everything"] = {{}, {0, 1}, {0, 1}, {0, 1}, {}, {}, {}, {}};
  model.supports.push_back({"ground", {"anchors"}, {3, 4}, {true, true, true, true, true, true}});
  return model;
}

}  // namespace tautline::model::testing_models
