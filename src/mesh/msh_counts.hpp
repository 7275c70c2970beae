#pragma once
/// @file
/// Whether a gmsh file in text holds as many nodes and elements as it says.

#include <string>

namespace tautline::mesh {

/// @brief What is wrong with the counts of $Nodes and $Elements (versions 2.2 and 4.1 in text); "" if
/// nothing.
///
/// gmsh's reader stops at the count that is written and skips what follows up to the end of the section: of a
/// file whose count is too small a part of the structure would be missing without a word.
std::string fault_of_counts(const std::string& path);

}  // namespace tautline::mesh
