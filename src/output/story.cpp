#include "output/detail/story.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "output/detail/figures.hpp"

namespace tautline::output::detail {

namespace {

using Json = nlohmann::ordered_json;

void add(std::vector<Fact>& facts, const char* label, const Json& value, const char* unit = "",
         double scale = 1) {
  if (!value.is_null()) facts.emplace_back(label, show(value, unit, scale));
}

/// Largest tension and number of slack cables of all groups.
void add_tensions(std::vector<Fact>& facts, const Json& groups) {
  std::optional<double> largest;
  double slack = 0;
  for (const auto& group : groups) {
    if (const auto tension = number(member(group, "tension_max")))
      largest = std::max(largest.value_or(*tension), *tension);
    slack += number(member(group, "slack")).value_or(0);
  }
  if (!largest) return;
  facts.emplace_back("largest tension", show(largest, "N"));
  facts.emplace_back("slack cables", fmt::format("{:.0f}", slack));
}

void add_first(std::vector<Fact>& facts, const char* label, const Json& list, const char* unit) {
  if (list.is_array() && !list.empty()) add(facts, label, list[0], unit);
}

std::vector<Fact> headline(const Json& results) {
  std::vector<Fact> facts;
  const Json& surface = last_of(results, "surface");
  add(facts, "surface error, RMS", member(surface, "rms"), "mm", 1e3);
  add(facts, "RMS from the best fit", member(surface, "rms_best_fit"), "mm", 1e3);
  add(facts, "gain loss", member(surface, "gain_loss_db"), "dB");
  add(facts, "error along the rod, RMS", last_of(results, "rod_error_rms"), "mm", 1e3);
  add_first(facts, "first frequency", last_of(results, "frequencies"), "Hz");
  add_first(facts, "buckling load factor", last_of(results, "factors"), "");
  add(facts, "critical load factor", last_of(results, "critical_lambda"));
  add_tensions(facts, last_of(results, "groups"));
  add(facts, "mass", member(member(results, "model"), "mass"), "kg");
  add(facts, "time", member(results, "wall_seconds"), "s");
  return facts;
}

std::vector<Fact> model_facts(const Json& model) {
  std::vector<Fact> facts;
  for (const auto& [name, label] :
       {Fact{"nodes", "nodes"}, Fact{"dofs", "degrees of freedom"}, Fact{"cables", "cables"},
        Fact{"beams", "beams"}, Fact{"membranes", "membranes"}, Fact{"shells", "shells"}}) {
    const Json& value = member(model, name.c_str());
    if (number(value).value_or(0) != 0) facts.emplace_back(label, show(value));
  }
  add(facts, "mass", member(model, "mass"), "kg");
  const Json& by_group = member(model, "mass_by_group");
  if (by_group.is_object())
    for (const auto& [name, mass] : by_group.items()) facts.emplace_back("mass of " + name, show(mass, "kg"));
  return facts;
}

std::vector<Fact> program_facts(const Json& results) {
  std::vector<Fact> facts;
  const Json& program = member(results, "program");
  if (program.is_object())
    for (const auto& [name, value] : program.items())
      facts.emplace_back(name == "version" ? "tautline" : name, text(value));
  const auto sha = text(member(member(results, "deck"), "sha256"));
  if (!sha.empty()) facts.emplace_back("sha256 of the deck", sha);
  return facts;
}

/// One column of the table of times; `get` picks the figure of a step.
template <typename Get>
void add_column(Table& table, const Json& steps, const char* label, int digits, double scale,
                const Get& get) {
  std::vector<Figure> values;
  for (const auto& step : steps) values.push_back(number(get(step)));
  const auto figures = show_column(values, scale, digits);
  table.header.emplace_back(label);
  for (std::size_t i = 0; i < figures.size(); ++i) table.rows[i].push_back(figures[i]);
}

Table timings(const Json& steps) {
  Table table{"Time and memory", {"step"}, {}};
  for (const auto& step : steps) table.rows.push_back({text(member(step, "name"))});
  const auto of_step = [](const char* name) {
    return [name](const Json& step) -> const Json& { return member(step, name); };
  };
  const auto of_timings = [](const char* name) {
    return [name](const Json& step) -> const Json& { return member(member(step, "timings"), name); };
  };
  add_column(table, steps, "wall [s]", 3, 1, of_step("wall_seconds"));
  add_column(table, steps, "assembly [s]", 3, 1, of_timings("assembly"));
  add_column(table, steps, "factorisation [s]", 3, 1, of_timings("factorisation"));
  add_column(table, steps, "solve [s]", 3, 1, of_timings("solve"));
  add_column(table, steps, "other [s]", 3, 1, of_timings("other"));
  add_column(table, steps, "factorisations", 4, 1, of_step("factorisations"));
  add_column(table, steps, "peak memory [MB]", 3, 1e-6, of_step("peak_memory_bytes"));
  return table;
}

}  // namespace

const Json& last_step_with(const Json& results, std::initializer_list<const char*> names) {
  const Json& steps = member(results, "steps");
  for (auto step = steps.rbegin(); step != steps.rend(); ++step)
    for (const char* name : names)
      if (!member(*step, name).is_null()) return *step;
  return member(Json(), "");
}

const Json& last_of(const Json& results, const char* name) {
  return member(last_step_with(results, {name}), name);
}

Story tell(const Json& results) {
  Story story;
  const Json& deck = member(results, "deck");
  story.deck = text(member(deck, "path"));
  story.title = text(member(deck, "title"));
  if (story.title.empty()) story.title = story.deck.empty() ? "Results" : story.deck;
  story.status = words(text(member(results, "status")));
  if (story.status.empty()) story.status = "unknown";
  story.reason = text(member(results, "reason"));
  story.headline = headline(results);
  story.model = model_facts(member(results, "model"));
  story.program = program_facts(results);
  const double mass = number(member(member(results, "model"), "mass")).value_or(0);
  const Json& steps = member(results, "steps");
  for (const auto& step : steps) story.steps.push_back(tell_step(step, mass));
  story.timings = timings(steps);
  return story;
}

}  // namespace tautline::output::detail
