#pragma once
/// @file
/// Where a run can be taken up again: after each step, and within a step after each point of its path. What
/// is written does not depend on the number of ranks.

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <tautline/assembly/system.hpp>
#include <tautline/deck/deck.hpp>

namespace tautline::steps {

using Json = nlohmann::ordered_json;

/// A converged point within a stage of an equilibrium.
struct StagePoint {
  int stage = 0;                          ///< index among the stages that the step makes
  assembly::Rest start;                   ///< the system when the stage began
  assembly::Place place;                  ///< where it is
  std::optional<analysis::ArcPlace> arc;  ///< and how it goes on, of a path followed by its length
  Json entry, way, critical;              ///< what the step has to tell so far
};

/// What a checkpoint holds.
struct Checkpoint {
  int steps_done = 0;
  Json results = {{"steps", Json::array()}, {"warnings", Json::array()}};  ///< results.json as far as it goes
  std::vector<std::string> acting_loads;                                   ///< as Context's
  std::optional<assembly::Rest> rest;  ///< of the system after the steps done, if there is one
  std::optional<StagePoint> point;     ///< within the step that comes next
};

/// Writes checkpoints into a directory of their own: one for each step done, and the latest point of a path.
class Checkpoints {
 public:
  Checkpoints(const deck::Deck& deck, std::string directory);

  /// After a step. Collective.
  void save(const Checkpoint& checkpoint);
  /// Within a step; `checkpoint` is as after the step before. Passes over points where writing would take
  /// more than a twentieth of the time, unless `always`. Collective.
  void save_point(const Checkpoint& checkpoint, bool always);
  /// Where a run was taken up.
  void begin_at(const Checkpoint& checkpoint);
  /// The checkpoint after the steps done so far, to which points are put.
  const Checkpoint& latest() const { return latest_; }
  /// Time spent on writing [s].
  double seconds() const { return seconds_; }

 private:
  void write(const Checkpoint& checkpoint, const std::string& name);

  const deck::Deck& deck_;
  std::string directory_;
  Checkpoint latest_;
  double next_ = 0;  // when the next point may be written [s]
  double seconds_ = 0;
};

/// @brief The checkpoint in a directory of results that goes farthest along the steps of this deck, or
/// nothing if not even the first step is the same. Read by every rank.
/// @throws LibraryError if there are none, or one is damaged or belongs to another structure
std::optional<Checkpoint> find_checkpoint(const deck::Deck& deck, const std::string& directory);

/// @throws LibraryError unless every list of the checkpoint has as many entries as `wanted`, of the mesh as
/// made
void require_fit(const Checkpoint& checkpoint, const assembly::Rest& wanted, const std::string& from);

}  // namespace tautline::steps
