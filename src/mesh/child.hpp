#pragma once
/// @file
/// Work that may go wrong in any way, done by a child process.

#include <functional>
#include <string>

namespace tautline::mesh {

struct ChildLimits {
  std::size_t bytes = 0;  ///< of memory beyond what the process has; 0: no limit
  int seconds = 0;        ///< of processor time
};

/// @brief What `work` returns, done in a copy of this process that has no output of its own.
///
/// A crash, an endless loop and too much memory of `work` end the child only. `work` must not use MPI.
/// @param[out] fault  how the child ended if it brought no result; empty otherwise
std::string in_child(const std::function<std::string()>& work, const ChildLimits& limits, std::string& fault);

}  // namespace tautline::mesh
