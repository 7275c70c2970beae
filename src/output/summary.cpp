#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tautline/output/report.hpp>
#include "output/detail/layout.hpp"
#include "output/detail/story.hpp"

namespace tautline::output {

namespace {

constexpr std::size_t most_lines = 60;

using Lines = std::vector<std::string>;

void append(Lines& lines, const Lines& more, const std::string& indent) {
  for (const auto& line : more) lines.push_back(indent + line);
}

void append_step(Lines& lines, const detail::Chapter& step, std::size_t rows) {
  std::string heading = step.name;
  if (step.kind != step.name) heading += " (" + step.kind + ")";
  if (!step.status.empty()) heading += ": " + step.status;
  if (!step.time.empty()) heading += ", " + step.time;
  if (step.status != "done" && !step.reason.empty()) heading += ", " + step.reason;
  lines.push_back(heading);
  append(lines, detail::fact_lines(step.facts), "  ");
  for (const auto& table : step.tables) {
    if (!table.in_summary) continue;
    if (table.header.size() == 2) {  // label and value: running text saves lines
      std::vector<detail::Fact> facts;
      for (const auto& row : table.rows) facts.emplace_back(row.at(0), row.at(1));
      append(lines, detail::fact_lines(facts), "  ");
      continue;
    }
    detail::Table named = table;
    if (!named.header.empty()) named.header[0] = table.title;
    append(lines, detail::table_lines(named, rows), "  ");
  }
}

/// The story with at most `rows` rows in each table.
Lines compose(const detail::Story& story, std::size_t rows) {
  Lines lines{fmt::format("{}: {}", story.title, story.status)};
  if (story.status != "done" && !story.reason.empty()) lines.push_back("  " + story.reason);
  append(lines, detail::fact_lines(story.model), "  ");
  for (const auto& step : story.steps) append_step(lines, step, rows);
  if (!story.headline.empty()) {
    lines.emplace_back("in short");
    append(lines, detail::fact_lines(story.headline), "  ");
  }
  return lines;
}

}  // namespace

std::string summary_text(const nlohmann::ordered_json& results) {
  const auto story = detail::tell(results);
  Lines lines;
  for (std::size_t rows = 16; rows >= 2; rows -= 2) {
    lines = compose(story, rows);
    if (lines.size() <= most_lines) break;
  }
  if (lines.size() > most_lines) {
    lines.resize(most_lines - 1);
    lines.emplace_back("... the rest is in report.html");
  }
  std::string text;
  for (const auto& line : lines) text += line + "\n";
  return text;
}

}  // namespace tautline::output
