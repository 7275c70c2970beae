#pragma once
/// @file
/// verification/thesis/thesis.yaml as read: which figure or table of the thesis is answered by what.

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "case.hpp"

namespace verify {

/// A number: of a verification case, or of this page alone (then `case_name` is "thesis").
struct Row {
  std::string case_name;
  Quantity quantity;
};

struct ChartCurve {
  std::string label;
  std::vector<std::string> x,
      y;  ///< expressions, one after the other; x may be missing: first, first + 1, ...
  double first = 0;
  bool sorted = false;  ///< y in ascending order against the share of entries [%]
  bool line = true;
};

struct ChartItem {
  std::string file, caption, title, x_label, y_label;
  bool log_x = false, log_y = false;
  std::vector<ChartCurve> curves;
};

/// What colours a picture of the structure.
enum class Colour { tension, compression, displacement };

struct ViewItem {
  std::string file, caption, title, run;
  Colour colour = Colour::tension;
  std::vector<std::string> groups;  ///< coloured
  std::vector<std::string> plain;   ///< drawn in grey
  std::optional<std::array<double, 2>> range;
  std::array<double, 3> direction{-0.55, -1.0, 0.45};
};

/// A picture that the program itself drew.
struct CopiedPicture {
  std::string file, caption, run, picture;
};

/// The table of a study: its study.csv, with some columns left out.
struct StudyTable {
  std::string run;
  std::vector<std::string> columns;  ///< "name in study.csv = heading"
};

/// A figure or table of the thesis, or several that go together; or an answer to a question it leaves open.
struct Item {
  std::string label;                ///< e.g. "Figures 3.23, 3.24"
  std::set<std::string> covers;     ///< e.g. "3.23", "table 4.1"
  std::string about, text, status;  ///< status: in place of what follows from rows
  std::vector<Row> rows;
  std::vector<ChartItem> charts;
  std::vector<ViewItem> views;
  std::vector<CopiedPicture> pictures;
  std::vector<StudyTable> tables;
};

struct Chapter {
  std::string title, text;
  bool answers = false;  ///< answers to open questions, not figures of the thesis
  std::vector<Item> items;
};

struct Thesis {
  std::string introduction;
  Case own;                                        ///< runs that no verification case has
  std::vector<Case> cases;                         ///< whose quantities are used
  std::map<std::string, std::string> short_names;  ///< of those cases
  std::vector<Chapter> chapters;
};

/// @param source top of the repository
/// @throws std::runtime_error that names the line and what is wrong
Thesis read_thesis(const std::string& source);

/// What is wrong with the list itself, without running anything: figures and tables of chapters 3 and 4 that
/// no item covers, items that say nothing, runs that are not there, pictures that have one name.
std::vector<std::string> faults(const Thesis& thesis);

/// A run by its name in thesis.yaml: "s2", or "umbrella_12m.s4" of a case.
struct RunOfCase {
  const Case* the_case;
  Run run;
};
/// @throws std::runtime_error that names it
RunOfCase find_run(const Thesis& thesis, const std::string& name);

/// Names of all runs that rows and pictures stand on, in the order of their first use.
std::vector<std::string> needed_runs(const Thesis& thesis);

}  // namespace verify
