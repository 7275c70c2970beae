#pragma once
/// @file
/// Whole files read and written in one go; every error names the file and the reason.

#include <string>
#include <string_view>

namespace tautline::output::detail {

/// Writes `text` to a temporary file beside `path` and renames it: a reader never sees half a file.
/// @param durable file and name are on the disk when this returns, also if the machine then loses its power
/// @throws LibraryError naming `path` and the reason; what was at `path` before is still there
void write_file(const std::string& path, std::string_view text, bool durable = false);

/// @throws LibraryError naming `path` and the reason
std::string read_file(const std::string& path);

/// The text of an errno value, or "unknown error" for 0.
std::string reason(int error_number);

}  // namespace tautline::output::detail
