#include "steps/imperfection.hpp"

#include <Eigen/Geometry>

namespace tautline::steps {

model::Model made_imperfect(model::Model structure, const Points& shape) {
  const Points perfect = structure.nodes;
  for (std::size_t i = 0; i < shape.size(); ++i) structure.nodes[i] += shape[i];
  for (auto& beam : structure.beams) {
    const auto [a, b] = beam.nodes;
    const Vec3 before = perfect[static_cast<std::size_t>(b)] - perfect[static_cast<std::size_t>(a)];
    const Vec3 after =
        structure.nodes[static_cast<std::size_t>(b)] - structure.nodes[static_cast<std::size_t>(a)];
    beam.frame = Eigen::Quaterniond::FromTwoVectors(before, after).toRotationMatrix() * beam.frame;
  }
  model::find_directors(structure);
  return structure;
}

}  // namespace tautline::steps
