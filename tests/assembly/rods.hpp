#pragma once
// A soft rod of beams, straight in any direction.

#include "assembly/models.hpp"

namespace tautline::assembly::testing_models {

inline element::BeamSection rod() {
  element::BeamSection section;
  section.axial_stiffness = 1e6;
  section.bending_stiffness_2 = 100;
  section.bending_stiffness_3 = 150;
  section.torsion_stiffness = 80;
  section.mass_per_length = 1;
  return section;
}

/// From the origin to a point.
inline model::Model beam_to(const Vec3& tip, int parts = 1) {
  model::Model model;
  for (int i = 0; i <= parts; ++i) model.nodes.emplace_back(tip * i / parts);
  const int group = add_beam_group(model, "rod");
  model.groups[group].beam = rod();
  for (int i = 0; i < parts; ++i) add_beam(model, group, i, i + 1);
  return model;
}

}  // namespace tautline::assembly::testing_models
