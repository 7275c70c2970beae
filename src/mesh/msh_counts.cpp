#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "mesh/msh_counts.hpp"

namespace tautline::mesh {

namespace {

/// The lines of a file that say something.
class Lines {
 public:
  explicit Lines(const std::string& path) : file_(path, std::ios::binary) {}

  bool next() {
    while (std::getline(file_, line_)) {
      ++number_;
      if (line_.find_first_not_of(" \t\r") != std::string::npos) return true;
    }
    line_.clear();
    return false;
  }
  const std::string& text() const { return line_; }
  long number() const { return number_; }
  bool begins(const std::string& word) const { return line_.rfind(word, 0) == 0; }

 private:
  std::ifstream file_;
  std::string line_;
  long number_ = 0;
};

/// The whole number at a place of a line, from 0; -1 if there is none.
long long number_at(const std::string& line, int place) {
  std::istringstream words(line);
  long long value = -1;
  for (int i = 0; i <= place; ++i)
    if (!(words >> value)) return -1;
  return value;
}

/// Lines up to the end of the section.
long long rest_of(Lines& lines) {
  long long count = 0;
  while (lines.next() && lines.text()[0] != '$') ++count;
  return count;
}

std::string difference(const std::string& what, long long said, long long found) {
  return fmt::format("says that it has {} {}, but holds {}", said, what, found);
}

/// Version 2: a count, then a line for each.
std::string fault_of_list(Lines& lines, const std::string& what) {
  if (!lines.next()) return {};
  const long long said = number_at(lines.text(), 0), found = rest_of(lines);
  return said >= 0 && found > said ? difference(what, said, found) : std::string();
}

/// Version 4.1: counts, then blocks with a head that ends with their own count.
std::string fault_of_blocks(Lines& lines, const std::string& what, int lines_each) {
  if (!lines.next()) return {};
  const long long blocks = number_at(lines.text(), 0), said = number_at(lines.text(), 1);
  if (blocks < 0 || said < 0) return {};  // gmsh tells
  long long found = 0;
  for (long long block = 0; block < blocks; ++block) {
    if (!lines.next() || lines.text()[0] == '$')
      return fmt::format("says that it has {} blocks of {}, but holds {}", blocks, what, block);
    const long long count = number_at(lines.text(), 3);
    if (count < 0) return {};  // gmsh tells
    for (long long i = 0; i < lines_each * count; ++i)
      if (!lines.next() || lines.text()[0] == '$')
        return fmt::format("ends within a block of {} {}", count, what);
    found += count;
  }
  if (found != said) return difference(what, said, found);
  const long long more = rest_of(lines);
  return more > 0 ? fmt::format("holds more {} than it says: {} lines follow the last block", what, more)
                  : std::string();
}

}  // namespace

std::string fault_of_counts(const std::string& path) {
  Lines lines(path);
  if (!lines.next() || !lines.begins("$MeshFormat") || !lines.next()) return {};
  double version = 0;
  int binary = 1;
  std::istringstream(lines.text()) >> version >> binary;
  if (binary != 0 || (version != 4.1 && (version < 2 || version >= 3))) return {};
  while (lines.next()) {
    const bool nodes = lines.begins("$Nodes");
    if (!nodes && !lines.begins("$Elements")) continue;
    const std::string what = nodes ? "nodes" : "elements";
    const std::string fault =
        version == 4.1 ? fault_of_blocks(lines, what, nodes ? 2 : 1) : fault_of_list(lines, what);
    if (!fault.empty()) return fault;
  }
  return {};
}

}  // namespace tautline::mesh
