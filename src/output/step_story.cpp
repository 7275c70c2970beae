#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "output/detail/figures.hpp"
#include "output/detail/story.hpp"

namespace tautline::output::detail {

namespace {

using Json = nlohmann::ordered_json;

/// How a figure of results.json is shown; those not listed are shown as they are.
struct Quantity {
  const char* name;
  const char* label;
  const char* unit;
  double scale = 1;
  int digits = 4;
};

constexpr std::array surface_quantities{
    Quantity{"rms", "RMS about the mean shift", "mm", 1e3},
    Quantity{"mean_shift", "mean shift", "mm", 1e3},
    Quantity{"rms_direct", "RMS without shift", "mm", 1e3},
    Quantity{"rms_best_fit", "RMS from the best-fit paraboloid", "mm", 1e3},
    Quantity{"best_fit_focal_length", "focal length of the best fit", "m", 1, 6},
    Quantity{"rms_area_weighted", "RMS weighted by area", "mm", 1e3},
    Quantity{"rms_area_weighted_direct", "RMS weighted by area, without shift", "mm", 1e3},
    Quantity{"rms_nodes", "RMS of the net nodes", "mm", 1e3},
    Quantity{"rms_half_path", "RMS half path-length error", "mm", 1e3},
    Quantity{"radius", "evaluated within radius", "m"},
    Quantity{"samples", "nodes evaluated", ""},
    Quantity{"frequency", "frequency", "GHz", 1e-9},
    Quantity{"gain_loss_db", "gain loss", "dB"},
    Quantity{"gain_loss_half_path_db", "gain loss from the half path-length error", "dB"}};

constexpr std::array step_quantities{Quantity{"out_of_balance", "largest nodal force out of balance", "N"},
                                     Quantity{"condition_number", "condition number", ""},
                                     Quantity{"critical_lambda", "critical load factor", "", 1, 5},
                                     Quantity{"bifurcation_lambda", "load factor of bifurcation", "", 1, 5}};

/// Members of a step that are told elsewhere: in the heading or in the table of times.
constexpr std::array told_elsewhere{"name",         "kind",    "status",         "reason",
                                    "wall_seconds", "timings", "factorisations", "peak_memory_bytes"};

template <std::size_t N>
const Quantity* find(const std::array<Quantity, N>& quantities, const std::string& name) {
  const auto found =
      std::find_if(quantities.begin(), quantities.end(), [&](const Quantity& q) { return name == q.name; });
  return found == quantities.end() ? nullptr : &*found;
}

template <std::size_t N>
std::vector<Fact> scalar_facts(const Json& object, const std::array<Quantity, N>& quantities) {
  std::vector<Fact> facts;
  if (!object.is_object()) return facts;
  for (const auto& [name, value] : object.items()) {
    if (value.is_structured() || value.is_null()) continue;
    if (std::find(told_elsewhere.begin(), told_elsewhere.end(), name) != told_elsewhere.end()) continue;
    const Quantity* q = find(quantities, name);
    if (q != nullptr)
      facts.emplace_back(q->label, show(value, q->unit, q->scale, q->digits));
    else
      facts.emplace_back(words(name), value.is_number() ? show(value) : text(value));
  }
  return facts;
}

const Json& entry(const Json& list, std::size_t index) {
  static const Json nothing;
  return list.is_array() && index < list.size() ? list[index] : nothing;
}

bool any_has(const Json& groups, const char* name) {
  return std::any_of(groups.begin(), groups.end(),
                     [&](const Json& group) { return !member(group, name).is_null(); });
}

/// One table for the groups that have `key`; columns that no group has are left out.
template <std::size_t N>
void add_group_table(Chapter& chapter, const Json& groups, const char* title, const char* key,
                     const std::array<Quantity, N>& columns) {
  if (!groups.is_object() || !any_has(groups, key)) return;
  Table table{title, {"group"}, {}};
  for (const auto& column : columns)
    if (any_has(groups, column.name)) table.header.emplace_back(column.label);
  for (const auto& [name, group] : groups.items()) {
    if (member(group, key).is_null()) continue;
    Row row{name};
    for (const auto& column : columns)
      if (any_has(groups, column.name)) row.push_back(show(member(group, column.name)));
    table.rows.push_back(std::move(row));
  }
  chapter.tables.push_back(std::move(table));
}

void add_groups(Chapter& chapter, const Json& groups) {
  add_group_table(
      chapter, groups, "Cables, tension [N]", "tension_max",
      std::array{Quantity{"count", "cables", ""}, Quantity{"tension_min", "least", ""},
                 Quantity{"tension_mean", "mean", ""}, Quantity{"tension_max", "largest", ""},
                 Quantity{"tension_rms_from_target", "RMS from target", ""}, Quantity{"slack", "slack", ""}});
  add_group_table(chapter, groups, "Beams", "axial_max",
                  std::array{Quantity{"count", "beams", ""}, Quantity{"axial_min", "least axial [N]", ""},
                             Quantity{"axial_max", "largest axial [N]", ""},
                             Quantity{"moment_max", "largest moment [N m]", ""}});
  add_group_table(chapter, groups, "Membranes, principal stress resultants [N/m]", "principal_max",
                  std::array{Quantity{"count", "triangles", ""}, Quantity{"principal_min", "least", ""},
                             Quantity{"principal_max", "largest", ""}});
}

void add_surface(Chapter& chapter, const Json& surface) {
  Table table{"Surface against the paraboloid", {"measure", "value"}, {}};
  for (const auto& [label, value] : scalar_facts(surface, surface_quantities))
    table.rows.push_back({label, value});
  if (!table.rows.empty()) chapter.tables.push_back(std::move(table));
}

void add_convergence(Chapter& chapter, const Json& step) {
  const Json &residual = member(step, "constraint_residual"), &norm = member(step, "coordinate_norm");
  if (!residual.is_array() || residual.empty()) return;
  Table table{"Convergence", {"iteration", "residual [N]", "|x| [m]", "|y| [m]", "|z| [m]"}, {}, false};
  for (std::size_t k = 0; k < residual.size(); ++k) {
    const Json& at = k == 0 ? entry({}, 0) : entry(norm, k - 1);
    table.rows.push_back({fmt::format("{}", k), show(residual[k]), show(entry(at, 0), "", 1, 9),
                          show(entry(at, 1), "", 1, 9), show(entry(at, 2), "", 1, 9)});
  }
  chapter.tables.push_back(std::move(table));
}

void add_stages(Chapter& chapter, const Json& stages) {
  if (!stages.is_array() || stages.empty()) return;
  Table table{"Stages",
              {"stage", "Newton iterations", "load steps", "negative pivots", "out of balance at start [N]"},
              {}};
  for (const auto& stage : stages)
    table.rows.push_back({text(member(stage, "name")), show(member(stage, "newton_iterations")),
                          show(member(stage, "lambda_steps")), show(member(stage, "negative_pivots")),
                          show(member(stage, "step0_out_of_balance"))});
  chapter.tables.push_back(std::move(table));
}

void add_passes(Chapter& chapter, const Json& passes) {
  if (!passes.is_array() || passes.empty()) return;
  static constexpr std::array columns{Quantity{"rms", "RMS [mm]", "", 1e3},
                                      Quantity{"rms_area_weighted", "RMS by area [mm]", "", 1e3},
                                      Quantity{"rms_nodes", "RMS of nodes [mm]", "", 1e3},
                                      Quantity{"max_change", "largest change of length [mm]", "", 1e3}};
  Table table{"Passes", {"pass"}, {}};
  for (const auto& column : columns)
    if (any_has(passes, column.name)) table.header.emplace_back(column.label);
  for (std::size_t k = 0; k < passes.size(); ++k) {
    Row row{fmt::format("{}", k)};
    for (const auto& column : columns)
      if (any_has(passes, column.name))
        row.push_back(show(member(passes[k], column.name), "", column.scale, 5));
    table.rows.push_back(std::move(row));
  }
  chapter.tables.push_back(std::move(table));
}

/// An effective mass, with its share of the total mass where that is known.
std::string mass_share(const Json& value, double mass) {
  const auto kilograms = number(value);
  if (!kilograms) return "-";
  if (mass <= 0) return show(kilograms, "kg", 1, 3);
  return fmt::format("{:.1f} %", 100 * *kilograms / mass);
}

void add_modes(Chapter& chapter, const Json& step, double mass) {
  const Json &frequencies = member(step, "frequencies"), &masses = member(step, "effective_mass");
  if (!frequencies.is_array() || frequencies.empty()) return;
  Table table{mass > 0 ? "Modes; effective mass as share of the mass" : "Modes; effective mass",
              {"mode", "frequency [Hz]", "along x", "along y", "along z", "residual"},
              {}};
  for (std::size_t k = 0; k < frequencies.size(); ++k) {
    const Json& m = entry(masses, k);
    table.rows.push_back({fmt::format("{}", k + 1), show(frequencies[k], "", 1, 5),
                          mass_share(entry(m, 0), mass), mass_share(entry(m, 1), mass),
                          mass_share(entry(m, 2), mass),
                          show(entry(member(step, "residuals"), k), "", 1, 3)});
  }
  chapter.tables.push_back(std::move(table));
}

void add_buckling(Chapter& chapter, const Json& step) {
  const Json& factors = member(step, "factors");
  if (!factors.is_array() || factors.empty()) return;
  Table table{"Buckling", {"mode", "load factor", "critical load [N]", "residual"}, {}};
  for (std::size_t k = 0; k < factors.size(); ++k)
    table.rows.push_back({fmt::format("{}", k + 1), show(factors[k], "", 1, 5),
                          show(entry(member(step, "critical_loads"), k)),
                          show(entry(member(step, "residuals"), k), "", 1, 3)});
  chapter.tables.push_back(std::move(table));
}

void add_path(Chapter& chapter, const Json& path) {
  if (!path.is_array() || path.empty()) return;
  Table table{"Load path", {"point", "load factor", "monitor [m]"}, {}, false};
  for (std::size_t k = 0; k < path.size(); ++k)
    table.rows.push_back({fmt::format("{}", k), show(member(path[k], "lambda"), "", 1, 6),
                          show(member(path[k], "monitor"), "", 1, 6)});
  chapter.tables.push_back(std::move(table));
}

}  // namespace

Chapter tell_step(const Json& step, double mass) {
  Chapter chapter{text(member(step, "name")),
                  words(text(member(step, "kind"))),
                  words(text(member(step, "status"))),
                  text(member(step, "reason")),
                  "",
                  {},
                  {}};
  if (const auto seconds = number(member(step, "wall_seconds"))) chapter.time = show(seconds, "s", 1, 3);
  chapter.facts = scalar_facts(step, step_quantities);
  add_convergence(chapter, step);
  add_stages(chapter, member(step, "stages"));
  add_passes(chapter, member(step, "iterations"));
  add_surface(chapter, member(step, "surface"));
  add_groups(chapter, member(step, "groups"));
  add_modes(chapter, step, mass);
  add_buckling(chapter, step);
  add_path(chapter, member(step, "path"));
  return chapter;
}

}  // namespace tautline::output::detail
