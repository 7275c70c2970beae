/// @file
/// Runs relations on random structures and tells which do not hold, each with the smallest deck that shows
/// it.
///
///   metamorphic [--relation NAME]... [--count N] [--seed FIRST] [--work DIRECTORY] [--shrink SECONDS]
///   metamorphic --relation NAME --seed SEED --deck FILE.json     one structure again, e.g. a smallest one
///   metamorphic --list
///
/// --mpiexec COMMAND starts two processes where a relation wants them; --run-files LIST is what they do.
///
/// exit code 0: every relation holds; 1: not; 2: the command line is wrong.

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>

#include <fmt/format.h>

#include <tautline/la/session.hpp>

#include "trial.hpp"

namespace {

using namespace tautline;
using namespace tautline::metamorphic;
namespace fs = std::filesystem;

constexpr double most_discarded = 0.2;  // of all structures, else a relation shows little

struct Request {
  std::vector<std::string> relations;
  int count = 50;
  std::uint64_t seed = 1;
  std::string work = "metamorphic", deck, files;
  double shrink = 20;  ///< seconds for each failure
  bool list = false;
};

std::optional<Request> read(int argc, char** argv) {
  Request request;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--list") {
      request.list = true;
      continue;
    }
    if (i + 1 == argc) return std::nullopt;
    const std::string value = argv[++i];
    if (word == "--relation")
      request.relations.push_back(value);
    else if (word == "--count")
      request.count = std::stoi(value);
    else if (word == "--seed")
      request.seed = std::stoull(value);
    else if (word == "--work")
      request.work = value;
    else if (word == "--deck")
      request.deck = value;
    else if (word == "--mpiexec")
      launcher().mpiexec = value;
    else if (word == "--run-files")
      request.files = value;
    else if (word == "--shrink")
      request.shrink = std::stod(value);
    else
      return std::nullopt;
  }
  return request;
}

void save(const fs::path& path, const std::string& text) {
  std::ofstream(path) << text;
}

void print_differences(const Verdict& verdict) {
  if (!verdict.ends.empty()) fmt::print("  ends: {}\n", verdict.ends);
  constexpr std::size_t most = 6;
  for (std::size_t i = 0; i < std::min(most, verdict.differences.size()); ++i)
    if (verdict.differences[i].measure > 1)
      fmt::print("  {:>9.3g} x allowed  {}\n", verdict.differences[i].measure, verdict.differences[i].what);
}

/// Makes the deck as small as it gets, prints it and leaves it where it can be run again.
void report(const Relation& relation, const Json& deck, std::uint64_t seed, Runner& runner,
            const Request& request, const Verdict& verdict) {
  fmt::print("FAILS {} seed {}\n", relation.name, seed);
  print_differences(verdict);
  const Json small = request.shrink > 0 ? smallest(relation, deck, seed, runner, request.shrink) : deck;
  const auto last = try_relation(relation, small, seed, runner);
  const fs::path directory = fs::path(request.work) / "failures" / fmt::format("{}_{}", relation.name, seed);
  fs::create_directories(directory);
  save(directory / "structure.json", small.dump(1));
  for (std::size_t i = 0; i < last.trial.jobs.size(); ++i)
    save(directory / fmt::format("job_{}.yaml", i + 1), yaml(last.trial.jobs[i].deck));
  fmt::print("  smallest deck (with what the relation makes of it in {}/job_*.yaml):\n", directory.string());
  print_differences(last);
  fmt::print("{}  again: metamorphic --relation {} --seed {} --deck {}/structure.json --count 1\n\n",
             yaml(small), relation.name, seed, directory.string());
  std::fflush(stdout);
}

/// How one relation fared.
struct Tally {
  int holds = 0, fails = 0, discarded = 0, does_not_apply = 0, runs = 0;
  double worst = 0, seconds = 0;
  bool well() const {
    const int n = holds + fails + discarded;
    return fails == 0 && holds > 0 && discarded <= most_discarded * n && does_not_apply <= n;
  }
};

Json structure(const Relation& relation, const Request& request, std::uint64_t seed) {
  if (!request.deck.empty()) return Json::parse(std::ifstream(request.deck));
  Random random(seed, relation.name);
  return relation.make(random);
}

/// Decks that a relation runs on two ranks.
std::vector<Json> decks_for_two_ranks(const Relation& relation, const Request& request) {
  std::vector<Json> decks;
  for (int i = 0; i < request.count; ++i) {
    const std::uint64_t seed = request.seed + static_cast<std::uint64_t>(i);
    Random again(seed, relation.name + " again");
    if (const auto trial = relation.derive(structure(relation, request, seed), again))
      for (const auto& job : trial->jobs)
        if (job.way == Job::Way::two_ranks) decks.push_back(job.deck);
  }
  return decks;
}

Tally try_all(const Relation& relation, const Request& request, Runner& runner) {
  const auto start = std::chrono::steady_clock::now();
  Tally tally;
  constexpr int most_reported = 3;
  for (int i = 0; i < request.count; ++i) {
    const std::uint64_t seed = request.seed + static_cast<std::uint64_t>(i);
    const Json deck = structure(relation, request, seed);
    const auto verdict = try_relation(relation, deck, seed, runner);
    tally.runs += static_cast<int>(verdict.trial.jobs.size());
    if (verdict.kind == Verdict::Kind::holds) {
      ++tally.holds;
      tally.worst = std::max(tally.worst, verdict.worst());
    }
    if (verdict.kind == Verdict::Kind::void_) ++tally.does_not_apply;
    if (verdict.kind == Verdict::Kind::discarded) {
      ++tally.discarded;
      fmt::print("discarded {} seed {}: {}\n", relation.name, seed, verdict.ends);
    }
    if (verdict.fails() && ++tally.fails <= most_reported)
      report(relation, deck, seed, runner, request, verdict);
    if (verdict.fails() && tally.fails > most_reported) {
      fmt::print("FAILS {} seed {}\n", relation.name, seed);
      print_differences(verdict);
    }
  }
  tally.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  fmt::print(
      "{:<4} {:<24} {:>4} hold, {:>3} fail, {:>3} discarded, {:>3} do not apply; largest difference {:.2g} "
      "of what is allowed; "
      "{} runs, {:.1f} s\n",
      tally.well() ? "ok" : "BAD", relation.name, tally.holds, tally.fails, tally.discarded,
      tally.does_not_apply, tally.worst, tally.runs, tally.seconds);
  std::fflush(stdout);
  return tally;
}

int run(const Request& request) {
  std::vector<std::pair<const Relation*, Runner>> chosen;
  for (const auto& relation : relations()) {
    const auto& wanted = request.relations;
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), relation.name) == wanted.end()) continue;
    chosen.emplace_back(&relation, Runner(request.work + "/" + relation.name));
    if (const auto decks = decks_for_two_ranks(relation, request); !decks.empty())
      chosen.back().second.run_on_two_ranks(decks);
  }
  if (chosen.empty()) {
    fmt::print(stderr, "metamorphic: no relation of that name; --list names them\n");
    return 2;
  }
  const la::Session session;
  bool well = true;
  for (auto& [relation, runner] : chosen) well = try_all(*relation, request, runner).well() && well;
  return well ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const auto request = read(argc, argv);
  if (!request) {
    fmt::print(stderr, "metamorphic: see the head of verification/metamorphic/metamorphic.cpp\n");
    return 2;
  }
  launcher().program = fs::canonical("/proc/self/exe").string();
  if (!request->files.empty()) {
    const la::Session session;
    run_files(request->files);
    return 0;
  }
  if (request->list) {
    for (const auto& relation : relations()) fmt::print("{}\n", relation.name);
    return 0;
  }
  return run(*request);
}
