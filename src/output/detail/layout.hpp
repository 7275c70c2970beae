#pragma once
/// @file
/// Tables and facts as plain text and as HTML.

#include <string>
#include <vector>

#include "output/detail/story.hpp"

namespace tautline::output::detail {

/// Aligned columns, the first to the left, the others to the right; at most `most` rows.
std::vector<std::string> table_lines(const Table& table, std::size_t most);

/// "label value, label value" broken into lines of at most 100 characters.
std::vector<std::string> fact_lines(const std::vector<Fact>& facts);

std::string html_table(const Table& table);
std::string html_facts(const std::vector<Fact>& facts);
std::string html_cards(const std::vector<Fact>& facts);

/// A complete page around `body`: style inside, nothing loaded from outside, light and dark, printable.
std::string html_page(const std::string& title, const std::string& body);

}  // namespace tautline::output::detail
