#include "outcome.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include <fmt/format.h>
#include <unistd.h>

#include <tautline/core/error.hpp>
#include <tautline/deck/deck.hpp>
#include <tautline/la/session.hpp>
#include <tautline/output/results.hpp>
#include <tautline/steps/run.hpp>

namespace tautline::metamorphic {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',')
      cells.emplace_back();
    else
      cells.back() += c;
  }
  return cells;
}

/// Rows of a table by column; names hold no commas here.
class Table {
 public:
  explicit Table(const std::string& path) {
    std::ifstream file(path);
    std::string line;
    if (!std::getline(file, line)) return;
    header_ = split(line);
    while (std::getline(file, line)) rows_.push_back(split(line));
  }
  std::size_t size() const { return rows_.size(); }
  const std::string& text(std::size_t row, const std::string& column) const {
    const auto at = std::find(header_.begin(), header_.end(), column) - header_.begin();
    return rows_.at(row).at(static_cast<std::size_t>(at));
  }
  double number(std::size_t row, const std::string& column) const {
    return std::strtod(text(row, column).c_str(), nullptr);
  }
  Vec3 vector(std::size_t row, const char* x, const char* y, const char* z) const {
    return {number(row, x), number(row, y), number(row, z)};
  }

 private:
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
};

/// Reads the files of one run.
class Reading {
 public:
  Reading(const Json& deck, std::string directory) : deck_(deck), directory_(std::move(directory)) {
    if (!deck.contains("model")) return;
    for (const auto& item : deck["model"]["nodes"].items()) names_.push_back(item.key());
    outcome_.size = size_of(deck);
    outcome_.stiffness = stiffness_of(deck);
  }

  Outcome read() {
    const Json results = output::read_results(path("results.json"));
    int index = 0;
    for (const auto& step : results["steps"]) read_step(step, fmt::format("step {} ", ++index));
    for (const auto& warning : results["warnings"]) outcome_.warnings.insert(warning["code"]);
    if (results.contains("model") && results["model"]["mass"].is_number())
      scalar("mass", results["model"]["mass"], "kg");
    if (!fs::exists(path("nodes.csv"))) return outcome_;
    read_nodes();
    read_reactions();
    read_cables();
    read_beams();
    read_membranes();
    read_shells();
    forget_unnamed();
    return outcome_;
  }

 private:
  std::string path(const std::string& file) const { return directory_ + "/" + file; }

  std::string name(int id) const {
    const auto index = static_cast<std::size_t>(id) - 1;
    return index < names_.size() ? names_[index] : fmt::format("#{}", id);
  }

  void scalar(const std::string& key, double value, const std::string& unit) {
    outcome_.numbers[key] = Quantity::scalar(value, unit);
  }
  void scalar(const std::string& key, const Json& value, const std::string& unit) {
    if (value.is_number()) scalar(key, value.get<double>(), unit);
  }
  void vector(const std::string& key, const Vec3& value, Nature nature, const std::string& unit) {
    outcome_.numbers[key] = {nature, unit, value};
  }

  /// Nodes that the program adds, at arms and released ends, are in an order of its own.
  void forget_unnamed() {
    if (names_.empty()) return;
    std::erase_if(outcome_.numbers,
                  [](const auto& item) { return item.first.find('#') != std::string::npos; });
  }

  void read_step(const Json& step, const std::string& prefix) {
    if (step.contains("groups"))
      for (const auto& [group, entry] : step["groups"].items())
        read_group(entry, prefix + "group " + group + " ");
    if (step.contains("reactions"))
      for (const auto& [support, entry] : step["reactions"].items()) {
        vector(prefix + "reaction " + support, to_vec3(entry["force"]), Nature::polar, "N");
        if (entry.contains("moment"))
          vector(prefix + "reaction moment " + support, to_vec3(entry["moment"]), Nature::axial, "N m");
      }
    if (step.contains("stages") && !step["stages"].empty())
      scalar(prefix + "negative pivots", step["stages"].back()["negative_pivots"], "count");
    list(step, prefix, "frequencies", "Hz");
    list(step, prefix, "factors", "factor");
    if (step.contains("slack_at_first_factor")) outcome_.warnings.insert("slack_at_first_factor");
    list(step, prefix, "critical_loads", "critical N");
    for (const char* key : {"critical_lambda", "bifurcation_lambda", "limit_lambda"})
      if (step.contains(key)) scalar(prefix + key, step[key], "factor");
    if (step.contains("surface"))
      for (const char* key :
           {"rms", "mean_shift", "rms_direct", "rms_area_weighted", "rms_nodes", "rms_best_fit"})
        scalar(prefix + "surface " + key, step["surface"][key], "surface m");
    if (step.contains("path")) read_path(step["path"], prefix);
  }

  void list(const Json& step, const std::string& prefix, const std::string& key, const std::string& unit) {
    if (!step.contains(key)) return;
    int index = 0;
    for (const auto& value : step[key]) scalar(fmt::format("{}{} {}", prefix, key, ++index), value, unit);
  }

  void read_group(const Json& group, const std::string& prefix) {
    const bool is_shell = group.contains("principal_max") && group.contains("moment_max");
    for (const auto& [key, value] : group.items()) {
      if (key.rfind("tension_m", 0) == 0 || key.rfind("axial", 0) == 0) scalar(prefix + key, value, "N");
      if (key.rfind("principal", 0) == 0) scalar(prefix + key, value, "N/m");
      if (key == "moment_max") scalar(prefix + key, value, is_shell ? "N m/m" : "N m");
    }
  }

  void read_path(const Json& path, const std::string& prefix) {
    if (path.empty()) return;
    const Json& last = path.back();
    scalar(prefix + "lambda", last["lambda"], "factor");
    if (!last.contains("monitors")) return;  // the rule of collapse
    for (const auto& [monitor, motion] : last["monitors"].items())
      vector(prefix + "monitor " + monitor, to_vec3(motion["displacement"]), Nature::polar, "m");
  }

  /// Displacements are from the drawing, so that they hold what form-finding did.
  void read_nodes() {
    const Table table(path("nodes.csv"));
    for (std::size_t i = 0; i < table.size(); ++i) {
      const std::string node = name(static_cast<int>(i) + 1);
      const Vec3 at = table.vector(i, "x", "y", "z");
      const bool drawn = i < names_.size();
      const Vec3 from = drawn ? place_of(deck_, node) : table.vector(i, "x_ref", "y_ref", "z_ref");
      vector("node " + node + " displacement", at - from, Nature::polar, "m");
      vector("node " + node + " rotation", table.vector(i, "rx", "ry", "rz"), Nature::axial, "rad");
      vector("node " + node + " reaction", Vec3::Zero(), Nature::polar, "N");
      vector("node " + node + " reaction moment", Vec3::Zero(), Nature::axial, "N m");
    }
  }

  void read_reactions() {
    const Table table(path("reactions.csv"));
    for (std::size_t i = 0; i < table.size(); ++i) {
      const std::string node = "node " + name(static_cast<int>(table.number(i, "node"))) + " reaction";
      vector(node, table.vector(i, "fx", "fy", "fz"), Nature::polar, "N");
      vector(node + " moment", table.vector(i, "mx", "my", "mz"), Nature::axial, "N m");
    }
  }

  /// Group and nodes of an element, in an order that does not depend on the deck's.
  std::string element(const Table& table, std::size_t row, const std::string& kind) const {
    std::vector<std::string> nodes;
    for (const char* column : {"node_1", "node_2", "node_3", "node_4"}) {
      const bool line = kind == "cable" || kind == "beam";
      if (line && (column[5] == '3' || column[5] == '4')) continue;
      if (!table.text(row, column).empty())
        nodes.push_back(name(static_cast<int>(table.number(row, column))));
    }
    std::sort(nodes.begin(), nodes.end());
    return fmt::format("{} {} {} ", kind, table.text(row, "group"), fmt::join(nodes, "-"));
  }

  void read_cables() {
    const Table table(path("cables.csv"));
    for (std::size_t i = 0; i < table.size(); ++i) {
      const auto key = element(table, i, "cable");
      scalar(key + "tension", table.number(i, "tension"), "N");
      scalar(key + "length", table.number(i, "length"), "length m");
      scalar(key + "unstressed length", table.number(i, "unstressed_length"), "length m");
    }
  }

  /// Sizes of shears and moments, which do not depend on the direction of the element.
  void read_beams() {
    const Table table(path("beams.csv"));
    for (std::size_t i = 0; i < table.size(); ++i) {
      const auto key = element(table, i, "beam");
      const auto size = [&](const char* a, const char* b) {
        return std::hypot(table.number(i, a), table.number(i, b));
      };
      const auto end = [&](const char* node) { return name(static_cast<int>(table.number(i, node))); };
      scalar(key + "axial at " + end("node_1"), table.number(i, "axial_start"), "N");
      scalar(key + "axial at " + end("node_2"), table.number(i, "axial"), "N");
      scalar(key + "shear at " + end("node_1"), size("shear_2_start", "shear_3_start"), "N");
      scalar(key + "shear at " + end("node_2"), size("shear_2", "shear_3"), "N");
      scalar(key + "torque", std::abs(table.number(i, "torque")), "N m");
      scalar(key + "moment at " + end("node_1"), size("moment_2_start", "moment_3_start"), "N m");
      scalar(key + "moment at " + end("node_2"), size("moment_2_end", "moment_3_end"), "N m");
    }
  }

  void read_membranes() {
    if (!fs::exists(path("membranes.csv"))) return;
    const Table table(path("membranes.csv"));
    for (std::size_t i = 0; i < table.size(); ++i) {
      const auto key = element(table, i, "membrane");
      scalar(key + "principal 1", table.number(i, "principal_1"), "N/m");
      scalar(key + "principal 2", table.number(i, "principal_2"), "N/m");
    }
  }

  /// Mean and radius of Mohr's circle, of moments but for the sign that the normal gives.
  void read_shells() {
    if (!fs::exists(path("shells.csv"))) return;
    const Table table(path("shells.csv"));
    for (std::size_t i = 0; i < table.size(); ++i) {
      const auto key = element(table, i, "shell");
      const auto mean = [&](const char* a, const char* b) {
        return (table.number(i, a) + table.number(i, b)) / 2;
      };
      const auto radius = [&](const char* a, const char* b, const char* c) {
        return std::hypot((table.number(i, a) - table.number(i, b)) / 2, table.number(i, c));
      };
      scalar(key + "membrane mean", mean("n11", "n22"), "N/m");
      scalar(key + "membrane radius", radius("n11", "n22", "n12"), "N/m");
      scalar(key + "moment mean", std::abs(mean("m11", "m22")), "N m/m");
      scalar(key + "moment radius", radius("m11", "m22", "m12"), "N m/m");
      scalar(key + "shear", std::hypot(table.number(i, "q1"), table.number(i, "q2")), "N/m");
    }
  }

  const Json& deck_;
  std::string directory_;
  std::vector<std::string> names_;
  Outcome outcome_;
};

/// Keeps the program's words off stdout while it lives.
class Silence {
 public:
  Silence() : before_(std::cout.rdbuf(nothing_.rdbuf())) {}
  ~Silence() { std::cout.rdbuf(before_); }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  std::ostringstream nothing_;
  std::streambuf* before_;
};

std::string word(ExitCode code) {
  return code == ExitCode::done ? "done" : code == ExitCode::interrupted ? "interrupted" : "not converged";
}

void write(const std::string& path, const std::string& text) {
  std::ofstream(path) << text;
}

std::string text_of(const Json& deck) {
  Json quiet = deck;
  quiet["output"] = {{"fields", false}, {"pictures", false}, {"report", false}};
  return yaml(quiet);
}

/// A directory that holds the checkpoint after some steps of a run, and nothing of what came later.
std::string only_checkpoint(const std::string& run, int steps_done) {
  const std::string from = run + ".from";
  fs::remove_all(from);
  fs::create_directories(from + "/checkpoints");
  const std::string file = fmt::format("checkpoints/step_{}.bin", steps_done);
  fs::copy_file(run + "/" + file, from + "/" + file);
  return from;
}

void run_deck(const std::string& text, const std::string& directory, const std::string& from,
              Outcome& outcome) {
  Progress silent;
  const auto deck = deck::parse_deck(text, directory + ".yaml");
  outcome.end = word(steps::run(deck, {directory, false, from}, silent));
}

}  // namespace

std::string end_of(const std::exception& error) {
  if (dynamic_cast<const DeckError*>(&error) != nullptr) return "bad deck";
  if (dynamic_cast<const ModelError*>(&error) != nullptr) return "impossible model";
  if (dynamic_cast<const LibraryError*>(&error) != nullptr) return "library failed";
  return "bug";
}

Outcome Outcome::only(const std::string& prefix) const {
  Outcome result{end, message, {}, warnings, size, stiffness};
  for (const auto& [key, value] : numbers)
    if (key.rfind(prefix, 0) == 0) result.numbers[key] = value;
  return result;
}

Outcome Outcome::without(const std::string& prefix) const {
  Outcome result{end, message, {}, warnings, size, stiffness};
  for (const auto& [key, value] : numbers)
    if (key.rfind(prefix, 0) != 0) result.numbers[key] = value;
  return result;
}

Outcome read_outcome(const Json& deck, const std::string& directory) {
  return Reading(deck, directory).read();
}

Launcher& launcher() {
  static Launcher instance;
  return instance;
}

void run_files(const std::string& list) {
  std::ifstream file(list);
  for (std::string path; std::getline(file, path);) {
    const std::string directory = fs::path(path).replace_extension().string();
    std::ifstream deck(path);
    const std::string text{std::istreambuf_iterator<char>(deck), std::istreambuf_iterator<char>()};
    Outcome outcome;
    try {
      const Silence silence;
      run_deck(text, directory, "", outcome);
    } catch (const std::exception& error) {
      outcome.end = end_of(error);
      outcome.message = error.what();
    }
    if (la::rank() == 0) write(directory + ".end", outcome.end + "\n" + outcome.message);
  }
}

Runner::Runner(std::string directory) : directory_(std::move(directory)) {
  fs::create_directories(directory_);
}

void Runner::run_on_two_ranks(const std::vector<Json>& decks) {
  const std::string place = directory_ + "/two_ranks", list = place + "/list";
  fs::remove_all(place);
  fs::create_directories(place);
  std::string names;
  for (std::size_t i = 0; i < decks.size(); ++i) {
    const std::string file = fmt::format("{}/{}.yaml", place, i);
    write(file, text_of(decks[i]));
    names += file + "\n";
  }
  write(list, names);
  // what a process that has begun MPI leaves in its environment would confuse mpiexec
  std::string clean = "env";
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string name = std::string(*entry).substr(0, std::string(*entry).find('='));
    if (name.rfind("PMIX_", 0) == 0 || name.rfind("OMPI_COMM", 0) == 0 || name.rfind("OMPI_MCA", 0) == 0)
      clean += " -u " + name;
  }
  const std::string command =
      fmt::format("{} {} -n 2 --oversubscribe --bind-to none {} --run-files {} > {}/log 2>&1", clean,
                  launcher().mpiexec, launcher().program, list, place);
  const int code = std::system(command.c_str());
  for (std::size_t i = 0; i < decks.size(); ++i) {
    const std::string directory = fmt::format("{}/{}", place, i);
    std::ifstream file(directory + ".end");
    Outcome outcome;
    outcome.end = "bug";
    outcome.message = fmt::format("{} ended with {} and left no word; see {}/log", command, code, place);
    std::string end;
    if (std::getline(file, end)) {
      if (fs::exists(directory + "/results.json")) outcome = read_outcome(decks[i], directory);
      outcome.end = end;
      outcome.message.assign(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    }
    on_two_ranks_[text_of(decks[i])] = outcome;
  }
}

Outcome Runner::run(const Job& job) {
  constexpr int most_kept = 8;  // directories are used again, so that thousands of runs leave a few
  const std::string before = last_, directory = fmt::format("{}/{}", directory_, turn_++ % most_kept);
  const std::string text = text_of(job.deck);
  if (job.way == Job::Way::two_ranks) {
    if (on_two_ranks_.count(text) == 0) run_on_two_ranks({job.deck});
    return on_two_ranks_.at(text);
  }
  fs::remove_all(directory);
  write(directory + ".yaml", text);
  last_ = directory;
  Outcome outcome;
  try {
    const Silence silence;
    if (job.way == Job::Way::check) {
      steps::check(deck::parse_deck(text, directory + ".yaml"));
      outcome.end = "done";
      return outcome;
    }
    run_deck(text, directory,
             job.way == Job::Way::resume ? only_checkpoint(before, job.steps_done) : std::string(), outcome);
  } catch (const std::exception& error) {
    outcome.end = end_of(error);
    outcome.message = error.what();
    return outcome;
  }
  const std::string end = outcome.end;
  outcome = read_outcome(job.deck, directory);
  outcome.end = end;
  if (!outcome.done()) outcome.message = output::read_results(directory + "/results.json")["reason"];
  return outcome;
}

}  // namespace tautline::metamorphic
