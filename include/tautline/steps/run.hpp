#pragma once
/// @file
/// Running a deck: its steps one after the other, everything written as it comes.

#include <string>
#include <vector>

#include <tautline/core/error.hpp>
#include <tautline/core/progress.hpp>
#include <tautline/deck/deck.hpp>

namespace tautline::steps {

struct RunSettings {
  std::string directory;  ///< where results go; made if it is not there
  bool pictures = true;   ///< draw PNG pictures (the deck can switch them off, too)
  std::string from;       ///< directory of results whose checkpoints the run goes on from; empty: begin anew
};

/// @brief Runs a deck. Collective. Writes results.json after every step, so that whatever happens a valid
/// file is left.
/// @return done, not_converged or interrupted; the reason is in results.json and in the summary on stdout
/// @throws ModelError, LibraryError as the steps meet them, after results.json was written
ExitCode run(const deck::Deck& deck, const RunSettings& settings, Progress& progress);

/// @brief Runs a deck for several subdivisions and reports RMS, unknowns, time and Newton iterations against
/// them, with the observed order and the extrapolated value (study.json, study.csv, a picture). Collective.
ExitCode study(const std::string& deck_path, const std::vector<std::string>& overrides,
               const std::vector<int>& subdivisions, const RunSettings& settings, Progress& progress);

/// @brief Everything that can be said of a deck without solving it: the model's numbers, and what would make
/// the solve fail.
/// @return text for stdout. @throws DeckError, ModelError
std::string check(const deck::Deck& deck);

}  // namespace tautline::steps
