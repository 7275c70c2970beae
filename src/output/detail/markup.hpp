#pragma once
/// @file
/// Text made safe for XML and HTML.

#include <string>
#include <string_view>

namespace tautline::output::detail {

/// `text` with the characters & < > " ' escaped: safe between tags and in quoted attributes.
std::string escape_markup(std::string_view text);

}  // namespace tautline::output::detail
