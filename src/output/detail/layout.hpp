#pragma once
/// @file
/// Tables and facts as plain text and as HTML.

#include <string>
#include <vector>

#include "output/detail/story.hpp"

namespace tautline::output::detail {

/// Aligned columns, the first to the left and at least `first_width` wide, the others to the right. Of more
/// than `most` rows those in the middle are left out, and the table says how many.
std::vector<std::string> table_lines(const Table& table, std::size_t most, std::size_t first_width = 0);

/// The parts with commas between them, broken into lines of at most 100 characters; the first line begins
/// with `label`, the text of all of them at `indent`.
std::vector<std::string> hanging_lines(const std::string& label, std::size_t indent,
                                       const std::vector<std::string>& parts);

/// As many characters as are seen, not bytes.
std::size_t text_width(const std::string& text);

std::string html_table(const Table& table);
/// With a heading, if it has one.
std::string html_facts(const std::vector<Fact>& facts, const std::string& title = "");
std::string html_cards(const std::vector<Fact>& facts);
/// Tables and figures side by side as far as there is room; "" if there are none.
std::string html_blocks(const std::string& blocks);

/// A complete page around `body`: style inside, nothing loaded from outside, light and dark, printable.
std::string html_page(const std::string& title, const std::string& body);

}  // namespace tautline::output::detail
