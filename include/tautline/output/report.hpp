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

/// The closing summary on stdout: form-finding, stages, tuning by pass, RMS, tensions, forces, frequencies,
/// mass.
std::string summary_text(const nlohmann::ordered_json& results);

/// Table of surface error, tensions, frequencies, time of several results (command `compare`).
std::string comparison_text(const std::vector<std::string>& directories);

}  // namespace tautline::output
