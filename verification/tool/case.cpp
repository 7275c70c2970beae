#include "case.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <stdexcept>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

namespace verify {

namespace {

const std::map<std::string, Origin> origins{{"analytic", Origin::analytic},
                                            {"invariant", Origin::invariant},
                                            {"published", Origin::published},
                                            {"other_code", Origin::other_code},
                                            {"regression", Origin::regression},
                                            {"requirement", Origin::requirement}};

Check read_check(const YAML::Node& node) {
  const int given = (node["relative"] || node["absolute"]) + bool(node["at_most"]) + bool(node["at_least"]) +
                    bool(node["report_only"]);
  if (given != 1)
    throw std::runtime_error(fmt::format(
        "line {}: one of relative or absolute (tolerance), at_most, at_least, report_only is needed",
        node.Mark().line + 1));
  if (node["at_most"]) return Check::at_most;
  if (node["at_least"]) return Check::at_least;
  return node["report_only"] ? Check::report_only : Check::equal;
}

}  // namespace

void know_keys(const YAML::Node& node, const std::set<std::string>& known) {
  for (const auto& pair : node)
    if (const auto key = pair.first.as<std::string>(); known.count(key) == 0)
      throw std::runtime_error(fmt::format("line {}: unknown key \"{}\"", pair.first.Mark().line + 1, key));
}

std::string read_text(const YAML::Node& node, const char* key, bool required) {
  if (node[key]) return node[key].as<std::string>();
  if (required)
    throw std::runtime_error(fmt::format("line {}: \"{}\" is missing", node.Mark().line + 1, key));
  return {};
}

Run read_run(const YAML::Node& node) {
  know_keys(node, {"name", "deck", "set", "ranks", "exit", "pictures", "study"});
  Run run{read_text(node, "name", true), read_text(node, "deck", true), {}, 1, 0, false};
  for (const auto& entry : node["set"]) run.overrides.push_back(entry.as<std::string>());
  if (node["ranks"]) run.ranks = node["ranks"].as<int>();
  if (node["exit"]) run.exit_code = node["exit"].as<int>();
  for (const auto& entry : node["study"]) run.study.push_back(entry.as<std::string>());
  if (node["pictures"]) run.pictures = node["pictures"].as<bool>();
  return run;
}

Quantity read_quantity(const YAML::Node& node) {
  know_keys(node, {"name", "value", "unit", "reference", "relative", "absolute", "at_most", "at_least",
                   "report_only", "origin", "source", "note"});
  Quantity q;
  q.name = read_text(node, "name", true);
  q.value = read_text(node, "value", true);
  q.unit = read_text(node, "unit");
  q.check = read_check(node);
  q.reference = q.check == Check::at_most    ? read_text(node, "at_most")
                : q.check == Check::at_least ? read_text(node, "at_least")
                                             : read_text(node, "reference", true);
  if (node["relative"]) q.relative = node["relative"].as<double>();
  if (node["absolute"]) q.absolute = node["absolute"].as<double>();
  const auto origin = origins.find(read_text(node, "origin", true));
  if (origin == origins.end()) throw std::runtime_error(fmt::format("{}: unknown origin", q.name));
  q.origin = origin->second;
  q.source = read_text(node, "source");
  q.note = read_text(node, "note");
  if (q.check == Check::report_only && q.note.empty())
    throw std::runtime_error(q.name + ": report_only needs a note that says why");
  if (q.origin == Origin::published && q.source.empty())
    throw std::runtime_error(q.name + ": a published number needs its source");
  return q;
}

Case read_case(const std::string& directory) {
  Case result;
  result.directory = directory;
  result.name = std::filesystem::path(directory).filename().string();
  try {
    const auto root = YAML::LoadFile(directory + "/expected.yaml");
    know_keys(root, {"runs", "quantities"});
    for (const auto& node : root["runs"]) result.runs.push_back(read_run(node));
    for (const auto& node : root["quantities"]) result.quantities.push_back(read_quantity(node));
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("{}/expected.yaml: {}", directory, error.what()));
  }
  return result;
}

std::string to_string(Origin origin) {
  const auto found =
      std::find_if(origins.begin(), origins.end(), [&](const auto& pair) { return pair.second == origin; });
  return found == origins.end() ? "" : found->first;
}

}  // namespace verify
