#include "output/detail/comparison.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tautline/output/results.hpp>
#include "output/detail/figures.hpp"

namespace tautline::output::detail {

namespace {

using Json = nlohmann::ordered_json;
using Runs = std::vector<Json>;
using Get = std::function<std::string(const Json&)>;

/// Adds the row unless every run lacks it.
void add_row(Table& table, const Runs& runs, const std::string& label, const Get& get) {
  Row row{label};
  bool any = false;
  for (const auto& run : runs) {
    const std::string value = get(run);
    any = any || (!value.empty() && value != "-");
    row.push_back(value.empty() ? "-" : value);
  }
  if (any) table.rows.push_back(std::move(row));
}

void add_surface_rows(Table& table, const Runs& runs) {
  struct Line {
    const char *name, *label;
    double scale;
  };
  for (const Line& line :
       {Line{"rms", "surface RMS about the mean [mm]", 1e3},
        Line{"rms_direct", "surface RMS without shift [mm]", 1e3},
        Line{"rms_best_fit", "surface RMS from best fit [mm]", 1e3},
        Line{"rms_area_weighted", "surface RMS by area [mm]", 1e3},
        Line{"rms_nodes", "surface RMS of net nodes [mm]", 1e3}, Line{"gain_loss_db", "gain loss [dB]", 1.0}})
    add_row(table, runs, line.label, [&](const Json& run) {
      return show(member(last_of(run, "surface"), line.name), "", line.scale);
    });
}

/// "least / mean / largest" of a group.
std::string tensions(const Json& group) {
  if (member(group, "tension_max").is_null()) return "";
  return fmt::format("{} / {} / {}", show(member(group, "tension_min"), "", 1, 3),
                     show(member(group, "tension_mean"), "", 1, 3),
                     show(member(group, "tension_max"), "", 1, 3));
}

std::string axial(const Json& group) {
  if (member(group, "axial_max").is_null()) return "";
  return fmt::format("{} / {}", show(member(group, "axial_min"), "", 1, 3),
                     show(member(group, "axial_max"), "", 1, 3));
}

void add_group_rows(Table& table, const Runs& runs) {
  std::vector<std::string> names;
  for (const auto& run : runs) {
    const Json& groups = last_of(run, "groups");
    if (!groups.is_object()) continue;
    for (const auto& [name, group] : groups.items())
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  const auto group_of = [](const Json& run, const std::string& name) -> const Json& {
    return member(last_of(run, "groups"), name.c_str());
  };
  for (const auto& name : names)
    add_row(table, runs, fmt::format("tension of {}: least / mean / largest [N]", name),
            [&](const Json& run) { return tensions(group_of(run, name)); });
  for (const auto& name : names)
    add_row(table, runs, fmt::format("axial force of {}: least / largest [N]", name),
            [&](const Json& run) { return axial(group_of(run, name)); });
}

void add_list_rows(Table& table, const Runs& runs, const char* name, const char* label, std::size_t most) {
  for (std::size_t k = 0; k < most; ++k)
    add_row(table, runs, fmt::format(fmt::runtime(label), k + 1), [&](const Json& run) {
      const Json& list = last_of(run, name);
      return list.is_array() && k < list.size() ? show(list[k], "", 1, 5) : std::string();
    });
}

/// Short names that tell the directories apart: the last part of the path, or all of it where two agree.
Row column_names(const std::vector<std::string>& directories) {
  std::map<std::string, int> count;
  const auto last = [](std::string path) {
    while (path.size() > 1 && path.back() == '/') path.pop_back();
    return path.substr(path.find_last_of('/') + 1);
  };
  for (const auto& directory : directories) ++count[last(directory)];
  Row names{""};
  for (const auto& directory : directories)
    names.push_back(count[last(directory)] == 1 ? last(directory) : directory);
  return names;
}

}  // namespace

Table comparison(const std::vector<std::string>& directories) {
  Runs runs;
  for (const auto& directory : directories) runs.push_back(read_results(directory + "/results.json"));
  Table table{"", column_names(directories), {}};
  const auto of_model = [](const char* name) {
    return [name](const Json& run) { return show(member(member(run, "model"), name)); };
  };
  add_row(table, runs, "status", [](const Json& run) { return words(text(member(run, "status"))); });
  add_row(table, runs, "degrees of freedom", of_model("dofs"));
  add_row(table, runs, "mass [kg]", of_model("mass"));
  add_surface_rows(table, runs);
  add_group_rows(table, runs);
  add_list_rows(table, runs, "frequencies", "frequency {} [Hz]", 6);
  add_list_rows(table, runs, "factors", "buckling load factor {}", 3);
  add_row(table, runs, "critical load factor",
          [](const Json& run) { return show(last_of(run, "critical_lambda")); });
  add_row(table, runs, "time [s]",
          [](const Json& run) { return show(member(run, "wall_seconds"), "", 1, 3); });
  return table;
}

}  // namespace tautline::output::detail
