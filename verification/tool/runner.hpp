#pragma once
/// @file
/// Running the program for a case, and comparing what came of it.

#include <map>
#include <string>

#include "case.hpp"
#include "data.hpp"

namespace verify {

/// How the program is called.
struct Program {
  std::string path;    ///< of the program
  std::string source;  ///< top of the repository
  std::string work;    ///< results go to work/<case>/<run>
  std::string mpiexec = "mpirun";
  bool reuse = false;  ///< take results that are there already
};

/// @brief Runs the program as a user would. @return where the results are
/// @throws std::runtime_error if it ends with another exit code than it is meant to
std::string perform(const Run& run, const Case& c, const Program& program);

using DataByRun = std::map<std::string, Data>;

/// Finds "run:reference" in the data of that run.
Lookup lookup_in(DataByRun& data);

/// A quantity beside its reference. Never throws: what went wrong stands in the result.
Result examine(const Quantity& quantity, const Lookup& lookup);

}  // namespace verify
