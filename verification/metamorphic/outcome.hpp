#pragma once
/// @file
/// Running a deck in this process, and its results as numbers that know how they turn and what they are
/// measured in.

#include <map>
#include <set>
#include <string>

#include "deck.hpp"

namespace tautline::metamorphic {

/// How a number changes when the structure is moved as a whole.
enum class Nature { scalar, polar, axial };

struct Quantity {
  Nature nature = Nature::scalar;
  std::string unit;           ///< "m", "N", "N m", "N/m", "Hz", "1/s2", "-", "rad", ...
  Vec3 value = Vec3::Zero();  ///< of a scalar the first component

  static Quantity scalar(double value, std::string unit) {
    return {Nature::scalar, std::move(unit), Vec3(value, 0, 0)};
  }
};

/// What came of a run.
struct Outcome {
  std::string end;      ///< "done", "not converged", "bad deck", "impossible model", "library failed", "bug"
  std::string message;  ///< why it is not done
  std::map<std::string, Quantity> numbers;
  std::set<std::string> warnings;  ///< codes; "slack_at_first_factor" where linear buckling tells it
  double size = 0;                 ///< of the structure as drawn [m]
  double stiffness = 0;            ///< about the largest axial stiffness, whose rounding is in all forces [N]

  bool done() const { return end == "done"; }
  const Vec3& at(const std::string& key) const { return numbers.at(key).value; }
  double scalar(const std::string& key) const { return numbers.at(key).value[0]; }
  /// The numbers whose names begin so.
  Outcome only(const std::string& prefix) const;
  Outcome without(const std::string& prefix) const;
};

/// What is done with a deck.
struct Job {
  Json deck;
  enum class Way { run, check, resume, two_ranks } way = Way::run;
  int steps_done = 0;  ///< resume: from the checkpoint after so many steps of the job before
};

/// Reads what a run has left in `directory`.
Outcome read_outcome(const Json& deck, const std::string& directory);

/// Runs jobs, each in a directory of its own below `directory`, of which the last few are kept.
class Runner {
 public:
  explicit Runner(std::string directory);
  Outcome run(const Job& job);
  /// Runs decks on two ranks in one go, for jobs to come. `mpirun` starts processes best from one that has
  /// not begun MPI.
  void run_on_two_ranks(const std::vector<Json>& decks);

 private:
  std::string directory_, last_;
  int turn_ = 0;
  std::map<std::string, Outcome> on_two_ranks_;  ///< by the text of the deck
};

/// How two processes of this program are started, and what it is called.
struct Launcher {
  std::string mpiexec = "mpiexec", program;
};
Launcher& launcher();

/// What such processes do: run the decks that a file lists, each with its results in a directory of its name
/// without the ending, and how it ended in a file beside that. Collective.
void run_files(const std::string& list);

/// The words of Outcome::end for an exception.
std::string end_of(const std::exception& error);

}  // namespace tautline::metamorphic
