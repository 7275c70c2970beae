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
/// The figures of one cell, e.g. least, mean and largest.
using GetFigures = std::function<std::vector<Figure>(const Json&)>;

/// Adds the row unless every run lacks it.
void add_row(Table& table, const Runs& runs, const std::string& label, const Get& get) {
  Row row{label};
  bool any = false;
  for (const auto& run : runs) {
    const std::string value = get(run);
    any = any || !value.empty();
    row.push_back(value.empty() ? "-" : value);
  }
  if (any) table.rows.push_back(std::move(row));
}

/// The same with figures, all of the row in one notation.
void add_figures(Table& table, const Runs& runs, const std::string& label, const GetFigures& get,
                 double scale = 1, int digits = 4) {
  std::vector<Figure> all;
  std::vector<std::size_t> ends;
  bool any = false;
  for (const auto& run : runs) {
    for (const auto& figure : get(run)) {
      all.push_back(figure);
      any = any || figure;
    }
    ends.push_back(all.size());
  }
  if (!any) return;
  const auto shown = show_column(all, scale, digits);
  Row row{label};
  std::size_t k = 0;
  for (const std::size_t end : ends) {
    std::string cell;
    bool known = false;
    for (const std::size_t first = k; k < end; ++k) {
      cell += (k == first ? "" : " / ") + shown[k];
      known = known || all[k];
    }
    row.push_back(known ? cell : "-");
  }
  table.rows.push_back(std::move(row));
}

void add_figure(Table& table, const Runs& runs, const std::string& label,
                const std::function<const Json&(const Json&)>& get, double scale = 1, int digits = 4) {
  add_figures(
      table, runs, label, [&](const Json& run) { return std::vector{number(get(run))}; }, scale, digits);
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
    add_figure(
        table, runs, line.label,
        [&](const Json& run) -> const Json& { return member(last_of(run, "surface"), line.name); },
        line.scale);
}

void add_group_rows(Table& table, const Runs& runs) {
  std::vector<std::string> names;
  for (const auto& run : runs) {
    const Json& groups = last_of(run, "groups");
    if (!groups.is_object()) continue;
    for (const auto& [name, group] : groups.items())
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  const auto add = [&](const char* label, const std::vector<const char*>& members) {
    for (const auto& name : names)
      add_figures(table, runs, fmt::format(fmt::runtime(label), name), [&](const Json& run) {
        const Json& group = member(last_of(run, "groups"), name.c_str());
        std::vector<Figure> figures;
        for (const char* some : members) figures.push_back(number(member(group, some)));
        return figures;
      });
  };
  add("tension of {}: least / mean / largest [N]", {"tension_min", "tension_mean", "tension_max"});
  add("axial force of {}: least / largest [N]", {"axial_min", "axial_max"});
  add("moment of {}: largest [N m]", {"moment_max"});
}

void add_list_rows(Table& table, const Runs& runs, const char* name, const char* label, std::size_t most) {
  for (std::size_t k = 0; k < most; ++k)
    add_figure(table, runs, fmt::format(fmt::runtime(label), k + 1),
               [&](const Json& run) -> const Json& { return entry(last_of(run, name), k); });
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
    return [name](const Json& run) -> const Json& { return member(member(run, "model"), name); };
  };
  add_row(table, runs, "status", [](const Json& run) { return words(text(member(run, "status"))); });
  add_figure(table, runs, "degrees of freedom", of_model("dofs"));
  add_figure(table, runs, "mass [kg]", of_model("mass"));
  add_surface_rows(table, runs);
  add_group_rows(table, runs);
  add_figure(
      table, runs, "error along the rod, RMS [mm]",
      [](const Json& run) -> const Json& { return last_of(run, "rod_error_rms"); }, 1e3);
  add_list_rows(table, runs, "frequencies", "frequency {} [Hz]", 6);
  add_list_rows(table, runs, "factors", "buckling load factor {}", 3);
  add_figure(table, runs, "critical load factor",
             [](const Json& run) -> const Json& { return last_of(run, "critical_lambda"); });
  add_figure(
      table, runs, "time [s]", [](const Json& run) -> const Json& { return member(run, "wall_seconds"); }, 1,
      3);
  return table;
}

}  // namespace tautline::output::detail
