#include <tautline/core/out_of_memory.hpp>

#include <new>
#include <stdexcept>

namespace tautline {

OutOfMemory::OutOfMemory(const std::string& where)
    : LibraryError("there is not enough memory" + (where.empty() ? "" : " (" + where + ")") +
                   ". Ask for fewer elements (subdivisions, rings, modes), or give the process more "
                   "(ulimit -v, a larger machine, more ranks)") {}

bool is_out_of_memory(const std::exception& error) {
  return dynamic_cast<const OutOfMemory*>(&error) != nullptr ||
         dynamic_cast<const std::bad_alloc*>(&error) != nullptr ||
         dynamic_cast<const std::length_error*>(&error) != nullptr;
}

std::string text_of(const std::exception& error) {
  const bool bare = is_out_of_memory(error) && dynamic_cast<const OutOfMemory*>(&error) == nullptr;
  return bare ? OutOfMemory().what() : error.what();
}

}  // namespace tautline
