#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tautline/core/text.hpp>
#include <tautline/output/report.hpp>
#include "output/detail/figures.hpp"
#include "output/detail/layout.hpp"
#include "output/detail/step_tables.hpp"
#include "output/detail/story.hpp"

namespace tautline::output {

namespace {

using Json = nlohmann::ordered_json;
using Lines = std::vector<std::string>;
using detail::member;
using detail::number;
using detail::show;
using detail::text;
using detail::words;

constexpr std::size_t most_passes = 12, most_groups = 24, most_figures = 20;
constexpr auto all = static_cast<std::size_t>(-1);

/// The closing summary, line by line.
class Summary {
 public:
  Summary(const Json& results, std::string directory)
      : results_(results), story_(detail::tell(results)), directory_(std::move(directory)) {
    for (const auto& step : story_.steps) label_ = std::max(label_, detail::text_width(step.name) + 2);
    label_ = std::min<std::size_t>(label_, 26);
  }

  std::string compose() {
    head();
    for (const auto& step : member(results_, "steps")) tell_step(step);
    final_state();
    times();
    ending();
    std::string result;
    for (const auto& line : lines_) result += line + "\n";
    return result;
  }

 private:
  void append(const Lines& lines, const std::string& indent = "") {
    for (const auto& line : lines) lines_.push_back(indent + line);
  }
  void say(const std::string& label, const Lines& parts) {
    append(detail::hanging_lines(label, label_, parts));
  }

  void head() {
    std::string line = fmt::format("{}: {}", story_.title, story_.status);
    if (const auto seconds = number(member(results_, "wall_seconds")))
      line += fmt::format(" {} {}", story_.status == "done" ? "in" : "after", show(seconds, "s", 1, 3));
    const Json& ranks = member(member(results_, "program"), "ranks");
    if (!ranks.is_null()) line += " on " + detail::counted(ranks, "rank", "ranks");
    lines_.push_back(line);
    if (story_.status != "done" && !story_.reason.empty())
      append(detail::hanging_lines("", 2, {story_.reason}));
    model();
  }

  void model() {
    const Json& model = member(results_, "model");
    Lines parts;
    const auto add = [&](const char* name, const char* one, const char* many) {
      const Json& count = member(model, name);
      if (number(count).value_or(0) != 0) parts.push_back(detail::counted(count, one, many));
    };
    add("nodes", "node", "nodes");
    add("dofs", "degree of freedom", "degrees of freedom");
    add("cables", "cable", "cables");
    add("beams", "beam", "beams");
    add("membranes", "membrane", "membranes");
    add("shells", "shell", "shells");
    if (const auto mass = number(member(model, "mass"))) parts.push_back("mass " + show(mass, "kg"));
    if (!parts.empty()) say("structure", parts);
  }

  /// One line for the step itself, then its stages or passes.
  void tell_step(const Json& step) {
    const std::string name = text(member(step, "name")), kind = text(member(step, "kind"));
    const std::string status = words(text(member(step, "status"))), reason = text(member(step, "reason"));
    Lines parts;
    if (kind != name && !kind.empty()) parts.push_back(words(kind));
    if (!status.empty() && status != "done") parts.push_back(capitals(status));
    append_figures(parts, step);
    if (!reason.empty() && story_.reason.find(reason) == std::string::npos) parts.push_back(reason);
    if (const auto seconds = number(member(step, "wall_seconds"))) parts.push_back(show(seconds, "s", 1, 3));
    say(name.empty() ? "step" : name, parts);
    stages(member(step, "stages"));
    const std::string indent(label_, ' ');
    if (const auto nodes = detail::rod_table(step); !nodes.rows.empty())
      append(detail::table_lines(nodes, most_passes), indent);
    for (const auto& found :
         {detail::unknown_table(member(step, "unknowns")), detail::target_table(member(step, "targets"))})
      if (!found.rows.empty()) append(detail::table_lines(found, most_passes), indent);
    if (const auto passes = detail::pass_table(member(step, "iterations")); !passes.rows.empty())
      append(detail::table_lines(passes, most_passes), indent);
  }

  static std::string capitals(std::string status) {
    std::transform(status.begin(), status.end(), status.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return status;
  }

  /// What a step of any kind has found, as far as it is not in the block of the final state.
  static void append_figures(Lines& parts, const Json& step) {
    Json rest = step.is_object() ? step : Json::object();
    for (const char* of_structure : {"nodes", "dofs", "cables", "beams", "membranes", "shells", "mass"})
      rest.erase(of_structure);  // told by the line on the structure
    if (const auto method = text(member(step, "method")); !method.empty())
      parts.push_back("by " + words(method));
    if (const Json& passes = member(step, "iterations"); passes.is_array() && !passes.empty())
      parts.push_back(detail::counted(passes.size() - 1, "pass", "passes"));
    if (const Json& count = member(step, "iterations"); count.is_number())
      parts.push_back(detail::counted(count, "iteration", "iterations"));
    if (const Json& count = member(step, "newton_iterations"); !count.is_null())
      parts.push_back(detail::counted(count, "Newton iteration", "Newton iterations"));
    for (const char* told : {"method", "iterations", "newton_iterations"}) rest.erase(told);
    for (const auto& [label, value] : detail::step_facts(rest))
      if (parts.size() < 6) parts.push_back(label + " " + value);
    if (const Json& modes = member(step, "frequencies"); modes.is_array()) {
      parts.push_back(detail::counted(modes.size(), "mode", "modes"));
      if (const auto worst = largest(member(step, "residuals")))
        parts.push_back("largest residual " + show(worst, "", 1, 3));
    }
    if (const auto factors = list(member(step, "factors")); !factors.empty())
      parts.push_back("load factors " + join(factors, ", ", all));
  }

  static detail::Figure largest(const Json& list) {
    detail::Figure result;
    if (list.is_array())
      for (const auto& entry : list)
        if (const auto value = number(entry)) result = std::max(result.value_or(*value), *value);
    return result;
  }

  static Lines list(const Json& values) {
    Lines figures;
    if (values.is_array())
      for (const auto& value : values) figures.push_back(show(value));
    if (figures.size() > most_figures) {
      const std::size_t more = figures.size() - most_figures;
      figures.resize(most_figures);
      figures.push_back(fmt::format("and {} more", more));
    }
    return figures;
  }

  void stages(const Json& stages) {
    if (!stages.is_array() || stages.empty()) return;
    detail::Table table;
    for (const auto& stage : stages) {
      const auto count = [&](const char* name, const char* one, const char* many) {
        const Json& value = member(stage, name);
        return value.is_null() ? std::string() : detail::counted(value, one, many);
      };
      detail::Row row{text(member(stage, "name")),
                      count("newton_iterations", "Newton iteration", "Newton iterations"),
                      count("lambda_steps", "load step", "load steps")};
      const Json& start = member(stage, "step0_out_of_balance");
      std::string end = start.is_null() ? "" : "out of balance at start " + show(start, "N");
      for (const auto& [name, one, many] :
           {std::array{"failed_attempts", "attempt failed", "attempts failed"},
            std::array{"descent_steps", "step downhill", "steps downhill"},
            std::array{"negative_pivots", "negative pivot", "negative pivots"}})
        if (number(member(stage, name)).value_or(0) != 0) end += ", " + count(name, one, many);
      if (const auto status = text(member(stage, "status")); !status.empty() && status != "done")
        end += ", " + capitals(words(status));
      row.push_back(end);
      table.rows.push_back(std::move(row));
    }
    auto lines = detail::table_lines(table, all);
    lines.erase(lines.begin());  // no header: the lines read as sentences
    append(lines, std::string(label_, ' '));
  }

  /// Name of the step that a figure is from, unless the heading tells it.
  std::string origin(const Json& step) const {
    const std::string name = text(member(step, "name"));
    return name == state_name_ ? "" : " after " + name;
  }

  void final_state() {
    const Json& with_state = detail::last_step_with(results_, {"groups", "surface"});
    const Json& with_modes = detail::last_step_with(results_, {"frequencies"});
    if (with_state.is_null() && with_modes.is_null()) return;
    state_name_ = text(member(with_state, "name"));
    lines_.emplace_back();
    const char* heading = story_.status == "done" ? "Final state" : "Last state";
    lines_.push_back(state_name_.empty() ? heading : fmt::format("{}, after {}", heading, state_name_));
    surface(detail::last_step_with(results_, {"surface"}));
    groups(detail::last_step_with(results_, {"groups"}));
    if (const auto frequencies = list(member(with_modes, "frequencies")); !frequencies.empty())
      append(detail::hanging_lines("  frequencies [Hz]", first_column + 4, frequencies));
  }

  void state_table(const detail::Table& table, std::size_t most) {
    append(detail::table_lines(table, most, first_column), "  ");
  }

  void surface(const Json& step) {
    const Json& surface = member(step, "surface");
    if (!surface.is_object()) return;
    detail::Table table{"", {"surface RMS [mm]" + origin(step)}, {{""}}};
    for (const auto& [name, label] :
         {std::pair{"rms", "about mean"}, std::pair{"rms_direct", "direct"},
          std::pair{"rms_best_fit", "best fit"}, std::pair{"rms_area_weighted", "by area"},
          std::pair{"rms_nodes", "net nodes"}, std::pair{"rms_half_path", "half path"}}) {
      if (member(surface, name).is_null()) continue;
      table.header.emplace_back(label);
      table.rows[0].push_back(show(member(surface, name), "", 1e3));
    }
    state_table(table, all);
    Lines parts;
    const auto add = [&](const char* name, const char* label, const char* unit, double scale, int digits) {
      if (const Json& value = member(surface, name); !value.is_null())
        parts.push_back(fmt::format("{}{}", label, show(value, unit, scale, digits)));
    };
    add("gain_loss_db", "gain loss ", "dB", 1, 4);
    if (!parts.empty() && !member(surface, "frequency").is_null())
      parts.back() += " at " + show(member(surface, "frequency"), "GHz", 1e-9);
    add("mean_shift", "mean shift ", "mm", 1e3, 4);
    add("best_fit_focal_length", "best-fit focal length ", "m", 1, 5);
    if (number(member(surface, "radius")).value_or(0) > 0) add("radius", "within radius ", "m", 1, 4);
    append(detail::hanging_lines("", first_column + 4, parts));
  }

  void groups(const Json& step) {
    for (auto& table : detail::group_tables(member(step, "groups"))) {
      table.header[0] = table.title + origin(step);
      state_table(table, most_groups);
    }
  }

  /// Time of all steps by kind of work, and memory.
  void times() {
    Lines parts;
    for (const char* name : {"assembly", "factorisation", "solve", "other"}) {
      detail::Figure sum;
      for (const auto& step : member(results_, "steps"))
        if (const auto seconds = number(member(member(step, "timings"), name)))
          sum = sum.value_or(0) + *seconds;
      if (sum) parts.push_back(fmt::format("{} {:.2f} s", name, *sum));
    }
    detail::Figure peak;
    for (const auto& step : member(results_, "steps"))
      if (const auto bytes = number(member(step, "peak_memory_bytes")))
        peak = std::max(peak.value_or(0), *bytes);
    if (peak) parts.push_back(fmt::format("peak memory {:.0f} MB", 1e-6 * *peak));
    if (parts.empty()) return;
    lines_.emplace_back();
    append(detail::hanging_lines("Time:", 9, parts));
  }

  void ending() {
    for (const auto& warning : member(results_, "warnings"))
      append(detail::hanging_lines("Warning:", 9, {detail::warning_text(warning)}));
    if (!directory_.empty())
      append(detail::hanging_lines("Results:", 9, {directory_ + " (report.html, results.json)"}));
    if (story_.status == "done") return;
    const auto& steps = member(results_, "steps");
    if (steps.is_array() && !steps.empty() && steps.back().contains("diagnosis"))
      return diagnosis(steps.back());
    Lines parts{story_.status};
    if (!story_.reason.empty()) parts.push_back(story_.reason);
    append(detail::hanging_lines("Not complete:", 14, parts));
  }

  /// Each finding on a line of its own.
  void diagnosis(const Json& step) {
    constexpr std::size_t indent = 14;
    const auto& told = member(step, "diagnosis");
    append(detail::hanging_lines(
        "Not complete:", indent,
        {fmt::format("{}, step \"{}\"", story_.status, detail::text(member(step, "name")))}));
    for (const auto& finding : member(told, "findings"))
      append(detail::hanging_lines("", indent, {detail::text(finding)}));
    append(detail::hanging_lines("Remedy:", indent, {detail::text(member(told, "remedy"))}));
    append(detail::hanging_lines("Solver:", indent, {detail::text(member(told, "solver"))}));
  }

  static constexpr std::size_t first_column = 26;

  const Json& results_;
  detail::Story story_;
  std::string directory_, state_name_;
  std::size_t label_ = 11;  ///< width of the column of names
  Lines lines_;
};

}  // namespace

std::string summary_text(const Json& results, const std::string& directory) {
  return Summary(results, directory).compose();
}

}  // namespace tautline::output
