#pragma once
/// @file
/// From YAML text to located nodes. yaml-cpp is known to the source of this header only.

#include <deck/node.hpp>
#include <deck/source.hpp>
#include <string>

namespace tautline::deck {

/// @brief The one document of a deck.
///
/// Aliases are copied out: an alias is placed where it is used, what is inside it where the anchor stands,
/// and both carry a note.
/// @throws DeckError for text that is not UTF-8, not YAML, empty, several documents, or no mapping at the top
Node parse_yaml(const Source& source, const std::string& text);

}  // namespace tautline::deck
