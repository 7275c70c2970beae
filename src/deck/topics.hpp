#pragma once
/// @file
/// The keyword table as a list of topics a user can ask for.

#include <deck/keyword.hpp>
#include <string>
#include <vector>

namespace tautline::deck {

/// A key, or one of the kinds of a block.
struct Topic {
  std::string path;                  ///< e.g. steps.mesh.subdivisions, sections.cable
  const Block* block = nullptr;      ///< the kind, or the block that holds the key
  const Keyword* keyword = nullptr;  ///< null for a kind
};

std::vector<Topic> all_topics();

/// "number", "list of names", "block", ...
std::string type_text(const Keyword& keyword);
/// Default, "required", or "" if there is none.
std::string default_text(const Keyword& keyword);
/// Limits or choices, or "".
std::string range_text(const Keyword& keyword);

}  // namespace tautline::deck
