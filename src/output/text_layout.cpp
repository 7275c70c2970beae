#include <algorithm>

#include <fmt/format.h>

#include <tautline/core/text.hpp>
#include "output/detail/layout.hpp"

namespace tautline::output::detail {

namespace {

std::size_t width(const std::string& cell) {
  return static_cast<std::size_t>(characters(cell, cell.size()));
}

std::string padded(const std::string& cell, std::size_t to, bool left) {
  const std::string blanks(to > width(cell) ? to - width(cell) : 0, ' ');
  return left ? cell + blanks : blanks + cell;
}

}  // namespace

std::vector<std::string> table_lines(const Table& table, std::size_t most) {
  std::vector<Row> rows{table.header};
  rows.insert(rows.end(), table.rows.begin(),
              table.rows.begin() + static_cast<std::ptrdiff_t>(std::min(most, table.rows.size())));
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width(row[i]));
  }
  std::vector<std::string> lines;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i)
      line += (i == 0 ? "" : "  ") + padded(row[i], widths[i], i == 0);
    line.erase(line.find_last_not_of(' ') + 1);
    lines.push_back(std::move(line));
  }
  if (table.rows.size() > most) lines.push_back(fmt::format("... {} more", table.rows.size() - most));
  return lines;
}

std::vector<std::string> fact_lines(const std::vector<Fact>& facts) {
  std::vector<std::string> lines;
  for (const auto& [label, value] : facts) {
    const std::string fact = label + " " + value;
    if (!lines.empty() && width(lines.back()) + width(fact) < 100)
      lines.back() += ", " + fact;
    else
      lines.push_back(fact);
  }
  return lines;
}

}  // namespace tautline::output::detail
