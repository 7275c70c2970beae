#pragma once
/// @file
/// Processes side by side.

#include <functional>
#include <string>
#include <vector>

namespace tautline::steps {

struct Command {
  std::vector<std::string> words;  ///< program first
  std::string log;                 ///< stdout and stderr go here
};

/// @brief Runs all commands, at most `jobs` at a time; starts no more once the user asked to stop.
/// @param ended called with the index as each ends @return exit codes; 128 + signal for one that was killed,
/// 130 for one that was not started
/// @throws LibraryError if a process cannot be started
std::vector<int> run_side_by_side(const std::vector<Command>& commands, int jobs,
                                  const std::function<void(std::size_t)>& ended);

/// The file of the program that runs.
std::string own_program();

}  // namespace tautline::steps
