#pragma once
/// @file
/// The keyword table: what each key of a deck is called, means and may hold. Parser, messages, `explain`, the
/// schema and docs/deck/ are made from it.

#include <deck/node.hpp>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <tautline/core/error.hpp>
#include <utility>
#include <vector>

namespace tautline::deck {

class Reader;
struct Block;
struct BlockSet;

enum class Type {
  number,
  integer,
  boolean,
  text,
  choice,       ///< one of `choices`
  names,        ///< a list of names, or one name
  vector,       ///< [x, y, z]
  pair,         ///< one number for both, or [first, second]
  numbers,      ///< one number for all, or a list
  points,       ///< list of [x, y]
  table,        ///< list of lists of numbers
  directions,   ///< all, pinned, symmetry, or a list of x, y, z, rx, ry, rz
  releases,     ///< all, or a list of torsion, bending_2, bending_3
  edges,        ///< list of [node, node]
  terms,        ///< list of [node, direction, coefficient]
  coordinates,  ///< node name: [x, y, z]
  elements,     ///< group: list of lists of node names
  counts,       ///< name: whole number
  parameters,   ///< name: value
  blocks        ///< keys of their own, see `blocks` and `shape`
};

enum class Shape { single, list, map };

/// Limits of a number.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false, high_open = false;

  bool contains(double value) const;
  /// "> 0", ">= 1", "in (0, 0.5]", "" if anything goes.
  std::string text() const;
};

struct Keyword {
  std::string name;
  Type type = Type::text;
  std::string unit = "-";
  std::string fallback;  ///< default as text; empty: none
  Range range;
  std::string sentence;
  bool is_required = false;
  std::function<bool(const Node&)> spared;  ///< whether a block can do without the key though it is required
  std::vector<std::string> choices;
  std::vector<std::string> other_names;  ///< what the key was called before, or is called elsewhere
  std::string refers_to;                 ///< what the names stand for: material, section, ...
  const BlockSet* blocks = nullptr;
  Shape shape = Shape::single;
  std::function<void(Reader&, const Keyword&, Node&, void*)> read;  ///< value into the options it belongs to

  Keyword& in(std::string unit_text);
  Keyword& above(double low);
  Keyword& at_least(double low);
  Keyword& below(double high);
  Keyword& at_most(double high);
  Keyword& required();
  Keyword& required_unless(std::function<bool(const Node&)> other);
  Keyword& one_of(std::vector<std::string> words);
  Keyword& refers(std::string kind);
  Keyword& also_called(std::vector<std::string> names);
  Keyword& by_default(std::string text);
  Keyword& says(std::string text);

  /// "a number > 0 [m]", "true or false", ...
  std::string expectation() const;
};

/// Keys that stand together.
struct Block {
  std::string path;  ///< e.g. sections.cable, steps.mesh, reflector
  std::string kind;  ///< value of `kind` that chooses this block; empty if there is no choice
  std::string sentence;
  std::vector<Keyword> keywords;
  std::function<void(void*)> begin;                         ///< makes the owner hold this alternative
  std::function<void(void*, const SourceLocation&)> place;  ///< tells the owner where it stands
  std::function<void(Reader&, const Node&, void*)> check;   ///< what concerns several keys

  const Keyword* find(std::string_view name) const;
  std::vector<std::string> names() const;
};

/// One block, or several of which `kind` chooses.
struct BlockSet {
  std::string path;
  std::string sentence;
  std::vector<Block> alternatives;
  std::vector<std::string> planned;  ///< kinds that later versions will know

  bool has_kind() const { return !alternatives.empty() && !alternatives.front().kind.empty(); }
  const Block* find(std::string_view kind) const;
  std::vector<std::string> kinds() const;
};

/// The whole table.
const BlockSet& root_blocks();

/// "steps (kind mesh)" for every block that has this key, except `but`.
std::vector<std::string> homes_of(std::string_view key, const Block* but = nullptr);

/// Every block of the table, depth first.
std::vector<const Block*> all_blocks();

}  // namespace tautline::deck
