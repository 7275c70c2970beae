#include "steps/study_report.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>

#include <fmt/format.h>

#include <tautline/output/pictures.hpp>
#include <tautline/output/tables.hpp>

namespace tautline::steps {

namespace {

std::string parameter(const Json& row, const std::string& name) {
  return row["parameters"][name].get<std::string>();
}

/// A reported number of a row; null if its run failed.
Json value_of(const Json& row, const StudyQuantity& quantity) {
  return row["values"].value(quantity.label, Json());
}

std::string figure(const Json& value) {
  return value.is_number() ? fmt::format("{:.5g}", value.get<double>()) : "-";
}

/// As a number, if the whole text is one.
std::optional<double> number(const std::string& text) {
  try {
    std::size_t used = 0;
    const double value = std::stod(text, &used);
    if (used == text.size()) return value;
  } catch (const std::exception&) {
  }
  return std::nullopt;
}

/// "struts=15, tension=5": the parameters beside the first.
std::string label_of(const ParameterStudy& study, const Json& row) {
  std::string label;
  for (std::size_t i = 1; i < study.over.size(); ++i)
    label +=
        fmt::format("{}{}={}", i > 1 ? ", " : "", study.over[i].name, parameter(row, study.over[i].name));
  return label;
}

/// Curves of `y` against what `abscissa` gives, one for each combination of the parameters beside the first.
template <class Abscissa>
std::vector<output::Curve> curves_of(const ParameterStudy& study, const Json& rows, const StudyQuantity& y,
                                     const Abscissa& abscissa) {
  std::vector<output::Curve> curves;
  for (const auto& row : rows) {
    const Json value = value_of(row, y);
    const std::optional<double> x = abscissa(row);
    if (!value.is_number() || !x) continue;
    const std::string label = study.over.size() > 1 ? label_of(study, row) : y.label;
    auto curve =
        std::find_if(curves.begin(), curves.end(), [&](const output::Curve& c) { return c.label == label; });
    if (curve == curves.end()) curve = curves.insert(curve, output::Curve{label, {}, {}, true, true});
    curve->x.push_back(*x);
    curve->y.push_back(value.get<double>());
  }
  return curves;
}

std::string file_part(std::string label) {
  for (char& c : label)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return label;
}

/// A path alone is too long for a heading: its last two names.
std::string short_label(const std::string& label) {
  const auto last = label.rfind('/');
  if (last == std::string::npos || last == 0) return label;
  const auto before = label.rfind('/', last - 1);
  return label.substr(before == std::string::npos ? 0 : before + 1);
}

}  // namespace

std::string study_text(const ParameterStudy& study, const Json& rows) {
  std::vector<std::vector<std::string>> table(1);
  for (const auto& range : study.over) table[0].push_back(range.name);
  for (const auto& quantity : study.quantities) table[0].push_back(short_label(quantity.label));
  for (const auto& row : rows) {
    table.emplace_back();
    for (const auto& range : study.over) table.back().push_back(parameter(row, range.name));
    for (const auto& quantity : study.quantities) table.back().push_back(figure(value_of(row, quantity)));
  }
  std::string text;
  for (std::size_t i = 0; i < table.size(); ++i) {
    for (std::size_t k = 0; k < table[i].size(); ++k) {
      std::size_t width = 0;
      for (const auto& line : table) width = std::max(width, line[k].size());
      text += fmt::format("{}{:>{}}", k > 0 ? "  " : "", table[i][k], width);
    }
    const std::string message = i > 0 ? rows[i - 1].value("message", "") : "";
    text += (message.empty() ? "" : "  " + message.substr(0, message.find('\n'))) + "\n";
  }
  return text;
}

std::string study_csv(const ParameterStudy& study, const Json& rows) {
  std::string text;
  for (const auto& range : study.over) text += output::csv_cell(range.name) + ",";
  for (const auto& quantity : study.quantities) text += output::csv_cell(quantity.label) + ",";
  text += "status,directory\n";
  for (const auto& row : rows) {
    for (const auto& range : study.over) text += output::csv_cell(parameter(row, range.name)) + ",";
    for (const auto& quantity : study.quantities) {
      const Json value = value_of(row, quantity);
      text += (value.is_number() ? fmt::format("{:.17g}", value.get<double>()) : "") + ",";
    }
    text += fmt::format("{},{}\n", row["status"].get<std::string>(),
                        output::csv_cell(row["directory"].get<std::string>()));
  }
  return text;
}

void draw_study(const ParameterStudy& study, const Json& rows, output::RunDirectory& files,
                Progress& progress) {
  const auto draw = [&](const std::string& title, const std::string& x, const StudyQuantity& y,
                        const std::string& file, const auto& abscissa) {
    output::Chart chart{title, x, short_label(y.label), curves_of(study, rows, y, abscissa)};
    if (chart.curves.empty()) return;
    output::draw(chart, files.path(fmt::format("study_{}.png", file)));
  };
  try {
    const std::string& first = study.over.front().name;
    for (const auto& quantity : study.quantities)
      draw(fmt::format("{} against {}", short_label(quantity.label), first), first, quantity,
           file_part(short_label(quantity.label)),
           [&](const Json& row) { return number(parameter(row, first)); });
    if (study.quantities.size() < 2) return;
    const auto &y = study.quantities[0], &x = study.quantities[1];
    draw(fmt::format("{} against {}", short_label(y.label), short_label(x.label)), short_label(x.label), y,
         "trade", [&](const Json& row) -> std::optional<double> {
           const Json value = value_of(row, x);
           return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
         });
  } catch (const LibraryError& error) {
    progress.say(fmt::format("warning: no picture: {}", error.what()));
  }
}

}  // namespace tautline::steps
