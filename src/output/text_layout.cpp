#include <algorithm>
#include <sstream>

#include <fmt/format.h>

#include <tautline/core/text.hpp>
#include "output/detail/layout.hpp"

namespace tautline::output::detail {

namespace {

constexpr std::size_t longest_line = 100;

std::string padded(const std::string& cell, std::size_t to, bool left) {
  const std::string blanks(to > text_width(cell) ? to - text_width(cell) : 0, ' ');
  return left ? cell + blanks : blanks + cell;
}

/// What stays in one line: short parts as a whole, the words of long ones; a comma between parts.
std::vector<std::string> pieces(const std::vector<std::string>& parts) {
  constexpr std::size_t longest_whole = 40;
  std::vector<std::string> result;
  for (const auto& part : parts) {
    if (!result.empty()) result.back() += ',';
    if (text_width(part) <= longest_whole) {
      result.push_back(part);
      continue;
    }
    std::istringstream words(part);
    for (std::string word; words >> word;) result.push_back(word);
  }
  return result;
}

}  // namespace

std::size_t text_width(const std::string& text) {
  return static_cast<std::size_t>(characters(text, text.size()));
}

std::vector<std::string> table_lines(const Table& table, std::size_t most, std::size_t first_width) {
  std::vector<Row> rows{table.header};
  rows.insert(rows.end(), table.rows.begin(), table.rows.end());
  std::vector<std::size_t> widths{first_width};
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], text_width(row[i]));
  }
  std::vector<std::string> lines;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i)
      line += (i == 0 ? "" : "  ") + padded(row[i], widths[i], i == 0);
    line.erase(line.find_last_not_of(' ') + 1);
    lines.push_back(std::move(line));
  }
  if (table.rows.size() <= most) return lines;
  const auto from = static_cast<std::ptrdiff_t>(1 + most / 2);
  const auto left_out = static_cast<std::ptrdiff_t>(table.rows.size() - most);
  lines.erase(lines.begin() + from, lines.begin() + from + left_out);
  lines.insert(lines.begin() + from, fmt::format("... {} rows between", left_out));
  return lines;
}

std::vector<std::string> hanging_lines(const std::string& label, std::size_t indent,
                                       const std::vector<std::string>& parts) {
  std::vector<std::string> lines{padded(label, indent, true)};
  if (!label.empty() && text_width(label) >= indent) lines[0] += "  ";
  bool first = true;
  for (const auto& piece : pieces(parts)) {
    if (!first && text_width(lines.back()) + 1 + text_width(piece) > longest_line) {
      lines.emplace_back(indent, ' ');
      first = true;
    }
    lines.back() += (first ? "" : " ") + piece;
    first = false;
  }
  lines.back().erase(lines.back().find_last_not_of(' ') + 1);
  return lines;
}

}  // namespace tautline::output::detail
