#include <set>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/la/session.hpp>
#include <tautline/output/pictures.hpp>
#include <tautline/output/results.hpp>
#include <tautline/steps/run.hpp>

#include "steps/context.hpp"
#include "steps/extrapolation.hpp"

namespace tautline::steps {

namespace {

/// One row of the study: the figures of the last step that measured the surface.
Json row_of(const Json& results, int subdivisions) {
  Json row{{"subdivisions", subdivisions}, {"status", results["status"]}, {"dofs", results["model"]["dofs"]}};
  int newton = 0, factorisations = 0;
  double solver = 0;
  for (const auto& step : results["steps"]) {
    if (step.contains("surface")) row["surface"] = step["surface"];
    if (step.contains("stages"))
      for (const auto& stage : step["stages"]) newton += stage["newton_iterations"].get<int>();
    if (step.contains("newton_iterations")) newton += step["newton_iterations"].get<int>();
    factorisations += step["factorisations"].get<int>();
    solver += step["timings"]["factorisation"].get<double>() + step["timings"]["solve"].get<double>();
  }
  row["newton_iterations"] = newton;
  row["factorisations"] = factorisations;
  row["solver_seconds"] = solver;
  row["wall_seconds"] = results["wall_seconds"];
  return row;
}

constexpr const char* measures[] = {"rms", "rms_direct", "rms_best_fit", "rms_area_weighted", "rms_nodes"};

/// Of the three finest meshes; none if one of those asked for failed.
Json extrapolate(const Json& study, const std::string& measure) {
  const Json& rows = study["rows"];
  std::vector<double> size, value;
  for (const auto& row : rows) {
    size.push_back(1.0 / row["subdivisions"].get<int>());
    value.push_back(row["surface"][measure].get<double>());
  }
  auto found = extrapolate_three(size, value);
  for (const auto& failed : study["failed"])
    if (rows.size() < 3 || failed["subdivisions"] > rows[rows.size() - 3]["subdivisions"])
      found.why_not = fmt::format("the run with {} parts failed", failed["subdivisions"].get<int>());
  if (!found) return {{"order", nullptr}, {"limit", nullptr}, {"why_not", found.why_not}};
  return {{"order", found.order}, {"limit", found.limit}};
}

void write_csv(const std::string& path, const Json& rows) {
  std::string text =
      "subdivisions,dofs,rms,rms_direct,rms_best_fit,rms_area_weighted,rms_nodes,newton_iterations,"
      "factorisations,solver_seconds,wall_seconds\n";
  for (const auto& row : rows) {
    text += fmt::format("{},{}", row["subdivisions"].get<int>(), row["dofs"].get<int>());
    for (const char* measure : measures)
      text += fmt::format(",{:.17g}", row["surface"][measure].get<double>());
    text += fmt::format(",{},{},{:.6g},{:.6g}\n", row["newton_iterations"].get<int>(),
                        row["factorisations"].get<int>(), row["solver_seconds"].get<double>(),
                        row["wall_seconds"].get<double>());
  }
  output::write_text(path, text);
}

output::Chart chart_of(const Json& rows) {
  output::Chart chart;
  chart.title = "Surface error against refinement";
  chart.x_label = "parts of a facet side";
  chart.y_label = "RMS [mm]";
  for (const char* measure : measures) {
    output::Curve curve{measure, {}, {}, true};
    for (const auto& row : rows) {
      curve.x.push_back(row["subdivisions"].get<double>());
      curve.y.push_back(1e3 * row["surface"][measure].get<double>());
    }
    chart.curves.push_back(curve);
  }
  return chart;
}

std::string text_of(const Json& study) {
  std::string text =
      fmt::format("{:>4} {:>9} {:>10} {:>10} {:>10} {:>10} {:>10} {:>7} {:>9} {:>9}\n", "s", "unknowns",
                  "rms", "direct", "best fit", "area", "nodes", "Newton", "MUMPS s", "wall s");
  for (const auto& row : study["rows"]) {
    text += fmt::format("{:>4} {:>9}", row["subdivisions"].get<int>(), row["dofs"].get<int>());
    for (const char* measure : measures)
      text += fmt::format(" {:>10.4f}", 1e3 * row["surface"][measure].get<double>());
    text += fmt::format(" {:>7} {:>9.2f} {:>9.2f}\n", row["newton_iterations"].get<int>(),
                        row["solver_seconds"].get<double>(), row["wall_seconds"].get<double>());
  }
  for (const auto& failed : study["failed"])
    text += fmt::format("{:>4} failed: {}\n", failed["subdivisions"].get<int>(),
                        failed["message"].get<std::string>());
  text += "(RMS in mm)\n";
  for (const char* measure : measures) {
    const auto& e = study["extrapolation"][measure];
    if (e["limit"].is_null())
      text += fmt::format("{:<20} no extrapolation: {}\n", measure, e["why_not"].get<std::string>());
    else
      text += fmt::format("{:<20} order {:.2f}, extrapolated {:.4f} mm\n", measure, e["order"].get<double>(),
                          1e3 * e["limit"].get<double>());
  }
  return text;
}

void write_study(output::RunDirectory& files, const Json& study, bool pictures, Progress& progress) {
  output::write_results(files.path("study.json"), study);
  if (!study["rows"].empty()) write_csv(files.path("study.csv"), study["rows"]);
  if (!pictures || study["rows"].size() < 2) return;
  try {
    output::draw(chart_of(study["rows"]), files.path("study.png"));
  } catch (const LibraryError& error) {
    progress.say(fmt::format("warning: no picture: {}", error.what()));
  }
}

}  // namespace

ExitCode study(const std::string& deck_path, const std::vector<std::string>& overrides,
               const std::vector<int>& subdivisions, const RunSettings& settings, Progress& progress) {
  Json study{{"format", "tautline-study"},
             {"version", 1},
             {"deck", deck_path},
             {"rows", Json::array()},
             {"failed", Json::array()}};
  output::RunDirectory files(settings.directory);
  la::on_root([&] { files.open(false); });
  ExitCode code = ExitCode::done;
  for (const int s : std::set<int>(subdivisions.begin(), subdivisions.end())) {
    progress.say(fmt::format("study: {} parts of a facet side", s));
    auto all = overrides;
    all.push_back(fmt::format("parameters.subdivisions={}", s));
    const auto deck = deck::read_deck(deck_path, all);
    const std::string directory = fmt::format("{}/s{}", settings.directory, s);
    std::string why;
    ExitCode ended = ExitCode::done;
    try {
      ended = run(deck, {directory, settings.pictures, ""}, progress);
    } catch (const ModelError& error) {
      ended = ExitCode::impossible_model;
      why = error.what();
    }
    if (ended == ExitCode::interrupted) {
      code = ended;
      break;
    }
    la::on_root([&] {
      if (ended == ExitCode::done) {
        study["rows"].push_back(row_of(output::read_results(directory + "/results.json"), s));
      } else {
        if (why.empty()) why = output::read_results(directory + "/results.json").value("reason", "");
        study["failed"].push_back({{"subdivisions", s}, {"message", why}});
      }
    });
    if (ended != ExitCode::done) code = ended;
  }
  la::on_root([&] {
    for (const char* measure : measures) study["extrapolation"][measure] = extrapolate(study, measure);
    write_study(files, study, settings.pictures, progress);
    fmt::print("{}", text_of(study));
  });
  return code;
}

}  // namespace tautline::steps
