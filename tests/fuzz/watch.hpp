#pragma once
/// @file
/// Inputs tried in batches by a child process, so that a crash, a hang or too much memory is told with its
/// seed.

#include <optional>

#include "campaign.hpp"

namespace tautline::fuzz {

struct Limits {
  double seconds = 10;           ///< of processor time for one input
  std::size_t megabytes = 2048;  ///< of address space beyond what the process begins with
  int batch = 1000;              ///< inputs for each child
};

struct Finding {
  std::uint64_t seed = 0;
  std::string kind;  ///< crash, hang, bug, wrong place, ...
  std::string said;
};

struct Tally {
  int tried = 0;
  std::map<std::string, int> ends;       ///< how often the program answered what
  std::map<std::string, int> sentences;  ///< refusals without names and numbers
  double slowest = 0;                    ///< [s]
  std::uint64_t slowest_seed = 0;
  double most_memory = 0;  ///< [MB], of a whole child
};

/// Tries the seeds first, first + 1, ... until `count` are tried or `seconds` are over.
Tally watch(const Campaign& campaign, std::uint64_t first, int count, double seconds, const Limits& limits,
            const std::function<void(const Finding&)>& found);

/// One input in a child of its own. @return what is wrong, if anything
std::optional<Finding> watch_one(const Campaign& campaign, const Input& input, const Limits& limits);

/// The sentence without names and numbers, so that findings of a kind are told once.
std::string sort_of(const std::string& sentence);

/// Cuts lines, then characters from the input as long as the same kind of finding remains.
Input smallest(const Campaign& campaign, Input input, const Finding& finding, const Limits& limits,
               double seconds);

}  // namespace tautline::fuzz
