#pragma once
/// @file
/// The text of a deck by lines, and the list of complaints about it.

#include <deck/node.hpp>
#include <set>
#include <string>
#include <string_view>
#include <tautline/core/error.hpp>
#include <vector>

namespace tautline::deck {

class Source {
 public:
  Source(std::string name, const std::string& text);

  const std::string& name() const noexcept { return name_; }
  int n_lines() const noexcept { return static_cast<int>(lines_.size()); }
  /// Text of a line, from 1; "" outside the file.
  const std::string& line(int number) const;
  /// Place of a span given by the YAML library: line from 0, column from 0 in bytes.
  Place place(int line, int byte_column, std::size_t bytes) const;
  SourceLocation where(const Place& place) const;
  /// A diagnostic with place and source line filled in.
  Diagnostic diagnostic(const Place& place, std::string message) const;

 private:
  std::string name_;
  std::vector<std::string> lines_;
};

/// Everything wrong with the deck so far.
class Complaints {
 public:
  void add(Diagnostic diagnostic);
  bool empty() const noexcept { return list_.empty(); }
  /// @throws DeckError, sorted by place, at most 20 and then their number, if there is any
  void throw_if_any();

 private:
  std::vector<Diagnostic> list_;
  std::set<std::string> seen_;  ///< texts of the list
  std::size_t bytes_ = 0;       ///< of the list
  std::size_t n_more_ = 0;      ///< that are only counted
};

}  // namespace tautline::deck
