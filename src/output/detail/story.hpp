#pragma once
/// @file
/// What a run has to tell, as headings, figures and tables of text: read once from results.json, then shown
/// as a page. Whatever is missing in the file is missing here, too.

#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace tautline::output::detail {

using Row = std::vector<std::string>;
using Fact = std::pair<std::string, std::string>;  ///< label and value with unit

struct Table {
  std::string title;
  Row header;
  std::vector<Row> rows;
};

struct Chapter {
  std::string name, kind, status, reason, time;
  std::vector<Fact> facts, surface;
  std::vector<Table> tables;  ///< how it went
  std::vector<Table> groups;  ///< forces where it ended
};

struct Story {
  std::string title, deck, status, reason;
  std::vector<Fact> headline;  ///< the figures one looks for first
  std::vector<Fact> model, program;
  std::vector<Chapter> steps;
  Table timings;
};

Story tell(const nlohmann::ordered_json& results);

/// Facts and tables of one step.
Chapter tell_step(const nlohmann::ordered_json& step, double mass);
std::vector<Fact> step_facts(const nlohmann::ordered_json& step);
std::vector<Fact> surface_facts(const nlohmann::ordered_json& surface);

/// The last step that has an entry of one of the names, e.g. "surface"; null if there is none.
const nlohmann::ordered_json& last_step_with(const nlohmann::ordered_json& results,
                                             std::initializer_list<const char*> names);

/// That entry itself.
const nlohmann::ordered_json& last_of(const nlohmann::ordered_json& results, const char* name);

}  // namespace tautline::output::detail
