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
  /// Characters in the first `bytes` of a line. Places come in the order of the text: the count goes on where
  /// it was.
  int characters_before(int number, std::size_t bytes) const;

  std::string name_;
  std::vector<std::string> lines_;
  struct Counted {
    int line = 0;
    std::size_t bytes = 0;
    int characters = 0;
  };
  mutable Counted counted_;
};

/// Everything wrong with the deck so far.
class Complaints {
 public:
  void add(Diagnostic diagnostic);
  /// Whether further complaints are only counted; their text need not be made.
  bool is_full() const noexcept;
  void count_one() noexcept { ++n_more_; }
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
