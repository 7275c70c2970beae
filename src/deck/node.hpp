#pragma once
/// @file
/// A deck as a tree of located values. Knows nothing of the YAML library nor of what the keys mean.

#include <string>
#include <string_view>
#include <vector>

namespace tautline::deck {

/// Where a value stands: line and column from 1, column and length in characters. Or a command-line override.
struct Place {
  int line = 0;
  int column = 0;
  int length = 1;
  std::string origin;  ///< "--set path=value" where the value does not come from the file
};

struct Entry;

struct Node {
  enum class Kind {
    empty,
    scalar,
    sequence,
    mapping,
    broken  ///< already complained about; complaints at this node are swallowed
  };
  Kind kind = Kind::empty;
  Place place;                 ///< of the value; of the key where the value is empty
  Place label;                 ///< of the key that holds the value; of the value itself in a list
  std::string text;            ///< scalars
  bool quoted = false;         ///< scalars: written in quotes or as a block
  std::string note;            ///< where the value comes from if not written here: a parameter, an anchor
  std::vector<Node> items;     ///< sequences
  std::vector<Entry> entries;  ///< mappings, in the order written, duplicates included

  bool is_mapping() const { return kind == Kind::mapping; }
  bool is_sequence() const { return kind == Kind::sequence; }
  bool is_scalar() const { return kind == Kind::scalar; }
  /// Value of the first entry with this key, or null.
  const Node* find(std::string_view key) const;
  Node* find(std::string_view key);
  /// Node at the end of a path of keys and list indices, or null.
  const Node* at(const std::vector<std::string>& path) const;
  /// "a list", "a mapping", "text", "empty".
  std::string describe() const;
};

struct Entry {
  std::string key;
  Place place;
  Node value;
};

/// The index written in `text`, or -1.
int list_index(std::string_view text);

}  // namespace tautline::deck
