#include "thesis_page.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "page.hpp"

namespace verify {

namespace {

constexpr const char *met = "met", *not_met = "**not met**", *explained = "explained";

/// From bad to good: how an item stands follows from its worst row.
constexpr const char* ranking[] = {not_met, explained, "shown only", met};

std::string picture(const std::string& file, const std::string& caption) {
  return fmt::format("\n![{}](thesis/{}.png)\n\n*{}*\n", caption, file, caption);
}

std::string pictures(const Item& item) {
  std::string text;
  for (const auto& chart : item.charts)
    text += picture(chart.file, chart.caption.empty() ? chart.title : chart.caption);
  for (const auto& view : item.views)
    text += picture(view.file, view.caption.empty() ? view.title : view.caption);
  for (const auto& p : item.pictures) text += picture(p.file, p.caption);
  return text;
}

/// Notes of a table, each once.
class Notes {
 public:
  /// The mark of a note, or "" if there is none.
  std::string mark(const std::string& note) {
    if (note.empty()) return {};
    auto found = std::find(notes_.begin(), notes_.end(), note);
    if (found == notes_.end()) found = notes_.insert(found, note);
    return fmt::format(" <sup>{}</sup>", found - notes_.begin() + 1);
  }

  std::string text() const {
    std::string all;
    for (std::size_t i = 0; i < notes_.size(); ++i)
      all += fmt::format("{}{}. {}\n", i == 0 ? "\n" : "", i + 1, notes_[i]);
    return all;
  }

 private:
  std::vector<std::string> notes_;
};

const char* word(Origin origin) {
  switch (origin) {
    case Origin::published:
      return "thesis";
    case Origin::analytic:
      return "formula";
    case Origin::invariant:
      return "invariant";
    case Origin::other_code:
      return "other code";
    case Origin::requirement:
      return "own aim";
    case Origin::regression:
      break;
  }
  return "earlier run";
}

/// What is far away is told as a multiple.
std::string deviation(const Result& r) {
  const double ratio = r.reference == 0 ? 0 : r.ours / r.reference;
  return r.quantity.check == Check::report_only && ratio > 3 ? fmt::format("{:.3g} times", ratio)
                                                             : difference_text(r);
}

std::string table(const std::vector<Result>& results) {
  std::string text = "\n| | beside | from | ours | deviation | status |\n|---|---|---|---|---|---|\n";
  Notes notes;
  for (const auto& r : results)
    text +=
        fmt::format("| {}{} | {} | {} | {} | {} | {} |\n", with_unit(r.quantity), notes.mark(r.quantity.note),
                    reference_text(r), word(r.quantity.origin), number_text(r.ours), deviation(r), status(r));
  return text + notes.text();
}

/// A number of a table with four digits; other text as it is.
std::string cell_text(const std::string& cell) {
  if (cell.empty()) return "-";
  char* end = nullptr;
  const double value = std::strtod(cell.c_str(), &end);
  return *end == '\0' ? fmt::format("{:.4g}", value) : cell;
}

/// Columns "name=heading" of a study's table.
std::string study_table(const StudyTable& item, const Table& table) {
  std::string head, line, text;
  std::vector<std::size_t> places;
  for (const auto& column : item.columns) {
    const auto equals = column.rfind('=');
    places.push_back(table.columns.at(column.substr(0, equals)));
    head += fmt::format("| {} ", column.substr(equals + 1));
    line += "|---";
  }
  for (const auto& row : table.rows) {
    for (const auto place : places)
      text += fmt::format("| {} ", cell_text(place < row.size() ? row[place] : ""));
    text += "|\n";
  }
  return fmt::format("\n{}|\n{}|\n{}", head, line, text);
}

std::string anchor(const std::string& heading) {
  std::string result;
  for (const char c : heading) {
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '-')
      result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (c == ' ')
      result += '-';
  }
  return result;
}

std::string heading(const Item& item) {
  return item.covers.empty() ? item.label : fmt::format("{}: {}", item.label, item.about);
}

std::string item_text(const Item& item, const std::vector<Result>& results, DataByRun& data) {
  std::string text = fmt::format("\n### {}\n", heading(item));
  if (item.covers.empty() && !item.about.empty()) text += "\n" + item.about + "\n";
  if (!item.text.empty()) text += "\n" + item.text + "\n";
  if (!item.status.empty()) text += fmt::format("\nStatus: {}.\n", item.status);
  if (!results.empty()) text += table(results);
  for (const auto& t : item.tables) text += study_table(t, data.at(t.run).table("study.csv"));
  return text + pictures(item);
}

std::string count_text(const std::vector<std::vector<Result>>& results) {
  std::string text;
  for (const char* name : {met, explained, "shown only", not_met}) {
    long count = 0;
    for (const auto& rows : results)
      count += std::count_if(rows.begin(), rows.end(), [&](const Result& r) { return status(r) == name; });
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, name);
  }
  return text;
}

std::string effort_text(const Effort& effort, const std::vector<std::vector<Result>>& results) {
  std::size_t n = 0;
  for (const auto& rows : results) n += rows.size();
  const std::string time =
      effort.seconds == 0
          ? std::string("from results that were there")
          : fmt::format("{:.1f} minutes from start to end, pictures included, on a machine of {} cores",
                        effort.seconds / 60, effort.cores);
  return fmt::format(
      "\nMade by one command, `verification/thesis/run`: {} runs of the program, {}. {} numbers: {}.\n",
      effort.runs, time, n, count_text(results));
}

}  // namespace

std::string status(const Result& r) {
  if (!r.passed) return r.problem.empty() ? not_met : fmt::format("{}: {}", not_met, r.problem);
  if (r.quantity.check != Check::report_only) return met;
  const bool elsewhere = r.quantity.origin == Origin::published || r.quantity.origin == Origin::other_code;
  return elsewhere ? explained : "shown only";
}

std::string status(const Item& item, const std::vector<Result>& results) {
  if (!item.status.empty()) return item.status.substr(0, item.status.find(':'));
  for (const char* name : ranking)
    if (std::any_of(results.begin(), results.end(),
                    [&](const Result& r) { return status(r).rfind(name, 0) == 0; }))
      return name;
  return "";
}

std::string thesis_page(const Thesis& thesis, const std::vector<std::vector<Result>>& results,
                        DataByRun& data, const Effort& effort) {
  std::string page =
      "<!-- Made by verification/thesis/run from verification/thesis/thesis.yaml; do not edit. -->\n\n";
  page += thesis.introduction;
  page += effort_text(effort, results);
  page += "\n| of the thesis | what | status |\n|---|---|---|\n";
  std::size_t at = 0;
  for (const auto& chapter : thesis.chapters)
    for (const auto& item : chapter.items) {
      const auto& rows = results[at++];
      if (!chapter.answers)
        page += fmt::format("| [{}](#{}) | {} | {} |\n", item.label, anchor(heading(item)), item.about,
                            status(item, rows));
    }
  at = 0;
  for (const auto& chapter : thesis.chapters) {
    page += fmt::format("\n## {}\n", chapter.title);
    if (!chapter.text.empty()) page += "\n" + chapter.text + "\n";
    for (const auto& item : chapter.items) page += item_text(item, results[at++], data);
  }
  return page;
}

}  // namespace verify
