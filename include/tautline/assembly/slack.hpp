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

/// @brief Next to no stiffness in every tangent, while it lives, where slack parts move without resistance:
/// for analyses about an equilibrium in which such parts stay where they are.
///
/// Forces and what resists by itself are as before. Collective.
class Bracing {
 public:
  /// @param system  in a stage begun at an equilibrium whose tangent is singular
  Bracing(System& system, analysis::Workspace& workspace);
  ~Bracing();
  Bracing(const Bracing&) = delete;
  Bracing& operator=(const Bracing&) = delete;
  /// False where it is no use: what moves is a mechanism, or the stage's loads act on what is slack.
  bool holds() const { return holds_; }

 private:
  System& system_;
  bool holds_ = false;
};

}  // namespace tautline::assembly
