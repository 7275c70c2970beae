#include <tautline/steps/parameter_study.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include <fmt/format.h>

#include <tautline/core/interrupt.hpp>
#include <tautline/core/text.hpp>
#include <tautline/la/session.hpp>
#include <tautline/output/pointer.hpp>
#include <tautline/output/results.hpp>
#include <tautline/output/run_directory.hpp>

#include "steps/context.hpp"
#include "steps/processes.hpp"
#include "steps/study_report.hpp"

namespace tautline::steps {

namespace {

[[noreturn]] void refuse(const std::string& option, std::string message, std::string expectation,
                         std::string suggestion = "") {
  Diagnostic diagnostic;
  diagnostic.where.file = option;
  diagnostic.message = std::move(message);
  diagnostic.expectation = std::move(expectation);
  diagnostic.suggestion = std::move(suggestion);
  throw DeckError({diagnostic});
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

/// A name without a dot is one of the deck's parameters.
std::string path_of(const std::string& name) {
  return name.find('.') == std::string::npos ? "parameters." + name : name;
}

/// Every name without a dot has to be there, before anything is run.
void demand_parameters(const ParameterStudy& study) {
  const auto deck = deck::read_deck(study.deck, study.overrides);
  std::vector<std::string> known;
  for (const auto& entry : deck.parameters) known.push_back(entry.first);
  for (const auto& range : study.over) {
    if (range.name.find('.') != std::string::npos ||
        std::find(known.begin(), known.end(), range.name) != known.end())
      continue;
    refuse("--over " + range.name, fmt::format("the deck has no parameter \"{}\"", range.name),
           known.empty() ? "the deck declares no parameters; a path such as reflector.struts goes as well"
                         : "expected one of: " + join(known) + "; or a path such as reflector.struts",
           nearest(range.name, known).empty()
               ? ""
               : fmt::format("did you mean \"{}\"?", nearest(range.name, known)));
  }
}

std::string last_lines(const std::string& file) {
  std::ifstream stream(file);
  std::string text, line;
  while (std::getline(stream, line))
    if (!line.empty()) text += (text.empty() ? "" : "\n") + line;
  return text;
}

/// One row before its run: what is set, and where results go.
Json start_row(const ParameterStudy& study, const std::vector<std::string>& set,
               const std::string& directory) {
  Json parameters = Json::object();
  std::string name;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const std::string value = set[i].substr(set[i].find('=') + 1);
    parameters[study.over[i].name] = value;
    name += fmt::format("{}{}={}", i > 0 ? "," : "", study.over[i].name, value);
  }
  std::replace(name.begin(), name.end(), '/', '_');
  return {{"parameters", parameters}, {"directory", directory + "/" + name}, {"status", "interrupted"}};
}

/// Why a run did not come to its end: the reason it left, else what it said.
std::string failure(const std::string& directory, int code) {
  const std::string results = directory + "/results.json", log = directory + ".log";
  if (std::filesystem::exists(results)) {
    const Json left = output::read_results(results);
    if (left.value("status", "") != "done") return left.value("reason", "");
  }
  const std::string said = std::filesystem::exists(log) ? last_lines(log) : "";
  return said.empty() ? fmt::format("ended with exit code {}", code) : said;
}

void note_outcome(Json& row, int code) {
  row["exit_code"] = code;
  row["status"] = code == 0                                         ? "done"
                  : code == static_cast<int>(ExitCode::interrupted) ? "interrupted"
                                                                    : "failed";
  if (code != 0) row["message"] = failure(row["directory"], code);
}

/// What is worth reporting of a run when nothing was asked for.
std::vector<StudyQuantity> usual_quantities(const Json& results) {
  std::string surface, frequency;
  for (const auto& step : results["steps"]) {
    const std::string path = "/steps/" + step["name"].get<std::string>();
    if (step.contains("surface")) surface = path + "/surface/rms";
    if (step.contains("frequencies")) frequency = path + "/frequencies/0";
  }
  std::vector<StudyQuantity> quantities;
  if (!surface.empty()) quantities.push_back({"RMS [m]", surface});
  quantities.push_back({"mass [kg]", "/model/mass"});
  if (!frequency.empty()) quantities.push_back({"f1 [Hz]", frequency});
  quantities.push_back({"time [s]", "/wall_seconds"});
  return quantities;
}

/// One number of results.json, or null and a word about why.
Json value_at(const Json& results, const StudyQuantity& quantity, std::string& trouble) {
  try {
    const auto numbers = output::numbers_at(results, quantity.path);
    if (numbers.size() == 1) return numbers[0];
    trouble = fmt::format("{} has {} values: end the path with an index, first or last", quantity.path,
                          numbers.size());
  } catch (const std::exception& error) {
    trouble = fmt::format("{}: {}", quantity.path, error.what());
  }
  return nullptr;
}

void gather(ParameterStudy& study, Json& rows, Progress& progress) {
  for (auto& row : rows) {
    row["values"] = Json::object();
    if (row["status"] != "done") continue;
    const Json results = output::read_results(row["directory"].get<std::string>() + "/results.json");
    if (study.quantities.empty()) study.quantities = usual_quantities(results);
    for (const auto& quantity : study.quantities) {
      std::string trouble;
      row["values"][quantity.label] = value_at(results, quantity, trouble);
      if (!trouble.empty()) {
        row["message"] = trouble;
        progress.say("warning: " + trouble);
      }
    }
  }
}

void run_beside(const ParameterStudy& study, const std::vector<std::vector<std::string>>& sets, Json& rows,
                const RunSettings& settings, Progress& progress) {
  std::vector<Command> commands;
  for (std::size_t i = 0; i < sets.size(); ++i) {
    const std::string directory = rows[i]["directory"];
    Command command{{own_program(), "run", study.deck, "-o", directory, "--quiet"}, directory + ".log"};
    if (!settings.pictures) command.words.emplace_back("--no-pictures");
    for (const auto& list : {study.overrides, sets[i]})
      for (const auto& set : list) command.words.insert(command.words.end(), {"--set", set});
    output::RunDirectory(directory).open(false);  // what an earlier study left is not of a run that fails
    commands.push_back(std::move(command));
  }
  progress.say(fmt::format("study: {} runs, {} at a time", commands.size(), study.jobs));
  std::size_t n_ended = 0;
  const auto codes = run_side_by_side(commands, study.jobs, [&](std::size_t i) {
    progress.say(fmt::format("study: {} of {} done: {}", ++n_ended, commands.size(),
                             rows[i]["directory"].get<std::string>()));
  });
  for (std::size_t i = 0; i < codes.size(); ++i) note_outcome(rows[i], codes[i]);
}

/// One after the other in this process, which is one of several ranks. Collective.
void run_here(const ParameterStudy& study, const std::vector<std::vector<std::string>>& sets, Json& rows,
              const RunSettings& settings, Progress& progress) {
  for (std::size_t i = 0; i < sets.size() && !la::true_on_any_rank(interrupt_requested()); ++i) {
    auto all = study.overrides;
    all.insert(all.end(), sets[i].begin(), sets[i].end());
    const std::string directory = rows[i]["directory"];
    try {
      note_outcome(rows[i], static_cast<int>(run(deck::read_deck(study.deck, all),
                                                 {directory, settings.pictures, ""}, progress)));
    } catch (const DeckError& error) {
      rows[i].update({{"status", "failed"}, {"message", error.what()}});
    } catch (const ModelError& error) {
      rows[i].update({{"status", "failed"}, {"message", error.what()}});
    }
  }
}

ExitCode verdict(const Json& rows) {
  ExitCode code = ExitCode::done;
  for (const auto& row : rows) {
    if (row["status"] == "interrupted") return ExitCode::interrupted;
    if (row["status"] != "done") code = ExitCode::not_converged;
  }
  return code;
}

void report(ParameterStudy study, Json rows, const RunSettings& settings, output::RunDirectory& files,
            Progress& progress) {
  gather(study, rows, progress);
  Json over = Json::object(), quantities = Json::object();
  for (const auto& range : study.over) over[range.name] = range.values;
  for (const auto& quantity : study.quantities) quantities[quantity.label] = quantity.path;
  output::write_results(files.path("study.json"), {{"format", "tautline-study"},
                                                   {"version", 1},
                                                   {"deck", study.deck},
                                                   {"over", over},
                                                   {"quantities", quantities},
                                                   {"rows", rows}});
  output::write_text(files.path("study.csv"), study_csv(study, rows));
  if (settings.pictures) draw_study(study, rows, files, progress);
  std::cout << study_text(study, rows) << std::flush;
}

}  // namespace

StudyRange read_range(const std::string& text) {
  const auto equals = text.find('=');
  const bool whole = equals != std::string::npos && equals > 0;
  StudyRange range{text.substr(0, whole ? equals : 0), split(whole ? text.substr(equals + 1) : "", ',')};
  const bool gap =
      std::any_of(range.values.begin(), range.values.end(), [](const auto& v) { return v.empty(); });
  if (!whole || range.values.empty() || gap)
    refuse("--over " + text, "this is no list of values",
           "expected parameter=value,value,..., e.g. rings=8,10");
  return range;
}

StudyQuantity read_quantity(const std::string& text) {
  const auto equals = text.find("=/");
  const bool labelled = equals != std::string::npos && equals > 0;
  if (!labelled && text.rfind('/', 0) != 0)
    refuse("--report " + text, "this is no path into results.json",
           "expected a path or label=path, e.g. RMS=/steps/tuning/surface/rms");
  return labelled ? StudyQuantity{text.substr(0, equals), text.substr(equals + 1)}
                  : StudyQuantity{text, text};
}

std::vector<std::vector<std::string>> combinations(const std::vector<StudyRange>& over) {
  std::vector<std::vector<std::string>> all{{}};
  for (const auto& range : over) {
    std::vector<std::vector<std::string>> longer;
    for (const auto& begun : all)
      for (const auto& value : range.values) {
        longer.push_back(begun);
        longer.back().push_back(path_of(range.name) + "=" + value);
      }
    all = std::move(longer);
  }
  return all;
}

ExitCode study_parameters(const ParameterStudy& study, const RunSettings& settings, Progress& progress) {
  demand_parameters(study);
  const auto sets = combinations(study.over);
  Json rows = Json::array();
  for (const auto& set : sets) rows.push_back(start_row(study, set, settings.directory));
  const bool on_ranks = la::started();
  output::RunDirectory files(settings.directory);
  if (!on_ranks) {
    files.open(false);
    run_beside(study, sets, rows, settings, progress);
    report(study, rows, settings, files, progress);
  } else {
    la::on_root([&] { files.open(false); });
    run_here(study, sets, rows, settings, progress);
    la::on_root([&] { report(study, rows, settings, files, progress); });
  }
  return verdict(rows);
}

}  // namespace tautline::steps
