#pragma once
/// @file
/// What hangs slack at an equilibrium without resistance, and whether that matters.

#include <optional>
#include <string>
#include <vector>

#include <tautline/assembly/system.hpp>

namespace tautline::assembly {

/// Nodes that can move without resistance because nothing but slack cables and slack or wrinkled sheets meets
/// there.
struct Slack {
  std::vector<int> nodes;
  std::vector<int> cables, membranes;  ///< those that meet there, by index
  std::string text;                    ///< a sentence with groups, numbers and places
};

/// @brief Looks at a state whose tangent is singular under the supports of the stage begun last. Collective.
/// @return nothing if any motion without resistance moves other nodes, or if what acts has a part in one:
/// then it is a mechanism
std::optional<Slack> find_slack(System& system, analysis::Workspace& workspace);

}  // namespace tautline::assembly
