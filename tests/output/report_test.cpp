#include <tautline/output/report.hpp>

#include <algorithm>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <tautline/core/error.hpp>
#include <tautline/output/results.hpp>
#include "output/detail/base64.hpp"
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
    if (tag == "!DOCTYPE" || tag == "meta" || tag == "img") continue;
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
       {"1.230 mm", "1.170 mm", "0.4123 Hz", "41.50 kg", "12963", "9.875", "-321.5", "0.41234", "50.0 %",
        "10 GHz", "5.875 m", "prestress", "3.18.5", "abc123", "subdivisions", "sensitivity"})
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
  results["warnings"] = {"no <pictures>"};
  results["steps"].erase(4);
  results["steps"].erase(3);
  const auto html = report_of(directory, results);
  EXPECT_TRUE(balanced(html));
  const auto told = html.find("not complete: not converged");
  ASSERT_NE(told, std::string::npos);
  EXPECT_LT(told, html.find("Structure"));
  EXPECT_TRUE(holds(html, "residual 3 N &gt; 1e-6 N"));
  EXPECT_TRUE(holds(html, "no &lt;pictures&gt;"));
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

TEST(Summary, TellsTheRunInSixtyAlignedLines) {
  Json results = complete_run();
  const auto text = summary_text(results);
  for (const char* figure : {"Dish <12 m>", "9.875", "1.230 mm", "0.41234", "-321.5", "41.50 kg"})
    EXPECT_TRUE(holds(text, figure)) << figure << "\n" << text;
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 60);
  for (int i = 0; i < 40; ++i) results["steps"].push_back(results["steps"][0]);
  const auto longer = summary_text(results);
  EXPECT_LE(std::count(longer.begin(), longer.end(), '\n'), 60);
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
  for (const char* part : {"coarse", "fine", "1.230", "1.125", "0.41234", "time [s]"})
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

}  // namespace
}  // namespace tautline::output
