#pragma once
/// @file
/// results.json: written after every step, so that an interrupted run leaves a valid file.

#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace tautline::output {

/// Writes `results` to `path` by way of a temporary file and a rename, so that a reader never sees half a
/// file. Numbers have the digits (up to 17) that bring them back bit for bit; NaN and infinity become null.
/// @throws LibraryError with the reason
void write_results(const std::string& path, const nlohmann::ordered_json& results);
nlohmann::ordered_json read_results(const std::string& path);

/// Writes a text likewise. @throws LibraryError with the reason
void write_text(const std::string& path, const std::string& text);

/// Writes bytes likewise, and returns when they and their name are on the disk.
/// @throws LibraryError with the reason; what was at `path` before is still there
void write_durably(const std::string& path, std::string_view bytes);

/// Creates `directory` with its parents and proves that it can be written to. @throws LibraryError naming it
/// and why
void prepare_directory(const std::string& directory);

}  // namespace tautline::output
