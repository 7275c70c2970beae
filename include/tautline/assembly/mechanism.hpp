#pragma once
/// @file
/// Whether and where the structure can move without resistance.

#include <optional>
#include <string>
#include <vector>

#include <tautline/assembly/system.hpp>

namespace tautline::assembly {

/// A motion that the tangent stiffness does not resist.
struct Mechanism {
  std::vector<int> nodes;  ///< those that move most, the first most of all; at most five
  Vec3 direction;          ///< of the first node's motion (or of its rotation if `rotation`), unit
  bool rotation = false;   ///< the motion is a rotation of the node
  std::string motion;      ///< what can move without resistance, as a sentence
  std::string text;        ///< a sentence with nodes, groups, places, directions and the likely cause
};

/// @brief Looks at the tangent in the present state under the supports of the stage begun last. Collective.
/// @return nothing if every motion is resisted
std::optional<Mechanism> find_mechanism(System& system, analysis::Workspace& workspace);

/// @brief A motion of the undeformed structure that no tension could resist: parts that no support holds in
/// some direction, joints that leave a member free to spin. No load makes it stiff. Collective.
std::optional<Mechanism> find_loose_part(const model::Model& model, const Boundary& boundary);

}  // namespace tautline::assembly
