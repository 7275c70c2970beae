/// @file
/// Tries damaged decks, meshes, overrides and results, and tells what the program should have refused in
/// words.
///
///   fuzz [--what decks|runs|meshes|overrides|reports]... [--count N] [--seconds S] [--seed FIRST] [--work
///   DIRECTORY]
///        [--source DIRECTORY] [--shrink SECONDS] [--tally]
///   fuzz --what KIND --seed SEED --print      the input that a seed makes
///   fuzz --what KIND --file FILE --origin SEED_FILE   an input again, e.g. a smallest one
///
/// exit code 0: nothing found; 1: something; 2: the command line is wrong.

#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <set>

#include <fmt/format.h>

#include "watch.hpp"

namespace {

using namespace tautline::fuzz;
namespace fs = std::filesystem;

struct Request {
  std::vector<std::string> what;
  int count = 1000;
  double seconds = 1e9, shrink = 30;
  std::uint64_t seed = 1;
  Places places{TAUTLINE_SOURCE_DIR, "fuzz"};
  std::string file, origin;
  bool print = false, tally = false;
};

std::optional<Request> read(int argc, char** argv) {
  Request request;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--print" || word == "--tally") {
      (word == "--print" ? request.print : request.tally) = true;
      continue;
    }
    if (i + 1 == argc) return std::nullopt;
    const std::string value = argv[++i];
    if (word == "--what")
      request.what.push_back(value);
    else if (word == "--count")
      request.count = std::stoi(value);
    else if (word == "--seconds")
      request.seconds = std::stod(value);
    else if (word == "--seed")
      request.seed = std::stoull(value);
    else if (word == "--work")
      request.places.work = value;
    else if (word == "--source")
      request.places.source = value;
    else if (word == "--shrink")
      request.shrink = std::stod(value);
    else if (word == "--file")
      request.file = value;
    else if (word == "--origin")
      request.origin = value;
    else
      return std::nullopt;
  }
  return request;
}

/// Tells a finding with the smallest input that shows it; those of a kind once.
class Reporter {
 public:
  Reporter(const Campaign& campaign, const Request& request, const Limits& limits)
      : campaign_(campaign), request_(request), limits_(limits) {}

  void operator()(const Finding& finding) {
    ++count_;
    fmt::print("FOUND {} seed {}: {}: {}\n", campaign_.name, finding.seed, finding.kind,
               finding.said.substr(0, 400));
    std::fflush(stdout);
    if (request_.shrink <= 0 || !told_.insert(finding.kind + sort_of(finding.said)).second) return;
    const Input small = smallest(campaign_, campaign_.make(finding.seed), finding, limits_, request_.shrink);
    const fs::path path = fs::path(request_.places.work) /
                          fmt::format("{}_{}{}", campaign_.name, finding.seed, campaign_.suffix);
    std::ofstream(path, std::ios::binary) << small.text;
    fmt::print("  smallest: {} ({} bytes), of {}\n  again: fuzz --what {} --file {} --origin {}\n",
               path.string(), small.text.size(), small.origin, campaign_.name, path.string(), small.origin);
    std::fflush(stdout);
  }
  int count() const { return count_; }

 private:
  const Campaign& campaign_;
  const Request& request_;
  const Limits& limits_;
  std::set<std::string> told_;
  int count_ = 0;
};

int try_file(const Campaign& campaign, const Request& request, const Limits& limits) {
  std::ifstream file(request.file, std::ios::binary);
  const Input input{{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()}, request.origin};
  const auto finding = watch_one(campaign, input, limits);
  fmt::print("{}\n", finding ? finding->kind + ": " + finding->said : "nothing found");
  return finding ? 1 : 0;
}

int try_seeds(const Campaign& campaign, const Request& request, const Limits& limits) {
  Reporter reporter(campaign, request, limits);
  const Tally tally =
      watch(campaign, request.seed, request.count, request.seconds, limits, std::ref(reporter));
  std::string ends;
  for (const auto& [end, count] : tally.ends) ends += fmt::format(", {} {}", count, end);
  fmt::print("{:<4} {:<9} {} tried{}; {} found; slowest {:.2f} s (seed {}), most memory {:.0f} MB\n",
             reporter.count() == 0 ? "ok" : "BAD", campaign.name, tally.tried, ends, reporter.count(),
             tally.slowest, tally.slowest_seed, tally.most_memory);
  if (request.tally)
    for (const auto& [sentence, count] : tally.sentences) fmt::print("{:>7} {}\n", count, sentence);
  std::fflush(stdout);
  return reporter.count() == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  auto request = read(argc, argv);
  if (!request) {
    std::cerr << "fuzz: see the head of tests/fuzz/fuzz.cpp\n";
    return 2;
  }
  fs::create_directories(request->places.work);
  request->places.work = fs::canonical(request->places.work).string();
  int result = 0;
  const Limits limits;
  for (const auto& campaign : campaigns(request->places)) {
    const auto& what = request->what;
    if (!what.empty() && std::find(what.begin(), what.end(), campaign.name) == what.end()) continue;
    if (request->print)
      std::cout << campaign.make(request->seed).text;
    else if (!request->file.empty())
      result |= try_file(campaign, *request, limits);
    else
      result |= try_seeds(campaign, *request, limits);
  }
  return result;
}
