#pragma once
/// @file
/// One unstructured grid in one .vtu file.

#include <string>

#include <tautline/output/fields.hpp>

namespace tautline::output::detail {

/// Binary appended and compressed; the arrays have been checked. @throws LibraryError naming `path` and the
/// reason
void write_vtu(const std::string& path, const FieldGrid& grid);

}  // namespace tautline::output::detail
