#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "output/detail/figures.hpp"
#include "output/detail/step_tables.hpp"
#include "output/detail/story.hpp"

namespace tautline::output::detail {

namespace {

using Json = nlohmann::ordered_json;

/// How a figure of results.json is shown; those not listed are shown as they are.
struct Quantity {
  const char *name, *label, *unit;
  double scale = 1;
  int digits = 4;
};

constexpr std::array surface_quantities{
    Quantity{"rms", "RMS about the mean shift", "mm", 1e3},
    Quantity{"mean_shift", "mean shift", "mm", 1e3},
    Quantity{"rms_direct", "RMS without shift", "mm", 1e3},
    Quantity{"rms_best_fit", "RMS from the best fit", "mm", 1e3},
    Quantity{"best_fit_focal_length", "focal length of the best fit", "m", 1, 6},
    Quantity{"rms_area_weighted", "RMS weighted by area", "mm", 1e3},
    Quantity{"rms_area_weighted_direct", "RMS by area, without shift", "mm", 1e3},
    Quantity{"rms_nodes", "RMS of the net nodes", "mm", 1e3},
    Quantity{"rms_half_path", "RMS half path-length error", "mm", 1e3},
    Quantity{"radius", "evaluated within radius", "m"},
    Quantity{"samples", "nodes evaluated", ""},
    Quantity{"frequency", "frequency", "GHz", 1e-9},
    Quantity{"gain_loss_db", "gain loss", "dB"},
    Quantity{"gain_loss_half_path_db", "gain loss, half path length", "dB"}};

constexpr std::array step_quantities{
    Quantity{"dofs", "degrees of freedom", ""},
    Quantity{"mass", "mass", "kg"},
    Quantity{"newton_iterations", "Newton iterations", ""},
    Quantity{"out_of_balance", "largest out of balance", "N"},
    Quantity{"condition_number", "condition number", ""},
    Quantity{"critical_lambda", "critical load factor", "", 1, 5},
    Quantity{"rod_error_rms", "RMS along the rod", "mm", 1e3},
    Quantity{"rod_error_max", "largest deviation", "mm", 1e3},
    Quantity{"rod_error_max_at", "at length", "m"},
    Quantity{"rod_error_rms_axial", "RMS along the axis", "mm", 1e3},
    Quantity{"least_stability", "least eigenvalue of stability", ""},
    Quantity{"contraction_rate", "contraction of the published iteration", ""},
    Quantity{"bifurcation_lambda", "load factor of bifurcation", "", 1, 5}};

/// Members of a step that are told elsewhere: in the heading or in the table of times.
constexpr std::array told_elsewhere{"name",         "kind",    "status",         "reason",
                                    "wall_seconds", "timings", "factorisations", "peak_memory_bytes"};

template <std::size_t N>
std::vector<Fact> scalar_facts(const Json& object, const std::array<Quantity, N>& quantities) {
  std::vector<Fact> facts;
  if (!object.is_object()) return facts;
  for (const auto& [name, value] : object.items()) {
    if (value.is_structured() || value.is_null()) continue;
    if (std::find(told_elsewhere.begin(), told_elsewhere.end(), name) != told_elsewhere.end()) continue;
    const auto q = std::find_if(quantities.begin(), quantities.end(),
                                [&, &wanted = name](const Quantity& some) { return wanted == some.name; });
    if (q != quantities.end())
      facts.emplace_back(q->label, show(value, q->unit, q->scale, q->digits));
    else
      facts.emplace_back(words(name), value.is_number() ? show(value) : text(value));
  }
  return facts;
}

}  // namespace

std::vector<Fact> surface_facts(const Json& surface) {
  return scalar_facts(surface, surface_quantities);
}

std::vector<Fact> step_facts(const Json& step) {
  auto facts = scalar_facts(step, step_quantities);
  const Json& balance = member(step, "balance");
  if (balance.is_object())
    facts.emplace_back(
        "loads and reactions miss each other by",
        fmt::format("{} of {} (rounding {})", show(member(balance, "force"), "", 1, 2),
                    show(member(balance, "size"), "N"), show(member(balance, "rounding"), "", 1, 2)));
  return facts;
}

Chapter tell_step(const Json& step, double mass) {
  Chapter chapter{text(member(step, "name")),
                  words(text(member(step, "kind"))),
                  words(text(member(step, "status"))),
                  text(member(step, "reason")),
                  "",
                  step_facts(step),
                  surface_facts(member(step, "surface")),
                  {},
                  group_tables(member(step, "groups"))};
  if (const auto seconds = number(member(step, "wall_seconds"))) chapter.time = show(seconds, "s", 1, 3);
  for (Table& table : std::array{
           convergence_table(step), stage_table(member(step, "stages")),
           pass_table(member(step, "iterations")), mode_table(step, mass), buckling_table(step),
           rod_table(step), space_rods_table(member(step, "rods")), unknown_table(member(step, "unknowns")),
           target_table(member(step, "targets")), path_table(member(step, "path"))})
    if (!table.rows.empty()) chapter.tables.push_back(std::move(table));
  return chapter;
}

}  // namespace tautline::output::detail
