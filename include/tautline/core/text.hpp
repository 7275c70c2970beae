#pragma once
/// @file
/// Small text helpers shared by messages.

#include <string>
#include <string_view>
#include <vector>

namespace tautline {

/// The candidate nearest to `word`, or "" if none is near. Case, '-' and '_' do not count; accepted up to a
/// Levenshtein distance of 1 + length/5. Words of one or two letters are never guessed.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// "a, b, c" ; at most `most` names, then "... (N in all)".
std::string join(const std::vector<std::string>& words, std::string_view separator = ", ",
                 std::size_t most = 20);

/// The first `most` bytes, no character cut in two, and "..." for what is left.
std::string shortened(const std::string& text, std::size_t most);

/// Number of characters (UTF-8 code points) in the first `bytes` bytes of `text`.
int characters(std::string_view text, std::size_t bytes);

/// Byte offset of the first byte that is no text in UTF-8 (control characters included), or npos.
std::size_t first_bad_byte(std::string_view text);

/// The text with every byte that is no text in UTF-8 written as \\xNN, so that it does nothing to a terminal.
std::string printable(std::string_view text);

}  // namespace tautline
