#include "thesis_items.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <regex>
#include <stdexcept>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

namespace verify {

namespace {

std::vector<std::string> read_list(const YAML::Node& node) {
  std::vector<std::string> list;
  if (node && node.IsScalar()) list.push_back(node.as<std::string>());
  if (node && node.IsSequence())
    for (const auto& entry : node) list.push_back(entry.as<std::string>());
  return list;
}

bool read_flag(const YAML::Node& node, const char* key, bool otherwise) {
  return node[key] ? node[key].as<bool>() : otherwise;
}

ChartItem read_chart(const YAML::Node& node) {
  know_keys(node, {"file", "caption", "title", "x", "y", "log_x", "log_y", "curves"});
  ChartItem chart{read_text(node, "file", true),   read_text(node, "caption"),
                  read_text(node, "title", true),  read_text(node, "x", true),
                  read_text(node, "y", true),      read_flag(node, "log_x", false),
                  read_flag(node, "log_y", false), {}};
  for (const auto& entry : node["curves"]) {
    know_keys(entry, {"label", "x", "y", "first", "sorted", "line"});
    chart.curves.push_back({read_text(entry, "label", true), read_list(entry["x"]), read_list(entry["y"]),
                            entry["first"] ? entry["first"].as<double>() : 0,
                            read_flag(entry, "sorted", false), read_flag(entry, "line", true)});
  }
  return chart;
}

ViewItem read_view(const YAML::Node& node) {
  static const std::map<std::string, Colour> colours{{"tension", Colour::tension},
                                                     {"compression", Colour::compression},
                                                     {"displacement", Colour::displacement}};
  know_keys(node, {"file", "caption", "title", "run", "colour", "groups", "plain", "range", "direction"});
  ViewItem view;
  view.file = read_text(node, "file", true);
  view.caption = read_text(node, "caption");
  view.title = read_text(node, "title", true);
  view.run = read_text(node, "run", true);
  const auto colour = colours.find(read_text(node, "colour", true));
  if (colour == colours.end()) throw std::runtime_error(view.file + ": unknown colour");
  view.colour = colour->second;
  view.groups = read_list(node["groups"]);
  view.plain = read_list(node["plain"]);
  if (node["range"]) view.range = node["range"].as<std::array<double, 2>>();
  if (node["direction"]) view.direction = node["direction"].as<std::array<double, 3>>();
  return view;
}

const Quantity& quantity_of(const Thesis& thesis, const std::string& case_name, const std::string& name) {
  for (const auto& c : thesis.cases)
    if (c.name == case_name)
      for (const auto& q : c.quantities)
        if (q.name == name) return q;
  throw std::runtime_error(fmt::format("the case {} has no quantity \"{}\"", case_name, name));
}

Row read_row(const YAML::Node& node, const Thesis& thesis) {
  if (!node["case"]) return {thesis.own.name, read_quantity(node)};
  know_keys(node, {"case", "quantity"});
  const auto name = read_text(node, "case");
  return {name, quantity_of(thesis, name, read_text(node, "quantity", true))};
}

/// Where rows come from several cases, their names begin with the case's.
void tell_apart(Item& item, const std::map<std::string, std::string>& short_names) {
  std::set<std::string> names;
  for (const auto& row : item.rows)
    if (const auto found = short_names.find(row.case_name); found != short_names.end())
      names.insert(found->second);
  if (names.size() < 2) return;
  for (auto& row : item.rows)
    if (const auto found = short_names.find(row.case_name); found != short_names.end())
      row.quantity.name = fmt::format("{}: {}", found->second, row.quantity.name);
}

Item read_item(const YAML::Node& node, const Thesis& thesis) {
  know_keys(node,
            {"item", "covers", "about", "text", "status", "rows", "charts", "views", "pictures", "tables"});
  Item item;
  item.label = read_text(node, "item", true);
  for (const auto& label : read_list(node["covers"])) item.covers.insert(label);
  item.about = read_text(node, "about", true);
  item.text = read_text(node, "text");
  item.status = read_text(node, "status");
  for (const auto& entry : node["rows"]) item.rows.push_back(read_row(entry, thesis));
  tell_apart(item, thesis.short_names);
  for (const auto& entry : node["charts"]) item.charts.push_back(read_chart(entry));
  for (const auto& entry : node["views"]) item.views.push_back(read_view(entry));
  for (const auto& entry : node["pictures"]) {
    know_keys(entry, {"file", "caption", "run", "picture"});
    item.pictures.push_back({read_text(entry, "file", true), read_text(entry, "caption"),
                             read_text(entry, "run", true), read_text(entry, "picture", true)});
  }
  for (const auto& entry : node["tables"]) {
    know_keys(entry, {"run", "columns"});
    item.tables.push_back({read_text(entry, "run", true), read_list(entry["columns"])});
  }
  return item;
}

Chapter read_chapter(const YAML::Node& node, const Thesis& thesis) {
  know_keys(node, {"title", "text", "answers", "items"});
  Chapter chapter{
      read_text(node, "title", true), read_text(node, "text"), read_flag(node, "answers", false), {}};
  for (const auto& entry : node["items"]) chapter.items.push_back(read_item(entry, thesis));
  return chapter;
}

void for_each_item(const Thesis& thesis, const std::function<void(const Chapter&, const Item&)>& action) {
  for (const auto& chapter : thesis.chapters)
    for (const auto& item : chapter.items) action(chapter, item);
}

/// Figures 3.22 to 3.41 and 4.2 to 4.25, tables 4.1 to 4.3: what the two reflectors of 12 m gave.
std::vector<std::string> published_items() {
  std::vector<std::string> labels;
  for (int i = 22; i <= 41; ++i) labels.push_back(fmt::format("3.{}", i));
  for (int i = 2; i <= 25; ++i) labels.push_back(fmt::format("4.{}", i));
  for (int i = 1; i <= 3; ++i) labels.push_back(fmt::format("table 4.{}", i));
  return labels;
}

/// The names in front of the colons of {name:reference}, as this page calls those runs.
std::vector<std::string> runs_in(const std::string& expression, const std::string& case_name) {
  static const std::regex pattern("\\{([^:{}]+):");
  std::vector<std::string> names;
  for (std::sregex_iterator i(expression.begin(), expression.end(), pattern), end; i != end; ++i)
    if ((*i)[1] != "case")
      names.push_back(case_name.empty() ? (*i)[1].str() : case_name + "." + (*i)[1].str());
  return names;
}

std::vector<std::string> runs_of(const Item& item, const Thesis& thesis) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& expression, const std::string& case_name = "") {
    for (const auto& name : runs_in(expression, case_name)) names.push_back(name);
  };
  for (const auto& row : item.rows) {
    const std::string prefix = row.case_name == thesis.own.name ? "" : row.case_name;
    add(row.quantity.value, prefix);
    add(row.quantity.reference, prefix);
  }
  for (const auto& chart : item.charts)
    for (const auto& curve : chart.curves) {
      for (const auto& expression : curve.x) add(expression);
      for (const auto& expression : curve.y) add(expression);
    }
  for (const auto& view : item.views) names.push_back(view.run);
  for (const auto& picture : item.pictures) names.push_back(picture.run);
  for (const auto& table : item.tables) names.push_back(table.run);
  return names;
}

}  // namespace

Thesis read_thesis(const std::string& source) {
  const std::string directory = source + "/verification/thesis";
  Thesis thesis;
  thesis.own.name = "thesis";
  thesis.own.directory = directory;
  try {
    const auto root = YAML::LoadFile(directory + "/thesis.yaml");
    know_keys(root, {"introduction", "runs", "cases", "chapters"});
    thesis.introduction = read_text(root, "introduction", true);
    for (const auto& node : root["runs"]) thesis.own.runs.push_back(read_run(node));
    for (const auto& entry : root["cases"]) {
      const auto name = entry.first.as<std::string>();
      thesis.cases.push_back(read_case(source + "/verification/" + name));
      thesis.short_names[name] = entry.second.as<std::string>();
    }
    for (const auto& node : root["chapters"]) thesis.chapters.push_back(read_chapter(node, thesis));
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("{}/thesis.yaml: {}", directory, error.what()));
  }
  return thesis;
}

RunOfCase find_run(const Thesis& thesis, const std::string& name) {
  const auto dot = name.find('.');
  const std::string case_name = dot == std::string::npos ? "" : name.substr(0, dot);
  const std::string run_name = dot == std::string::npos ? name : name.substr(dot + 1);
  const auto among = [&](const Case& c) -> const Run* {
    for (const auto& run : c.runs)
      if (run.name == run_name) return &run;
    return nullptr;
  };
  if (case_name.empty()) {
    if (const Run* run = among(thesis.own)) return {&thesis.own, *run};
  } else {
    for (const auto& c : thesis.cases)
      if (c.name == case_name)
        if (const Run* run = among(c)) return {&c, *run};
  }
  throw std::runtime_error(fmt::format("there is no run \"{}\"", name));
}

std::vector<std::string> needed_runs(const Thesis& thesis) {
  std::vector<std::string> names;
  for_each_item(thesis, [&](const Chapter&, const Item& item) {
    for (const auto& name : runs_of(item, thesis))
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  });
  return names;
}

std::vector<std::string> faults(const Thesis& thesis) {
  std::vector<std::string> found;
  std::set<std::string> covered, files;
  for_each_item(thesis, [&](const Chapter&, const Item& item) {
    covered.insert(item.covers.begin(), item.covers.end());
    if (item.rows.empty() && item.status.empty())
      found.push_back(item.label + ": rows or a status are needed");
    const auto file = [&](const std::string& name) {
      if (!files.insert(name).second) found.push_back(fmt::format("{}: two pictures {}", item.label, name));
    };
    for (const auto& chart : item.charts) file(chart.file);
    for (const auto& view : item.views) file(view.file);
    for (const auto& picture : item.pictures) file(picture.file);
    for (const auto& name : runs_of(item, thesis)) {
      try {
        find_run(thesis, name);
      } catch (const std::exception& error) {
        found.push_back(fmt::format("{}: {}", item.label, error.what()));
      }
    }
  });
  for (const auto& label : published_items())
    if (covered.count(label) == 0) found.push_back(fmt::format("no item covers {}", label));
  return found;
}

}  // namespace verify
