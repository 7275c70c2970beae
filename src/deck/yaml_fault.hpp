#pragma once
/// @file
/// What is wrong with a deck's YAML, in words a user can act on.

#include <deck/node.hpp>
#include <deck/source.hpp>
#include <string>

namespace tautline::deck {

/// Thrown inside the YAML reader only; becomes a DeckError.
struct YamlFault {
  Place place;
  std::string message;
  std::string remedy;
};

[[noreturn]] void reject(const Place& place, const std::string& message, const std::string& remedy = {});

/// The library's complaint made understandable. Line and byte column count from 0.
YamlFault explain_syntax(const Source& source, int line, int column, const std::string& complaint);

/// Throws if the quote that opens here is never closed, or only in a later line.
void reject_open_quote(const Source& source, int line, int column);

}  // namespace tautline::deck
