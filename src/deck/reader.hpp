#pragma once
/// @file
/// Walks a located tree along the keyword table, fills options and collects complaints.

#include <deck/keyword.hpp>
#include <deck/node.hpp>
#include <deck/source.hpp>
#include <array>
#include <optional>
#include <set>
#include <string>
#include <tautline/core/types.hpp>
#include <vector>

namespace tautline::deck {

/// A name that must exist elsewhere in the deck.
struct Reference {
  std::string kind;  ///< material, section, group, ...
  std::string name;
  Place place;
  std::string note;  ///< of the node it stands in
  std::string context;
};

class Reader {
 public:
  Reader(const Source& source, Complaints& complaints) : source_(source), complaints_(complaints) {}

  const Source& source() const { return source_; }

  /// Complains at a node, in the block being read.
  void complain(const Node& node, std::string message, std::string expectation = {},
                std::string suggestion = {});
  /// Complains at a key or any other place, in a block named by the caller.
  void complain(const Place& place, std::string message, std::string context, std::string expectation = {},
                std::string suggestion = {});

  /// Reads one block into `owner`, which has the type the block set was declared for. A key that is
  /// complained about but can be guessed is renamed in the tree, so that no complaint follows from the first.
  void read_block(const BlockSet& set, Node& node, void* owner);

  /// Values; complain and return nothing where the node does not fit.
  std::optional<double> number(const Keyword& keyword, const Node& node);
  std::optional<int> integer(const Keyword& keyword, const Node& node);
  std::optional<bool> boolean(const Keyword& keyword, const Node& node);
  std::optional<std::string> text(const Keyword& keyword, const Node& node);
  std::optional<std::string> choice(const Keyword& keyword, const Node& node);
  std::optional<std::vector<std::string>> names(const Keyword& keyword, const Node& node);
  std::optional<Vec3> vector(const Keyword& keyword, const Node& node);
  std::optional<std::array<double, 2>> pair(const Keyword& keyword, const Node& node);
  /// One number is a list of one.
  std::optional<std::vector<double>> numbers(const Keyword& keyword, const Node& node);
  /// Whether the node has the form; complains if not.
  bool expect(Node::Kind kind, const Keyword& keyword, const Node& node);

  void check_duplicates(const Node& node);
  /// "name = text fault", what was expected of the key, and a remedy.
  void wrong_value(const Keyword& keyword, const Node& node, const std::string& fault,
                   const std::string& remedy = {});
  /// Remembers a name that must exist elsewhere.
  void refer(const std::string& kind, const Node& node);
  void refer_key(const std::string& kind, const Entry& entry);

  /// Adds a step to the path in the deck while it lives.
  class Step {
   public:
    Step(Reader& reader, std::string name, std::string label = {});
    ~Step();
    Step(const Step&) = delete;
    Step& operator=(const Step&) = delete;

   private:
    Reader& reader_;
  };

  /// "in sections.cord", "at the top level".
  std::string context() const;
  const std::vector<Reference>& references() const { return references_; }
  const std::set<const Keyword*>& used() const { return used_; }

 private:
  const Block* choose(const BlockSet& set, const Node& node);
  void check_keys(const Block& block, Node& node);
  std::string unknown_key(const Block& block, const Entry& entry);
  void check_missing(const Block& block, const Node& node);
  bool plain_scalar(const Keyword& keyword, const Node& node);

  const Source& source_;
  Complaints& complaints_;
  std::vector<std::pair<std::string, std::string>> path_;
  std::vector<Reference> references_;
  std::set<const Keyword*> used_;
};

/// "in a.b.c", "at the top level" for no steps.
std::string context_text(const std::vector<std::string>& path);

/// The name given in a list item, or its kind, or "".
std::string label_of(const Node& node);

/// did you mean "x"? ; "" if nothing is near.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace tautline::deck
