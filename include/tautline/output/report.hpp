#pragma once
/// @file
/// report.html: results.json as a self-contained page with the pictures embedded. Theory of what it shows:
/// docs/report.md

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace tautline::output {

/// (Re)builds DIR/report.html from DIR/results.json and the *.png files in DIR/pictures. Several directories:
/// the figures side by side, written to the first one's comparison.html. @return the path written. @throws
/// LibraryError
std::string write_report(const std::vector<std::string>& directories);

/// The closing summary on stdout: the story of the run step by step, then the figures of the final state.
/// Nothing is left out of it for a deck of the usual length (some 45 lines).
/// @param directory where the results are; "": not told
std::string summary_text(const nlohmann::ordered_json& results, const std::string& directory = "");

/// Table of surface error, tensions, frequencies, time of several results (command `compare`).
std::string comparison_text(const std::vector<std::string>& directories);

}  // namespace tautline::output
