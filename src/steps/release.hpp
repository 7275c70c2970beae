#pragma once
/// @file
/// Which parts of a structure are released together, found by trying.

#include <string>
#include <vector>

#include "steps/context.hpp"

namespace tautline::steps {

/// Stages that were followed to their end, one after the other, from where the system stands.
struct ReleaseSchedule {
  std::vector<StageOptions> stages;
  Json attempts = Json::array();  ///< what was held, whether that converged, Newton iterations
  std::string schedule;           ///< the stages as text of a deck
  std::string summary;            ///< in a sentence
};

/// @brief Tries everything at once; where that fails, the largest set of groups whose release converges,
/// stiffest groups first, round after round. The system is left where it was. Collective.
///
/// Candidates for being held are the groups of beams and shells; where even the rest of the structure alone
/// does not converge, the schedule ends with what was tried last.
ReleaseSchedule find_release(Context& context, const std::vector<std::string>& loads);

}  // namespace tautline::steps
