#pragma once
/// @file
/// What a run has to tell, as headings, figures and tables of text: read once from results.json, then shown
/// as a page or as plain text. Whatever is missing in the file is missing here, too.

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
  bool in_summary = true;  ///< shown in the closing summary on stdout, too
};

struct Chapter {
  std::string name, kind, status, reason, time;
  std::vector<Fact> facts;
  std::vector<Table> tables;
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

/// The last entry of that name found in the steps, e.g. "surface"; null if there is none.
const nlohmann::ordered_json& last_of(const nlohmann::ordered_json& results, const char* name);

}  // namespace tautline::output::detail
