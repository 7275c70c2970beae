#include "data.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include <tautline/output/pointer.hpp>

namespace verify {

namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

Table read_table(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + " cannot be read");
  Table table;
  std::string line;
  while (std::getline(file, line)) {
    if (line.empty() || line[0] == '#') continue;
    const auto cells = split(line, ',');
    if (table.columns.empty())
      for (std::size_t i = 0; i < cells.size(); ++i) table.columns[cells[i]] = i;
    else
      table.rows.push_back(cells);
  }
  return table;
}

double number(const Table& table, const std::vector<std::string>& row, const std::string& column) {
  const auto found = table.columns.find(column);
  if (found == table.columns.end())
    throw std::runtime_error(fmt::format("there is no column \"{}\"", column));
  return std::stod(row.at(found->second));
}

/// Whether a row fulfils "column=text", "column<=number" or "column>=number".
bool fulfils(const Table& table, const std::vector<std::string>& row, const std::string& condition) {
  if (const auto at = condition.find("<="); at != std::string::npos)
    return number(table, row, condition.substr(0, at)) <= std::stod(condition.substr(at + 2));
  if (const auto at = condition.find(">="); at != std::string::npos)
    return number(table, row, condition.substr(0, at)) >= std::stod(condition.substr(at + 2));
  const auto at = condition.find('=');
  const auto column = table.columns.find(condition.substr(0, at));
  if (at == std::string::npos || column == table.columns.end())
    throw std::runtime_error(fmt::format("condition \"{}\" means nothing", condition));
  return row.at(column->second) == condition.substr(at + 1);
}

}  // namespace

Values Data::find(const std::string& reference) {
  try {
    return reference.rfind('/', 0) == 0 ? pointer(reference) : column(reference);
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("{} in {}: {}", reference, directory_, error.what()));
  }
}

Values Data::pointer(const std::string& path) {
  if (results_.is_null()) {
    std::ifstream file(directory_ + "/results.json");
    if (!file) throw std::runtime_error("results.json cannot be read");
    results_ = nlohmann::ordered_json::parse(file);
  }
  return tautline::output::numbers_at(results_, path);
}

Values Data::column(const std::string& reference) {
  const auto hash = reference.find('#'), question = reference.find('?');
  if (hash == std::string::npos) throw std::runtime_error("is neither a pointer nor a column");
  const Table& from = table(reference.substr(0, hash));
  const std::string name =
      reference.substr(hash + 1, question == std::string::npos ? question : question - hash - 1);
  std::vector<std::string> conditions;
  std::vector<bool> inside(from.rows.size(), true);
  if (question != std::string::npos)
    for (const auto& condition : split(reference.substr(question + 1), '&')) {
      if (condition.rfind("within=", 0) == 0)
        inside = within(from, std::stod(condition.substr(7)));
      else
        conditions.push_back(condition);
    }
  Values values;
  for (std::size_t i = 0; i < from.rows.size(); ++i) {
    const auto& row = from.rows[i];
    if (inside[i] && std::all_of(conditions.begin(), conditions.end(),
                                 [&](const auto& c) { return fulfils(from, row, c); }))
      values.push_back(number(from, row, name));
  }
  return values;
}

const Table& Data::table(const std::string& file) {
  const auto found = tables_.find(file);
  if (found != tables_.end()) return found->second;
  return tables_[file] = read_table(directory_ + "/" + file);
}

std::vector<bool> Data::within(const Table& from, double radius) {
  const Table& nodes = table("nodes.csv");
  std::map<int, double> distance;
  for (const auto& row : nodes.rows)
    distance[static_cast<int>(number(nodes, row, "id"))] =
        std::hypot(number(nodes, row, "x"), number(nodes, row, "y"));
  std::vector<bool> inside;
  const bool elements = from.columns.count("node_1") > 0;
  for (const auto& row : from.rows) {
    double farthest = 0;
    for (const char* end : elements ? std::vector{"node_1", "node_2"} : std::vector{"id"})
      farthest = std::max(farthest, distance.at(static_cast<int>(number(from, row, end))));
    inside.push_back(farthest <= radius);
  }
  return inside;
}

}  // namespace verify
