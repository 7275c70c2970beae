#pragma once
/// @file
/// Too little memory, by whatever part of the program it is met.

#include <string>

#include <tautline/core/error.hpp>

namespace tautline {

/// There is not enough memory. Exit code 5.
class OutOfMemory : public LibraryError {
 public:
  /// @param where who met it, e.g. "MUMPS"; the text goes on with what to try
  explicit OutOfMemory(const std::string& where = {});
};

/// Whether an error says that there is not enough memory, whoever met it.
bool is_out_of_memory(const std::exception& error);

/// What an error says to a user: of one for want of memory, what to try.
std::string text_of(const std::exception& error);

}  // namespace tautline
