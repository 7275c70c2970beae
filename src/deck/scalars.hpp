#pragma once
/// @file
/// Numbers and words of a deck, read strictly: no octal, no "yes", no "nan", no units, no decimal comma.

#include <optional>
#include <string>

namespace tautline::deck {

/// A value, or why there is none.
template <class T>
struct Parsed {
  std::optional<T> value;
  std::string fault;   ///< e.g. is not a number
  std::string remedy;  ///< e.g. write 0.01
};

/// @param unit  unit of the key, for the remedy where the text carries a unit of its own
Parsed<double> parse_number(const std::string& text, const std::string& unit);
Parsed<int> parse_integer(const std::string& text);
Parsed<bool> parse_boolean(const std::string& text);

/// A number as a person writes it: 12, 0.01, 1e-09.
std::string format_number(double value);

}  // namespace tautline::deck
