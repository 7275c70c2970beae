/// @file
/// Runs verification cases and compares: see verification/README.md.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>

#include <fmt/format.h>

#include "case.hpp"
#include "page.hpp"
#include "runner.hpp"

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
  Program program;
  bool write_docs = false;
};

Settings read_arguments(int argc, char** argv) {
  Settings settings;
  std::map<std::string, std::string*> values{{"--program", &settings.program.path},
                                             {"--source", &settings.program.source},
                                             {"--work", &settings.program.work},
                                             {"--mpiexec", &settings.program.mpiexec}};
  std::map<std::string, bool*> flags{{"--reuse", &settings.program.reuse},
                                     {"--write-docs", &settings.write_docs}};
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
  if (settings.program.path.empty() || settings.program.source.empty() || settings.program.work.empty())
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

CaseResults run_case(const std::string& name, const Program& program) {
  CaseResults result{read_case(program.source + "/verification/" + name), {}};
  const auto& c = result.the_case;
  DataByRun data{{"case", Data(c.directory)}};
  for (const auto& run : c.runs) data.emplace(run.name, Data(perform(run, c, program)));
  for (const auto& quantity : c.quantities) result.results.push_back(examine(quantity, lookup_in(data)));
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

void write_pages(const std::string& directory, const std::vector<CaseResults>& cases,
                 const std::string& source) {
  for (const auto& c : cases)
    write(fmt::format("{}/verification/{}.md", directory, c.the_case.name), case_page(c));
  if (cases.size() > 1) write(directory + "/verification.md", overview_page(cases, source));
}

int run_all(const Settings& settings) {
  const bool all = settings.cases.empty();
  bool passed = true;
  std::vector<CaseResults> cases;
  for (const auto& name : all ? all_cases(settings.program.source) : settings.cases) {
    cases.push_back(run_case(name, settings.program));
    fmt::print("{}\n", name);
    passed = print(cases.back()) && passed;
  }
  write_pages(settings.program.work + "/docs", cases, settings.program.source);
  if (settings.write_docs && !all) throw std::runtime_error("--write-docs is for all cases together");
  if (settings.write_docs && passed)
    write_pages(settings.program.source + "/docs", cases, settings.program.source);
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
