#include "runner.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include <fmt/format.h>
#include <sys/wait.h>

namespace verify {

namespace fs = std::filesystem;

namespace {

std::string quoted(const std::string& text) {
  return fmt::format("'{}'", text);
}

std::string command_line(const Run& run, const Case& c, const Program& program,
                         const std::string& directory) {
  const std::string beside = c.directory + "/" + run.deck,
                    deck = fs::exists(beside) ? beside : program.source + "/" + run.deck;
  std::string command =
      run.ranks > 1 ? fmt::format("{} -n {} --oversubscribe --bind-to none ", program.mpiexec, run.ranks)
                    : "";
  command += fmt::format("{} {} {} -o {} --quiet", quoted(program.path), run.study.empty() ? "run" : "study",
                         quoted(deck), quoted(directory));
  for (const auto& argument : run.study) command += fmt::format(" {}", quoted(argument));
  command += run.pictures ? " --set output.picture_width=800" : " --no-pictures";
  for (const auto& o : run.overrides) command += fmt::format(" --set {}", quoted(o));
  return command;
}

bool passes(const Result& r) {
  const auto& q = r.quantity;
  if (!std::isfinite(r.ours) || !std::isfinite(r.reference)) return false;
  switch (q.check) {
    case Check::at_most:
      return r.ours <= r.reference;
    case Check::at_least:
      return r.ours >= r.reference;
    case Check::report_only:
      return true;
    case Check::equal:
      break;
  }
  return std::abs(r.ours - r.reference) <=
         q.relative.value_or(0) * std::abs(r.reference) + q.absolute.value_or(0);
}

/// Deviations of more than 5 % from what was published or computed elsewhere have to be explained.
std::string missing_explanation(const Result& r) {
  const auto& q = r.quantity;
  const bool elsewhere = q.origin == Origin::published || q.origin == Origin::other_code;
  const bool compared = q.check == Check::equal || q.check == Check::report_only;
  if (!elsewhere || !compared || !q.note.empty() ||
      std::abs(r.ours - r.reference) <= 0.05 * std::abs(r.reference))
    return {};
  return q.absolute ? "" : "deviates by more than 5 % without a note that explains it";
}

}  // namespace

std::string perform(const Run& run, const Case& c, const Program& program) {
  const std::string directory = fmt::format("{}/{}/{}", program.work, c.name, run.name);
  const char* left = run.study.empty() ? "/results.json" : "/study.json";
  if (program.reuse && fs::exists(directory + left)) return directory;
  fs::remove_all(directory);
  fs::create_directories(directory);
  const std::string command = command_line(run, c, program, directory), log = directory + ".log";
  fmt::print("{}: {}\n", run.name, command);
  std::cout.flush();
  const int status = std::system((command + " >" + quoted(log) + " 2>&1").c_str());
  if (!WIFEXITED(status) || WEXITSTATUS(status) != run.exit_code)
    throw std::runtime_error(
        fmt::format("run {} did not end with exit code {}, see {}", run.name, run.exit_code, log));
  return directory;
}

Lookup lookup_in(DataByRun& data) {
  return [&data](const std::string& reference) {
    const auto colon = reference.find(':');
    const auto found = data.find(reference.substr(0, colon));
    if (colon == std::string::npos || found == data.end())
      throw std::runtime_error(fmt::format("{{{}}} names no run", reference));
    return found->second.find(reference.substr(colon + 1));
  };
}

Result examine(const Quantity& quantity, const Lookup& lookup) {
  Result r{quantity, 0, 0, false, {}};
  try {
    r.ours = evaluate_number(quantity.value, lookup);
    r.reference = evaluate_number(quantity.reference, lookup);
    r.problem = missing_explanation(r);
    r.passed = r.problem.empty() && passes(r);
  } catch (const std::exception& error) {
    r.problem = error.what();
  }
  return r;
}

}  // namespace verify
