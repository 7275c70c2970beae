/// @file
/// Runs verification cases and compares: see verification/README.md.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>

#include <fmt/format.h>
#include <sys/wait.h>

#include "case.hpp"
#include "data.hpp"
#include "page.hpp"

namespace {

using namespace verify;
namespace fs = std::filesystem;

constexpr const char* usage =
    "usage: tautline_verify [CASE...] --program TAUTLINE --source REPOSITORY --work DIRECTORY [--mpiexec "
    "COMMAND] [--reuse] [--write-docs]\n"
    "  Runs the cases (none: all) in verification/ and compares; writes their pages into the work "
    "directory.\n"
    "  --reuse: takes results that are there already; --write-docs: writes docs/ too, if every case was run "
    "and passed\n";

struct Settings {
  std::vector<std::string> cases;
  std::string program, source, work, mpiexec = "mpirun";
  bool reuse = false, write_docs = false;
};

Settings read_arguments(int argc, char** argv) {
  Settings settings;
  std::map<std::string, std::string*> values{{"--program", &settings.program},
                                             {"--source", &settings.source},
                                             {"--work", &settings.work},
                                             {"--mpiexec", &settings.mpiexec}};
  std::map<std::string, bool*> flags{{"--reuse", &settings.reuse}, {"--write-docs", &settings.write_docs}};
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (const auto value = values.find(word); value != values.end() && i + 1 < argc)
      *value->second = argv[++i];
    else if (const auto flag = flags.find(word); flag != flags.end())
      *flag->second = true;
    else if (word.rfind("--", 0) == 0)
      throw std::runtime_error("unknown option " + word);
    else
      settings.cases.push_back(word);
  }
  if (settings.program.empty() || settings.source.empty() || settings.work.empty())
    throw std::runtime_error("--program, --source and --work are needed");
  return settings;
}

std::vector<std::string> all_cases(const std::string& source) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(source + "/verification"))
    if (fs::exists(entry.path() / "expected.yaml")) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string quoted(const std::string& text) {
  return "'" + text + "'";
}

/// Runs the program as a user would. @throws std::runtime_error with the end of what it said
void perform(const Run& run, const Case& c, const Settings& settings, const std::string& directory) {
  if (settings.reuse && fs::exists(directory + "/results.json")) return;
  fs::remove_all(directory);
  fs::create_directories(directory);
  const std::string beside = c.directory + "/" + run.deck,
                    deck = fs::exists(beside) ? beside : settings.source + "/" + run.deck;
  std::string command =
      run.ranks > 1 ? fmt::format("{} -n {} --oversubscribe --bind-to none ", settings.mpiexec, run.ranks)
                    : "";
  command += fmt::format("{} run {} -o {} --quiet --no-pictures", quoted(settings.program), quoted(deck),
                         quoted(directory));
  for (const auto& o : run.overrides) command += " --set " + quoted(o);
  const std::string log = directory + ".log";
  fmt::print("{}: {}\n", run.name, command);
  std::cout.flush();
  const int status = std::system((command + " >" + quoted(log) + " 2>&1").c_str());
  if (!WIFEXITED(status) || WEXITSTATUS(status) != run.exit_code)
    throw std::runtime_error(
        fmt::format("run {} did not end with exit code {}, see {}", run.name, run.exit_code, log));
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

CaseResults run_case(const std::string& name, const Settings& settings) {
  CaseResults result{read_case(settings.source + "/verification/" + name), {}};
  const auto& c = result.the_case;
  std::map<std::string, Data> data{{"case", Data(c.directory)}};
  for (const auto& run : c.runs) {
    const std::string directory = settings.work + "/" + name + "/" + run.name;
    perform(run, c, settings, directory);
    data.emplace(run.name, Data(directory));
  }
  const Lookup lookup = [&](const std::string& reference) {
    const auto colon = reference.find(':');
    const auto found = data.find(reference.substr(0, colon));
    if (colon == std::string::npos || found == data.end())
      throw std::runtime_error(fmt::format("{{{}}} names no run", reference));
    return found->second.find(reference.substr(colon + 1));
  };
  for (const auto& quantity : c.quantities) result.results.push_back(examine(quantity, lookup));
  return result;
}

bool print(const CaseResults& results) {
  bool passed = true;
  for (const auto& r : results.results) {
    passed = passed && r.passed;
    fmt::print("  {:<58} {:>14.7g} {:>14.7g}  {:>10}  {:<14} {}\n",
               r.quantity.name + (r.quantity.unit.empty() ? "" : " [" + r.quantity.unit + "]"), r.ours,
               r.reference, difference_text(r), tolerance_text(r.quantity), verdict(r));
  }
  return passed;
}

void write(const std::string& path, const std::string& text) {
  fs::create_directories(fs::path(path).parent_path());
  std::ofstream file(path);
  file << text;
  if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

void write_pages(const std::string& directory, const std::vector<CaseResults>& cases) {
  for (const auto& c : cases)
    write(fmt::format("{}/verification/{}.md", directory, c.the_case.name), case_page(c));
  if (cases.size() > 1) write(directory + "/verification.md", overview_page(cases));
}

int run_all(const Settings& settings) {
  const bool all = settings.cases.empty();
  bool passed = true;
  std::vector<CaseResults> cases;
  for (const auto& name : all ? all_cases(settings.source) : settings.cases) {
    cases.push_back(run_case(name, settings));
    fmt::print("{}\n", name);
    passed = print(cases.back()) && passed;
  }
  write_pages(settings.work + "/docs", cases);
  if (settings.write_docs && !all) throw std::runtime_error("--write-docs is for all cases together");
  if (settings.write_docs && passed) write_pages(settings.source + "/docs", cases);
  return passed ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run_all(read_arguments(argc, argv));
  } catch (const std::exception& error) {
    std::cerr << "tautline_verify: " << error.what() << '\n' << usage;
    return 2;
  }
}
