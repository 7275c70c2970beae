/// @file
/// The command line. CLI11 is slow to compile and stays in this file.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <optional>
#include <thread>

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <tautline/core/error.hpp>
#include <tautline/core/interrupt.hpp>
#include <tautline/core/out_of_memory.hpp>
#include <tautline/deck/deck.hpp>
#include <tautline/la/session.hpp>
#include <tautline/output/report.hpp>
#include <tautline/output/run_directory.hpp>
#include <tautline/steps/parameter_study.hpp>
#include <tautline/steps/run.hpp>
#include <tautline/steps/version.hpp>

namespace {

using namespace tautline;

/// What the command line asked for.
struct Request {
  std::string deck, directory, key, kind, checkpoint;
  std::vector<std::string> overrides, directories;
  std::vector<int> subdivisions{2, 4, 6, 8};
  std::vector<std::string> over, report;
  int jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  bool quiet = false, no_pictures = false;
};

std::string directory_of(const Request& request, const std::string& suffix = "") {
  if (!request.directory.empty()) return request.directory;
  return "results/" + std::filesystem::path(request.deck).stem().string() + suffix;
}

Progress::Mode progress_mode(const Request& request) {
  return request.quiet || la::rank() != 0 ? Progress::Mode::silent : Progress::detect();
}

int run(const Request& request) {
  Progress progress(progress_mode(request));
  const auto deck = deck::read_deck(request.deck, request.overrides);
  return static_cast<int>(
      steps::run(deck, {directory_of(request), !request.no_pictures, request.checkpoint}, progress));
}

int study(const Request& request) {
  Progress progress(progress_mode(request));
  return static_cast<int>(steps::study(request.deck, request.overrides, request.subdivisions,
                                       {directory_of(request, "_study"), !request.no_pictures, ""},
                                       progress));
}

int study_parameters(const Request& request) {
  steps::ParameterStudy wanted{request.deck, request.overrides, {}, {}, request.jobs};
  for (const auto& text : request.over) wanted.over.push_back(steps::read_range(text));
  for (const auto& text : request.report) wanted.quantities.push_back(steps::read_quantity(text));
  Progress progress(progress_mode(request));
  return static_cast<int>(
      steps::study_parameters(wanted, {directory_of(request, "_study"), !request.no_pictures, ""}, progress));
}

int report(const Request& request) {
  const std::string& directory = request.directories.front();
  output::RunDirectory files(directory);
  if (std::filesystem::exists(directory + "/results.json")) {  // else nothing is written there
    files.open(true);
    for (const char* name : {"report.html", "comparison.html"}) files.path(name);
  }
  std::cout << output::write_report(request.directories) << '\n';
  return 0;
}

int check(const Request& request) {
  const std::string text = steps::check(deck::read_deck(request.deck, request.overrides));
  if (la::rank() == 0) std::cout << text;
  return 0;
}

/// Exit code and message of whatever came out. Deck errors are the same on every rank: rank 0 tells them.
int report_failure(const std::string& message, ExitCode code) {
  if (la::rank() != 0) return static_cast<int>(code);
  if (message.empty() || message.back() != '\n')
    std::cerr << message << '\n';
  else
    std::cerr << message;
  return static_cast<int>(code);
}

int guarded(const std::function<int()>& action) {
  try {
    return action();
  } catch (const DeckError& error) {
    return report_failure(error.what(), ExitCode::bad_deck);
  } catch (const ModelError& error) {
    return report_failure(fmt::format("error: {}", error.what()), ExitCode::impossible_model);
  } catch (const LibraryError& error) {
    return report_failure(fmt::format("error: {}", error.what()), ExitCode::library_failed);
  } catch (const std::exception& error) {
    if (is_out_of_memory(error))
      return report_failure(fmt::format("error: {}", text_of(error)), ExitCode::library_failed);
    return report_failure(
        fmt::format("internal error: {}\nThis is a bug, please report it with the deck.", error.what()),
        ExitCode::bug);
  }
}

/// Runs with the libraries started; until a run begins, which watches Ctrl-C, it ends the process. A failure
/// that only one rank may have met ends all of them.
int in_session(const std::function<int()>& action) {
  std::optional<la::Session> session;
  const int began = guarded([&] {
    session.emplace();
    return 0;
  });
  if (began != 0) return began;
  end_at_interrupt();
  const int code = guarded(action);
  if (code >= static_cast<int>(ExitCode::library_failed) && code != static_cast<int>(ExitCode::interrupted) &&
      la::size() > 1)
    la::abort_all_ranks(code);
  return code;
}

/// Runs side by side are processes of their own, which MPI does not allow once it was started here.
int any_study(const Request& request) {
  if (request.over.empty()) return in_session([&] { return study(request); });
  if (la::launched_by_mpirun()) return in_session([&] { return study_parameters(request); });
  watch_for_interrupt(1.9);  // longer than its runs
  return guarded([&] { return study_parameters(request); });
}

void add_study_options(CLI::App& command, Request& request) {
  auto* subdivisions = command.add_option("--subdivisions", request.subdivisions,
                                          "parts of each facet side: surface error and time against them");
  subdivisions->delimiter(',');
  command
      .add_option(
          "--over", request.over,
          "a parameter of the deck, or a path, and its values: rings=8,10,12; several: every combination")
      ->allow_extra_args(false)
      ->excludes(subdivisions);
  command
      .add_option("--report", request.report,
                  "with --over: what to report, a path into results.json, best with a label: "
                  "\"RMS [m]=/steps/tuning/surface/rms\"")
      ->allow_extra_args(false);
  command.add_option("--jobs", request.jobs, "with --over: runs side by side (default: as many as cores)")
      ->check(CLI::Range(1, 1024));
}

void add_deck_options(CLI::App& command, Request& request) {
  command.add_option("deck", request.deck, "the deck, a YAML file")->required();
  command.add_option("--set", request.overrides, "change a value of the deck: path.to.key=value")
      ->allow_extra_args(false);
}

void add_run_options(CLI::App& command, Request& request) {
  add_deck_options(command, request);
  command.add_option("-o,--output", request.directory, "where results go (default: results/<deck name>)");
  command.add_flag("--quiet", request.quiet, "no progress on stderr");
  command.add_flag("--no-pictures", request.no_pictures, "draw no PNG pictures");
}

/// Words that reach nobody (a full disk behind stdout) are a failure, too.
int told(int result) {
  std::cout.flush();
  if (std::cout || result != 0) return result;
  std::cerr << "error: what there is to say cannot be written to the standard output\n";
  return static_cast<int>(ExitCode::library_failed);
}

/// A standard stream that is closed would be the next file that is opened, and what is said would be written
/// into it. Instead nothing comes from it, or goes to it; to the standard output in vain, which is told.
void hold_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0 &&
        open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY) != stream)
      std::_Exit(static_cast<int>(ExitCode::library_failed));
}

int command(int argc, char** argv) {
  CLI::App app{"tautline: form-finding and nonlinear analysis of cable-shell structures"};
  app.set_version_flag("--version", std::string("tautline ") + tautline::steps::version());
  app.require_subcommand(1);
  Request request;
  int result = 0;
  const auto on = [&](CLI::App* command, int (*action)(const Request&)) {
    command->callback([&result, &request, action] { result = guarded([&] { return action(request); }); });
  };
  const auto on_ranks = [&](CLI::App* command, int (*action)(const Request&)) {
    command->callback([&result, &request, action] { result = in_session([&] { return action(request); }); });
  };

  auto* run_command = app.add_subcommand("run", "run a deck");
  add_run_options(*run_command, request);
  run_command->add_option(
      "--from", request.checkpoint,
      "go on from the checkpoints in this directory of results, also with a deck of which "
      "only later steps differ");
  run_command->footer(
      "Example: tautline run inputs/perimeter_truss_12m.yaml --set parameters.subdivisions=8");
  on_ranks(run_command, run);

  auto* check_command = app.add_subcommand(
      "check", "tell every error of a deck, and what would make its solve fail; solves nothing");
  add_deck_options(*check_command, request);
  check_command->footer("Example: tautline check inputs/perimeter_truss_12m.yaml");
  on_ranks(check_command, check);

  auto* study_command =
      app.add_subcommand("study", "run a deck with several values of its parameters and compare");
  add_run_options(*study_command, request);
  add_study_options(*study_command, request);
  study_command->footer(
      "Example: tautline study inputs/perimeter_truss_12m.yaml --subdivisions 2,4,6,8\n"
      "         tautline study inputs/perimeter_truss_12m.yaml --over reflector.rings=8,10 --over "
      "subdivisions=2,4");
  study_command->callback([&] { result = any_study(request); });

  auto* new_command = app.add_subcommand("new", "print a commented starting deck");
  new_command
      ->add_option("kind", request.kind, "perimeter-truss, umbrella, net, membrane, frame or rod-umbrella")
      ->required();
  new_command->footer("Example: tautline new net > net.yaml");
  on(new_command, [](const Request& r) {
    std::cout << deck::starting_deck(r.kind);
    return 0;
  });

  auto* explain_command = app.add_subcommand("explain", "tell what a deck key means");
  explain_command->add_option("key", request.key, "the key, e.g. reflector.gap; none: all keys");
  explain_command->footer("Example: tautline explain reflector.gap");
  on(explain_command, [](const Request& r) {
    std::cout << deck::explain(r.key);
    return 0;
  });

  auto* schema_command =
      app.add_subcommand("schema", "print the JSON schema of the deck, for an editor's completion");
  schema_command->footer("Example: tautline schema > tautline.schema.json");
  on(schema_command, [](const Request&) {
    std::cout << deck::schema();
    return 0;
  });

  auto* report_command =
      app.add_subcommand("report", "(re)build report.html; several directories: side by side");
  report_command->add_option("directories", request.directories, "result directories")->required();
  report_command->footer("Example: tautline report results/perimeter_truss_12m");
  on(report_command, report);

  auto* compare_command =
      app.add_subcommand("compare", "compare surface error, tensions, frequencies and time of runs");
  compare_command->add_option("directories", request.directories, "result directories")
      ->required()
      ->expected(2, 1000);
  compare_command->footer("Example: tautline compare results/a results/b");
  on(compare_command, [](const Request& r) {
    std::cout << output::comparison_text(r.directories);
    return 0;
  });

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return code == 0 ? 0 : static_cast<int>(ExitCode::bad_deck);
  }
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  hold_standard_streams();
  return told(command(argc, argv));
}
