#pragma once
/// @file
/// A deck run once for every combination of parameter values, and what came of it.

#include <string>
#include <vector>

#include <tautline/steps/run.hpp>

namespace tautline::steps {

/// Values that a parameter takes one after the other.
struct StudyRange {
  std::string name;  ///< of the deck's `parameters`, or a path such as reflector.struts
  std::vector<std::string> values;
};

/// What a study reports of every run.
struct StudyQuantity {
  std::string label;
  std::string path;  ///< into results.json, see output/pointer.hpp
};

struct ParameterStudy {
  std::string deck;                    ///< file
  std::vector<std::string> overrides;  ///< path.to.key=value, the same for all runs
  std::vector<StudyRange> over;
  std::vector<StudyQuantity> quantities;  ///< none: surface error, mass, lowest frequency, time
  int jobs = 1;                           ///< runs side by side
};

/// @brief Reads "rings=8,10,12". @throws DeckError that shows what is wrong
StudyRange read_range(const std::string& text);
/// @brief Reads "RMS=/steps/tuning/surface/rms", or a path alone, which then is the label as well.
StudyQuantity read_quantity(const std::string& text);

/// All combinations as overrides; the first parameter varies slowest.
std::vector<std::vector<std::string>> combinations(const std::vector<StudyRange>& over);

/// @brief Runs every combination and reports: study.json, study.csv, pictures, a table on stdout.
///
/// Several at a time in processes of their own; under mpirun one after the other on all ranks, then
/// collective. A run that fails is listed with its message and does not stop the others.
/// @return done if all runs came to their end, else not_converged or interrupted
/// @throws DeckError if the deck has no parameter of that name
ExitCode study_parameters(const ParameterStudy& study, const RunSettings& settings, Progress& progress);

}  // namespace tautline::steps
