#include <tautline/output/report.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <tautline/core/error.hpp>
#include <tautline/output/results.hpp>
#include "output/detail/base64.hpp"
#include "output/detail/figures.hpp"
#include "output/temporary_directory.hpp"

namespace tautline::output {
namespace {

using Json = nlohmann::ordered_json;
using test::contents;
using test::message_of;
using test::put;
using test::TemporaryDirectory;

Json complete_run() {
  return Json::parse(R"({
    "format": "tautline-results", "version": 1, "status": "done", "reason": "every step came to its end",
    "program": {"version": "0.1.0", "petsc": "3.18.5", "ranks": 2},
    "deck": {"path": "inputs/dish.yaml", "sha256": "abc123", "title": "Dish <12 m> & \"ties\""},
    "model": {"nodes": 4321, "dofs": 12963, "cables": 2000, "beams": 90, "membranes": 38400, "shells": 0, "mass": 41.5,
              "mass_by_group": {"front_net": 1.25}},
    "wall_seconds": 12.5,
    "steps": [
      {"name": "shape", "kind": "form_finding", "status": "done", "reason": "", "wall_seconds": 0.25, "iterations": 2,
       "constraint_residual": [3.5, 0.02, 1e-9], "coordinate_norm": [[1, 2, 3], [1, 2, 3.0000001]],
       "out_of_balance": 2.5e-9, "groups": {"front_net": {"count": 900, "tension_min": 9.875, "tension_max": 10.25,
       "tension_mean": 10, "tension_rms_from_target": 0.0625, "slack": 0}}},
      {"name": "mesh", "kind": "mesh", "status": "done", "nodes": 4321, "subdivisions": 8, "pattern": "mapped"},
      {"name": "load", "kind": "equilibrium", "status": "done", "stages": [{"name": "prestress", "newton_iterations": 7,
       "lambda_steps": 1, "negative_pivots": 0, "step0_out_of_balance": 0.5}],
       "groups": {"truss": {"count": 90, "axial_min": -321.5, "axial_max": 12.5, "moment_max": 3.25},
                  "cloth": {"count": 38400, "principal_min": 1.5, "principal_max": 2.5}}},
      {"name": "tune", "kind": "tuning", "status": "done", "method": "sensitivity",
       "iterations": [{"rms": 0.0039, "max_change": null}, {"rms": 0.00123, "max_change": 0.0005}],
       "surface": {"rms": 0.00123, "mean_shift": -0.0018, "rms_best_fit": 0.00117, "radius": 5.875, "samples": 20000,
                   "frequency": 1e10, "gain_loss_db": 1.155}},
      {"name": "modes", "kind": "modal", "status": "done", "frequencies": [0.41234, 0.5],
       "effective_mass": [[20.75, 0, 0, 1, 1, 1], [0, 10.375, 0, 1, 1, 1]], "residuals": [1e-9, 2e-9],
       "wall_seconds": 1.5, "timings": {"assembly": 0.5, "factorisation": 0.25, "solve": 0.125, "other": 0.625},
       "factorisations": 3, "peak_memory_bytes": 512000000}],
    "pictures": [{"file": "pictures/tune_deviation.png", "caption": "Deviation & <shape>", "step": "tune"},
                 {"file": "pictures/lost.png", "caption": "not there", "step": "tune"}]})");
}

/// Whether every opened element is closed in order; void elements excepted.
bool balanced(const std::string& html) {
  std::vector<std::string> open;
  for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at + 1)) {
    const bool closing = html[at + 1] == '/';
    const std::size_t begin = at + (closing ? 2 : 1), end = html.find_first_of(" >\n", begin);
    const std::string tag = html.substr(begin, end - begin);
    if (tag == "!DOCTYPE" || tag == "meta" || tag == "img" || tag == "input") continue;
    if (!closing) {
      open.push_back(tag);
    } else {
      if (open.empty() || open.back() != tag) return false;
      open.pop_back();
    }
  }
  return open.empty();
}

/// Report of `results`, in a directory of its own.
std::string report_of(const TemporaryDirectory& directory, const Json& results) {
  write_results(directory.file("results.json"), results);
  return contents(write_report({directory.path()}));
}

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Report, ShowsTheFiguresWithTheirUnits) {
  const TemporaryDirectory directory("report_figures");
  const auto html = report_of(directory, complete_run());
  EXPECT_TRUE(balanced(html));
  for (const char* figure :
       {"1.230 mm", "1.170 mm", "0.4123 Hz", "41.50 kg", "12963", "9.875", "-321.5", "0.4123",
        "<td>50.0</td>", "10 GHz", "5.875 m", "prestress", "3.18.5", "abc123", "subdivisions", "sensitivity"})
    EXPECT_TRUE(holds(html, figure)) << figure;
  EXPECT_FALSE(holds(html, "not complete"));
}

TEST(Report, EscapesWhatTheUserWrote) {
  const TemporaryDirectory directory("report_escape");
  const auto html = report_of(directory, complete_run());
  EXPECT_TRUE(holds(html, "Dish &lt;12 m&gt; &amp; &quot;ties&quot;"));
  EXPECT_FALSE(holds(html, "<12 m>"));
}

TEST(Report, EmbedsPicturesAndLoadsNothingFromOutside) {
  const TemporaryDirectory directory("report_pictures");
  std::filesystem::create_directories(directory.file("pictures"));
  put(directory.file("pictures/tune_deviation.png"), "first picture");
  put(directory.file("pictures/unlisted.png"), "second");
  const auto html = report_of(directory, complete_run());
  EXPECT_TRUE(balanced(html));
  EXPECT_TRUE(holds(html, "data:image/png;base64," + detail::base64("first picture")));
  EXPECT_TRUE(holds(html, "Deviation &amp; &lt;shape&gt;"));
  EXPECT_TRUE(holds(html, detail::base64("second")));
  for (const char* outside : {"http:", "https:", "<link", "<script", "lost.png"})
    EXPECT_FALSE(holds(html, outside)) << outside;
}

TEST(Report, SaysOnTopWhenTheRunIsNotComplete) {
  const TemporaryDirectory directory("report_interrupted");
  Json results = complete_run();
  results["status"] = "not_converged";
  results["reason"] = "step \"load\": residual 3 N > 1e-6 N";
  results["warnings"] = Json::array({{{"code", "c"}, {"message", "no <pictures>"}, {"where", "step \"a\""}}});
  results["steps"].erase(4);
  results["steps"].erase(3);
  const auto html = report_of(directory, results);
  EXPECT_TRUE(balanced(html));
  const auto told = html.find("not complete: not converged");
  ASSERT_NE(told, std::string::npos);
  EXPECT_LT(told, html.find("Structure"));
  EXPECT_TRUE(holds(html, "residual 3 N &gt; 1e-6 N"));
  EXPECT_TRUE(holds(html, "Last state")) << "not final";
  EXPECT_FALSE(holds(html, "Final state"));
  EXPECT_TRUE(holds(html, "step &quot;a&quot;: no &lt;pictures&gt;"));
}

TEST(Report, AnyPartMayBeMissing) {
  const Json whole = complete_run();
  const TemporaryDirectory directory("report_missing");
  for (const auto& [name, value] : whole.items()) {
    Json results = whole;
    results.erase(name);
    EXPECT_TRUE(balanced(report_of(directory, results))) << name;
    results[name] = nullptr;
    EXPECT_TRUE(balanced(report_of(directory, results))) << name;
    EXPECT_FALSE(summary_text(results).empty());
  }
  for (std::size_t i = 0; i < whole["steps"].size(); ++i)
    for (const auto& [name, value] : whole["steps"][i].items()) {
      Json results = whole;
      results["steps"][i][name] = nullptr;
      EXPECT_TRUE(balanced(report_of(directory, results))) << i << name;
    }
  EXPECT_TRUE(balanced(report_of(directory, Json::object())));
}

TEST(Report, NamesAMissingResultsFile) {
  const TemporaryDirectory directory("report_absent");
  const auto message = message_of<LibraryError>([&] { write_report({directory.path()}); });
  EXPECT_TRUE(holds(message, directory.file("results.json"))) << message;
}

TEST(Report, ShowsTheFinalStateBeforeTheSteps) {
  const TemporaryDirectory directory("report_order");
  std::filesystem::create_directories(directory.file("pictures"));
  put(directory.file("pictures/tune_deviation.png"), "last deviation");
  put(directory.file("pictures/load_tensions.png"), "earlier tensions");
  Json results = complete_run();
  results["pictures"].push_back(
      {{"file", "pictures/load_tensions.png"}, {"caption", "Tensions"}, {"step", "load"}});
  const auto html = report_of(directory, results);
  const auto cards = html.find("class=\"card\""), last = html.find("Final state"),
             picture = html.find(detail::base64("last deviation")), steps = html.find("<h2>Shape"),
             earlier = html.find(detail::base64("earlier tensions"));
  EXPECT_LT(cards, last);
  EXPECT_LT(last, picture);
  EXPECT_LT(picture, steps);
  EXPECT_LT(steps, earlier);
  EXPECT_LT(earlier, html.find("<h2>Tune"));
  EXPECT_EQ(html.find(detail::base64("last deviation"), picture + 1), std::string::npos) << "embedded twice";
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The line with blanks between words made one; "" if no line holds `part`.
std::string line_with(const std::string& text, const std::string& part) {
  for (const auto& line : lines_of(text)) {
    if (!holds(line, part)) continue;
    std::istringstream stream(line);
    std::string joined;
    for (std::string word; stream >> word;) joined += (joined.empty() ? "" : " ") + word;
    return joined;
  }
  return "";
}

/// A run as long as that of a reflector: two equilibria, five passes, eight groups, six modes.
Json long_run() {
  Json results = complete_run();
  Json& steps = results["steps"];
  steps.insert(steps.begin() + 3, steps[2]);
  steps[2]["stages"].push_back(steps[2]["stages"][0]);
  Json& tuning = steps[4];
  tuning["iterations"] = Json::array();
  for (int pass = 0; pass < 5; ++pass)
    tuning["iterations"].push_back({{"rms", 0.0101 - 1e-4 * pass},
                                    {"rms_area_weighted", 0.000912345 - 1e-5 * pass},
                                    {"rms_nodes", 7.5e-5 / (1 + pass)},
                                    {"max_change", pass == 0 ? 0.0 : 4.4287e-4 / pass}});
  for (const char* name : {"front_net", "rear_net", "ties", "diagonals"})
    tuning["groups"][name] = steps[0]["groups"]["front_net"];
  for (const char* name : {"front_rim", "rear_rim", "struts"})
    tuning["groups"][name] = steps[2]["groups"]["truss"];
  tuning["groups"]["cloth"] = steps[2]["groups"]["cloth"];
  steps[5]["frequencies"] = {0.21962, 0.39821, 1.5465, 2.7436, 4.3488, 4.3626};
  return results;
}

TEST(Summary, TellsTheWholeRunInFortyFiveLines) {
  const auto text = summary_text(long_run(), "results/dish");
  const auto lines = lines_of(text);
  EXPECT_LE(lines.size(), 45u) << text;
  for (const auto& line : lines) EXPECT_LE(line.size(), 100u) << line;
  EXPECT_EQ(lines[0], "Dish <12 m> & \"ties\": done in 12.5 s on 2 ranks");
  EXPECT_TRUE(holds(line_with(text, "structure"), "4321 nodes, 12963 degrees of freedom")) << text;
  EXPECT_TRUE(holds(text, "mass 41.50 kg")) << text;
  EXPECT_EQ(line_with(text, "shape"),
            "shape form finding, 2 iterations, largest out of balance 2.50e-09 N, 0.250 s");
  EXPECT_EQ(line_with(text, "prestress"),
            "prestress 7 Newton iterations 1 load step out of balance at start 0.5000 N");
  EXPECT_EQ(line_with(text, "pass  RMS"), "pass RMS [mm] by area [mm] net nodes [mm] largest change [mm]");
  EXPECT_EQ(line_with(text, "10.10"), "0 10.100 0.9123 0.07500 0");
  EXPECT_EQ(line_with(text, "0.8723"), "4 9.700 0.8723 0.01500 0.1107");
  EXPECT_TRUE(holds(text, "Final state, after tune")) << text;
  EXPECT_EQ(line_with(text, "rear_net"), "rear_net 900 9.875 10.000 10.250 0.06250 0");
  EXPECT_EQ(line_with(text, "struts"), "struts 90 -321.50 12.50 3.250");
  EXPECT_EQ(line_with(text, "1.230"), "1.230 1.170");
  EXPECT_TRUE(holds(text, "gain loss 1.155 dB at 10 GHz")) << text;
  EXPECT_EQ(line_with(text, "[Hz]"), "frequencies [Hz] 0.2196, 0.3982, 1.546, 2.744, 4.349, 4.363");
  EXPECT_TRUE(holds(line_with(text, "Time:"), "factorisation 0.25 s")) << text;
  EXPECT_EQ(lines.back(), "Results: results/dish (report.html, results.json)");
}

TEST(Summary, SaysAtBothEndsThatTheRunIsNotComplete) {
  Json results = complete_run();
  results["status"] = "not_converged";
  results["reason"] = "step \"load\": no equilibrium at lambda 0.25";
  results["steps"].erase(4);
  results["steps"].erase(3);
  results["steps"][2]["status"] = "not_converged";
  const auto text = summary_text(results);
  const auto lines = lines_of(text);
  EXPECT_TRUE(holds(lines[0], "not converged after 12.5 s")) << text;
  EXPECT_TRUE(holds(lines[1], "no equilibrium at lambda 0.25")) << text;
  EXPECT_TRUE(holds(line_with(text, "NOT CONVERGED"), "load")) << text;
  EXPECT_EQ(lines.back(), "Not complete: not converged, step \"load\": no equilibrium at lambda 0.25");
  EXPECT_TRUE(holds(text, "Last state, after load")) << text;
  EXPECT_FALSE(holds(text, "Hz")) << text;
}

TEST(Summary, TellsStepsOfUnknownKindsInOneLine) {
  const auto text = summary_text(Json::parse(R"({"status": "done", "steps": [
    {"name": "spin", "kind": "gyration", "status": "done", "turns": 12.25, "axis": "z", "list": [1, 2]}]})"));
  EXPECT_EQ(line_with(text, "spin"), "spin gyration, turns 12.25, axis z");
  EXPECT_EQ(lines_of(text).size(), 2u) << text;
}

TEST(Summary, LeavesOutTheMiddleOfVeryManyPassesAndSaysSo) {
  Json results = complete_run();
  results["steps"][3]["iterations"] = Json::array();
  for (int pass = 0; pass < 40; ++pass)
    results["steps"][3]["iterations"].push_back({{"rms", 0.002 - 1e-5 * pass}, {"max_change", 1e-4}});
  const auto text = summary_text(results);
  EXPECT_EQ(line_with(text, "2.000"), "0 2.000 0.1000");
  EXPECT_EQ(line_with(text, "1.610"), "39 1.610 0.1000");
  EXPECT_TRUE(holds(text, "... 28 rows between")) << text;
}

TEST(Figures, OfAColumnHaveOneNotation) {
  using detail::Figure;
  using detail::show_column;
  using Column = std::vector<std::string>;
  EXPECT_EQ(show_column({9.9999, 10.0, 10.2}), (Column{"10.00", "10.00", "10.20"}));
  EXPECT_EQ(show_column({28.91, 0.05478, Figure()}), (Column{"28.910", "0.055", "-"}));
  EXPECT_EQ(show_column({3.0, 120.0, NAN}), (Column{"3", "120", "-"}));
  EXPECT_EQ(show_column({6.659, 1e-10, 0.0}), (Column{"6.659e+00", "1.000e-10", "0"}));
  EXPECT_EQ(show_column({0.00101, -0.00102}, 1e3), (Column{"1.010", "-1.020"}));
  EXPECT_EQ(detail::show(Figure(9.99996)), "10.00");
}

TEST(Comparison, PutsRunsSideBySide) {
  const TemporaryDirectory directory("comparison");
  std::filesystem::create_directories(directory.file("coarse"));
  std::filesystem::create_directories(directory.file("fine"));
  Json fine = complete_run();
  fine["steps"][3]["surface"]["rms"] = 0.001125;
  fine["steps"].erase(4);
  write_results(directory.file("coarse/results.json"), complete_run());
  write_results(directory.file("fine/results.json"), fine);
  const auto text = comparison_text({directory.file("coarse"), directory.file("fine")});
  for (const char* part : {"coarse", "fine", "1.230", "1.125", "0.4123", "time [s]", "-321.50 / 12.50"})
    EXPECT_TRUE(holds(text, part)) << text;
  const auto path = write_report({directory.file("coarse"), directory.file("fine")});
  EXPECT_EQ(path, directory.file("coarse/comparison.html"));
  EXPECT_TRUE(balanced(contents(path)));
  EXPECT_TRUE(holds(contents(path), "1.125"));
}

TEST(Base64, MatchesTheStandardsExamples) {
  EXPECT_EQ(detail::base64(""), "");
  EXPECT_EQ(detail::base64("f"), "Zg==");
  EXPECT_EQ(detail::base64("fo"), "Zm8=");
  EXPECT_EQ(detail::base64("foobar"), "Zm9vYmFy");
}

TEST(Summary, TellsTheNodesOfABentRodFromTheRootOn) {
  const Json results = Json::parse(R"({"status": "done", "steps": [{"name": "exact", "kind": "rod_shaping",
    "status": "done", "rod_error_rms": 0.00125, "root": {"X": 0.25, "Y": 0.5, "theta": 0.125}, "X": [2.5], "Y": [1.5],
    "theta": [0.75], "reaction": [62.5], "strain": [0.5], "stiffness": [null],
    "moments": {"I": [256, 0], "II": [256, 1e-27]}}]})");
  const std::string text = summary_text(results);
  EXPECT_NE(text.find("RMS along the rod 1.250 mm"), std::string::npos) << text;
  std::istringstream lines(text);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; cells >> cell;) rows.back().push_back(cell);
  }
  using Cells = std::vector<std::string>;
  EXPECT_EQ(std::count(rows.begin(), rows.end(),
                       Cells({"0", "0.25000", "0.50000", "0.1250", "2.5600e+02", "-", "-", "-"})),
            1)
      << text;
  EXPECT_EQ(std::count(rows.begin(), rows.end(),
                       Cells({"1", "2.50000", "1.50000", "0.7500", "1.0000e-27", "62.500", "50", "-"})),
            1)
      << text;
}

}  // namespace
}  // namespace tautline::output
