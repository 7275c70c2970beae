/// @file
/// Makes docs/thesis.md and its pictures: see verification/thesis/README.md.

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <thread>

#include <fmt/format.h>

#include "runner.hpp"
#include "thesis_items.hpp"
#include "thesis_page.hpp"
#include "thesis_pictures.hpp"

namespace {

using namespace verify;
namespace fs = std::filesystem;

constexpr const char* usage =
    "usage: tautline_thesis --source REPOSITORY [--program TAUTLINE --work DIRECTORY [--reuse]]\n"
    "  With a program: runs it and writes docs/thesis.md and docs/thesis/. Without: checks that thesis.yaml "
    "covers every\n  figure and table, and that docs/thesis.md has them.\n";

Program read_arguments(int argc, char** argv) {
  Program program;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    std::string* value = word == "--program"  ? &program.path
                         : word == "--source" ? &program.source
                         : word == "--work"   ? &program.work
                                              : nullptr;
    if (word == "--reuse")
      program.reuse = true;
    else if (value != nullptr && i + 1 < argc)
      *value = argv[++i];
    else
      throw std::runtime_error("unknown option " + word);
  }
  if (program.source.empty() || program.path.empty() != program.work.empty())
    throw std::runtime_error("--source, or --source, --program and --work are needed");
  return program;
}

/// Data of all runs, each under the name it has in thesis.yaml and, for rows of a case, in that case.
struct AllData {
  DataByRun by_name;
  std::map<std::string, DataByRun> by_case;
};

/// Runs whose pictures are copied draw them.
bool draws(const Thesis& thesis, const std::string& name) {
  for (const auto& chapter : thesis.chapters)
    for (const auto& item : chapter.items)
      for (const auto& picture : item.pictures)
        if (picture.run == name) return true;
  return false;
}

AllData run_all(const Thesis& thesis, const Program& program, Effort& effort) {
  AllData data;
  for (const auto& c : thesis.cases) data.by_case[c.name].emplace("case", Data(c.directory));
  for (const auto& name : needed_runs(thesis)) {
    auto [the_case, run] = find_run(thesis, name);
    run.pictures = draws(thesis, name);
    const Data results(perform(run, *the_case, program));
    data.by_name.emplace(name, results);
    data.by_case[the_case->name].emplace(run.name, results);
    ++effort.runs;
  }
  return data;
}

std::vector<std::vector<Result>> examine_all(const Thesis& thesis, AllData& data) {
  std::vector<std::vector<Result>> results;
  for (const auto& chapter : thesis.chapters)
    for (const auto& item : chapter.items) {
      results.emplace_back();
      for (const auto& row : item.rows) {
        auto& runs = row.case_name == thesis.own.name ? data.by_name : data.by_case[row.case_name];
        results.back().push_back(examine(row.quantity, lookup_in(runs)));
        const auto& r = results.back().back();
        fmt::print("  {:<70} {:>12.6g} {:>12.6g}  {}\n", r.quantity.name, r.ours, r.reference, status(r));
      }
    }
  return results;
}

void draw_all(const Thesis& thesis, AllData& data, const std::string& directory) {
  fs::remove_all(directory);
  fs::create_directories(directory);
  for (const auto& chapter : thesis.chapters)
    for (const auto& item : chapter.items) {
      const auto path = [&](const std::string& file) { return fmt::format("{}/{}.png", directory, file); };
      for (const auto& chart : item.charts) draw_chart(chart, lookup_in(data.by_name), path(chart.file));
      for (const auto& view : item.views) draw_view(view, data.by_name.at(view.run), path(view.file));
      for (const auto& picture : item.pictures)
        fs::copy_file(data.by_name.at(picture.run).directory() + "/" + picture.picture + ".png",
                      path(picture.file));
    }
}

/// The time of a page made from scratch is kept beside the results, for a page that is made of them again.
void note_time(const Program& program, double seconds, Effort& effort) {
  const std::string path = program.work + "/seconds";
  if (program.reuse) {
    std::ifstream(path) >> effort.seconds;
    return;
  }
  effort.seconds = seconds;
  std::ofstream(path) << seconds << '\n';
}

int make(const Thesis& thesis, const Program& program) {
  const auto start = std::chrono::steady_clock::now();
  Effort effort;
  effort.cores = static_cast<int>(std::thread::hardware_concurrency());
  AllData data = run_all(thesis, program, effort);
  const auto results = examine_all(thesis, data);
  draw_all(thesis, data, program.source + "/docs/thesis");
  note_time(program, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), effort);
  std::ofstream file(program.source + "/docs/thesis.md");
  file << thesis_page(thesis, results, data.by_name, effort);
  if (!file.flush()) throw std::runtime_error("cannot write docs/thesis.md");
  fmt::print("docs/thesis.md: {} runs, {:.0f} s\n", effort.runs, effort.seconds);
  int code = 0;
  for (const auto& rows : results)
    for (const auto& r : rows) code = r.passed ? code : 1;
  return code;
}

/// The list and the page that was made of it: is everything there?
int check(const Thesis& thesis, const std::string& source) {
  auto found = faults(thesis);
  std::ifstream file(source + "/docs/thesis.md");
  std::stringstream page;
  page << file.rdbuf();
  const auto demand = [&](const std::string& text) {
    if (page.str().find(text) == std::string::npos)
      found.push_back(fmt::format("docs/thesis.md lacks \"{}\": make it anew", text));
  };
  const auto demand_picture = [&](const std::string& name) {
    demand(name + ".png");
    if (!fs::exists(fmt::format("{}/docs/thesis/{}.png", source, name)))
      found.push_back(fmt::format("docs/thesis/{}.png is missing", name));
  };
  for (const auto& chapter : thesis.chapters)
    for (const auto& item : chapter.items) {
      demand(item.label);
      for (const auto& row : item.rows) demand(row.quantity.name);
      for (const auto& chart : item.charts) demand_picture(chart.file);
      for (const auto& view : item.views) demand_picture(view.file);
      for (const auto& picture : item.pictures) demand_picture(picture.file);
    }
  for (const auto& fault : found) fmt::print("{}\n", fault);
  return found.empty() ? 0 : 1;
}

int act(const Program& program) {
  const Thesis thesis = read_thesis(program.source);
  if (program.path.empty()) return check(thesis, program.source);
  for (const auto& fault : faults(thesis)) fmt::print("warning: {}\n", fault);
  return make(thesis, program);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return act(read_arguments(argc, argv));
  } catch (const std::exception& error) {
    std::cerr << "tautline_thesis: " << error.what() << '\n' << usage;
    return 2;
  }
}
