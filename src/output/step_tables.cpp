#include "output/detail/step_tables.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tautline::output::detail {

namespace {

using Json = nlohmann::ordered_json;
using Entries = std::vector<const Json*>;

/// A member of each entry.
struct Column {
  const char *name, *label;
  double scale = 1;
  bool joined = false;  ///< in one notation with the column before
};

bool any_has(const Entries& entries, const char* name) {
  return std::any_of(entries.begin(), entries.end(),
                     [&](const Json* entry) { return !member(*entry, name).is_null(); });
}

/// Fills in columns of figures behind the first one.
void add_columns(Table& table, const Entries& entries, std::span<const Column> columns) {
  std::vector<Column> present;
  for (const auto& column : columns)
    if (any_has(entries, column.name)) present.push_back(column);
  for (std::size_t first = 0, next = 0; first < present.size(); first = next) {
    for (next = first + 1; next < present.size() && present[next].joined;) ++next;
    std::vector<Figure> values;
    for (std::size_t k = first; k < next; ++k)
      for (const Json* entry : entries) values.push_back(number(member(*entry, present[k].name)));
    const auto figures = show_column(values, present[first].scale);
    for (std::size_t k = first; k < next; ++k) {
      table.header.emplace_back(present[k].label);
      for (std::size_t i = 0; i < entries.size(); ++i)
        table.rows[i].push_back(figures[(k - first) * entries.size() + i]);
    }
  }
}

/// Entries of a list, numbered from `first`.
Table numbered_table(const char* title, const char* what, const Json& list, std::size_t first,
                     std::span<const Column> columns) {
  Table table{title, {what}, {}};
  if (!list.is_array()) return table;
  Entries entries;
  for (const auto& entry : list) {
    table.rows.push_back({fmt::format("{}", first + entries.size())});
    entries.push_back(&entry);
  }
  add_columns(table, entries, columns);
  return table;
}

/// The groups that have `key`.
void add_group_table(std::vector<Table>& tables, const Json& groups, const char* title, const char* key,
                     std::span<const Column> columns) {
  Table table{title, {"group"}, {}};
  Entries entries;
  for (const auto& [name, group] : groups.items()) {
    if (member(group, key).is_null()) continue;
    table.rows.push_back({name});
    entries.push_back(&group);
  }
  if (entries.empty()) return;
  add_columns(table, entries, columns);
  tables.push_back(std::move(table));
}

/// Adds the entries of `list` as a column, as many as the table has rows.
void add_list(Table& table, const char* label, const Json& list, int digits, bool same_notation = true) {
  if (!list.is_array()) return;
  std::vector<Figure> values;
  for (std::size_t i = 0; i < table.rows.size(); ++i) values.push_back(number(entry(list, i)));
  const auto column = show_column(values, 1, digits);
  table.header.emplace_back(label);
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    table.rows[i].push_back(same_notation ? column[i] : show(values[i], "", 1, digits));
}

/// A table of `count` rows numbered from `first`.
Table numbered_rows(const char* title, const char* what, const Json& list, std::size_t first) {
  return numbered_table(title, what, list, first, {});
}

/// One component of each entry of a list of lists.
Json component(const Json& list, std::size_t index) {
  Json values = Json::array();
  if (list.is_array())
    for (const auto& row : list) values.push_back(entry(row, index));
  return values;
}

}  // namespace

std::vector<Table> group_tables(const Json& groups) {
  std::vector<Table> tables;
  if (!groups.is_object()) return tables;
  static constexpr Column cables[] = {{"count", "count"},
                                      {"tension_min", "least"},
                                      {"tension_mean", "mean", 1, true},
                                      {"tension_max", "largest", 1, true},
                                      {"tension_rms_from_target", "RMS from target"},
                                      {"slack", "slack"},
                                      {"rounding", "rounding"}};
  static constexpr Column beams[] = {{"count", "count"},
                                     {"axial_min", "least axial"},
                                     {"axial_max", "largest axial", 1, true},
                                     {"moment_max", "largest moment"},
                                     {"rounding", "rounding"}};
  static constexpr Column membranes[] = {{"count", "count"},
                                         {"principal_min", "least"},
                                         {"principal_max", "largest", 1, true},
                                         {"rounding", "rounding"}};
  add_group_table(tables, groups, "Cables, tension [N]", "tension_max", cables);
  static constexpr Column shells[] = {{"count", "count"},
                                      {"principal_min", "least"},
                                      {"principal_max", "largest", 1, true},
                                      {"moment_max", "largest moment [N]"},
                                      {"rounding", "rounding"}};
  static constexpr Column springs[] = {{"count", "count"},
                                       {"force_max", "largest force"},
                                       {"moment_max", "largest moment"},
                                       {"rounding", "rounding"}};
  const auto those = [&](const char* key, const char* but) {
    Json result = Json::object();
    for (const auto& [name, group] : groups.items())
      if (!member(group, key).is_null() && member(group, but).is_null()) result[name] = group;
    return result;
  };
  add_group_table(tables, those("axial_max", "tension_max"), "Beams, forces [N, N m]", "axial_max", beams);
  add_group_table(tables, those("principal_max", "moment_max"), "Membranes, principal [N/m]", "principal_max",
                  membranes);
  Json bent = Json::object();
  for (const auto& [name, group] : groups.items())
    if (!member(group, "principal_max").is_null() && !member(group, "moment_max").is_null())
      bent[name] = group;
  add_group_table(tables, bent, "Shells, principal [N/m]", "principal_max", shells);
  add_group_table(tables, groups, "Springs, forces [N, N m]", "force_max", springs);
  return tables;
}

Table pass_table(const Json& passes) {
  static constexpr Column columns[] = {{"rms", "RMS [mm]", 1e3},
                                       {"rms_area_weighted", "by area [mm]", 1e3},
                                       {"rms_nodes", "net nodes [mm]", 1e3},
                                       {"max_change", "largest change [mm]", 1e3}};
  return numbered_table("Passes", "pass", passes, 0, columns);
}

Table stage_table(const Json& stages) {
  static constexpr Column columns[] = {{"newton_iterations", "Newton iterations"},
                                       {"lambda_steps", "load steps"},
                                       {"failed_attempts", "failed attempts"},
                                       {"negative_pivots", "negative pivots"},
                                       {"step0_out_of_balance", "out of balance at start [N]"}};
  Table table = numbered_table("Stages", "stage", stages, 1, columns);
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    if (const auto name = text(member(stages[i], "name")); !name.empty()) table.rows[i][0] = name;
  return table;
}

Table convergence_table(const Json& step) {
  const Json& residual = member(step, "constraint_residual");
  Table table = numbered_rows("Convergence", "iteration", residual, 0);
  if (table.rows.empty()) return table;
  add_list(table, "residual [N]", residual, 4);
  Json norm = member(step, "coordinate_norm");
  if (!norm.is_array()) return table;
  norm.insert(norm.begin(), Json());  // before the first iteration there are none
  const char* labels[] = {"|x| [m]", "|y| [m]", "|z| [m]"};
  for (std::size_t k = 0; k < 3; ++k) add_list(table, labels[k], component(norm, k), 9);
  return table;
}

Table mode_table(const Json& step, double mass) {
  Table table = numbered_rows("Modes", "mode", member(step, "frequencies"), 1);
  if (table.rows.empty()) return table;
  add_list(table, "frequency [Hz]", member(step, "frequencies"), 4, false);
  const Json& masses = member(step, "effective_mass");
  for (std::size_t k = 0; k < 3 && masses.is_array(); ++k) {
    table.header.push_back(fmt::format("mass along {} [{}]", "xyz"[k], mass > 0 ? "%" : "kg"));
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
      const Figure moved = number(entry(entry(masses, i), k));
      table.rows[i].push_back(moved ? fmt::format("{:.1f}", mass > 0 ? 100 * *moved / mass : *moved) : "-");
    }
  }
  add_list(table, "residual", member(step, "residuals"), 3);
  return table;
}

Table buckling_table(const Json& step) {
  Table table = numbered_rows("Buckling", "mode", member(step, "factors"), 1);
  if (table.rows.empty()) return table;
  add_list(table, "load factor", member(step, "factors"), 5);
  add_list(table, "critical load [N]", member(step, "critical_loads"), 4);
  add_list(table, "residual", member(step, "residuals"), 3);
  return table;
}

Table rod_table(const Json& step) {
  /// Figures of nodes 1 to m, with that of the root before them.
  const auto from_root = [&](const Json& root, const char* name, double factor = 1) {
    Json list = Json::array({root});
    for (const auto& value : member(step, name))
      list.push_back(value.is_number() ? Json(factor * value.get<double>()) : Json());
    return list;
  };
  Table table{"Nodes of the rod", {"node"}, {}};
  const Json& root = member(step, "root");
  if (root.is_null()) return table;
  const Json x = from_root(member(root, "X"), "X");
  for (std::size_t k = 0; k < x.size(); ++k) table.rows.push_back({fmt::format("{}", k)});
  add_list(table, "X [m]", x, 5);
  add_list(table, "Y [m]", from_root(member(root, "Y"), "Y"), 5);
  add_list(table, "theta [rad]", from_root(member(root, "theta"), "theta"), 4);
  add_list(table, "moment [N m]", member(member(step, "moments"), "II"), 5);
  add_list(table, "cable pulls [N]", from_root(Json(), "reaction"), 5);
  add_list(table, "strain [%]", from_root(Json(), "strain", 100), 4);
  add_list(table, "E F [N]", from_root(Json(), "stiffness"), 5);
  return table;
}

Table space_rods_table(const Json& rods) {
  Table table = numbered_rows("Nodes of the rods in space", "node", member(rods, "X"), 1);
  if (table.rows.empty()) return table;
  add_list(table, "X [m]", member(rods, "X"), 5);
  add_list(table, "Y [m]", member(rods, "Y"), 5);
  add_list(table, "theta [rad]", member(rods, "theta"), 4);
  add_list(table, "cable pulls [N]", member(rods, "reaction"), 5);
  add_list(table, "strain [-]", member(rods, "strain"), 4);
  add_list(table, "E F [N]", member(rods, "stiffness"), 5);
  return table;
}

Table unknown_table(const Json& unknowns) {
  static constexpr Column columns[] = {{"cables", "cables"},
                                       {"start", "start [m or N]"},
                                       {"found", "found", 1, true},
                                       {"tension_min", "least tension [N]"},
                                       {"tension_max", "largest", 1, true}};
  constexpr std::size_t most = 40;
  Table table{"Cables found", {"unknown"}, {}};
  if (unknowns.size() > most) return table;
  table = numbered_table("Cables found", "unknown", unknowns, 1, columns);
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    table.rows[i][0] = fmt::format("{}, {}", text(member(unknowns[i], "name")),
                                   words(text(member(unknowns[i], "quantity"))));
  return table;
}

Table target_table(const Json& targets) {
  static constexpr Column columns[] = {
      {"nodes", "nodes"}, {"miss_max", "largest miss [mm]", 1e3}, {"miss_rms", "RMS [mm]", 1e3}};
  Table table = numbered_table("Targets", "target", targets, 1, columns);
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    table.rows[i][0] = fmt::format("{} {}", i + 1, text(member(targets[i], "quantity")));
  return table;
}

Table path_table(const Json& path) {
  static constexpr Column columns[] = {{"lambda", "load factor"}, {"monitor", "monitor [m]"}};
  return numbered_table("Load path", "point", path, 0, columns);
}

}  // namespace tautline::output::detail
