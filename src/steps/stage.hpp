#pragma once
/// @file
/// The stages of an equilibrium: each is followed, recorded and kept for a restart.

#include <string>
#include <vector>

#include <tautline/analysis/path.hpp>

#include "steps/context.hpp"
#include "steps/diagnosis.hpp"

namespace tautline::steps {

/// A stage and the loads that act at its end.
struct Part {
  StageOptions stage;
  std::vector<std::string> loads;
};

/// @brief The stages of an equilibrium in order.
///
/// Loads come in the last one; before a path that is followed by its length what is released comes to rest
/// under the loads that act already. What an automatic release puts in between is not known before.
std::vector<Part> parts_of(Context& context, const EquilibriumOptions& options);

/// Runs the stages of one step and records what they leave.
class StageRunner {
 public:
  StageRunner(Context& context, const EquilibriumOptions& options);

  /// Follows a stage to its end under `loads` (none if empty). `is_last`: the one whose path is reported.
  /// @return whether it came to its end. @throws ModelError for a mechanism
  bool run(const StageOptions& stage, const std::vector<std::string>& loads, bool is_last);
  /// Index of the stage in which the step is taken up again, or 0; the stages before are recorded.
  int first() const { return first_; }

  const Json& entries() const { return entries_; }
  const Json& way() const { return way_; }
  const Json& critical() const { return critical_; }
  const assembly::Boundary& boundary() const { return boundary_; }
  /// Of the step so far, whose last stage ended as recorded.
  Diagnosis diagnosis(bool unstable) const;

 private:
  /// Warns of what is slack at the stage's end. @throws ModelError if the structure can move without
  /// resistance where the path ended
  void refuse_mechanism(const StageOptions& stage, const analysis::PathSummary& path,
                        const analysis::PathProblem::Kept& at_start, bool is_last);
  analysis::PathSummary follow_stage(const StageOptions& stage, bool is_last,
                                     const assembly::OutOfBalance& imbalance, Checkpoint& bookmark);
  analysis::PathSummary walk(const std::string& what, const analysis::PathCallback& callback,
                             const analysis::PathStart& start);
  void note(const analysis::PathPoint& point);
  void save_point(Checkpoint& bookmark, bool always);
  Json entry_of(const StageOptions& stage, const assembly::OutOfBalance& start,
                const analysis::PathSummary& path, double seconds) const;

  Context& context_;
  const EquilibriumOptions& options_;
  Json entries_ = Json::array(), way_ = Json::array(), critical_ = Json::array();
  assembly::Boundary boundary_;
  int first_ = 0;
  Beginning beginning_;               // of the step
  assembly::OutOfBalance imbalance_;  // of the stage run last, at its start
};

}  // namespace tautline::steps
