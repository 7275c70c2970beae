#pragma once
/// @file
/// Decks that are nearly right: trees of good ones with values, keys, kinds and order changed and parts of
/// other decks put in, written as YAML in any layout, and sometimes damaged as text.

#include <string>
#include <vector>

#include <deck/node.hpp>

#include "damage.hpp"

namespace tautline::fuzz {

struct SeedDeck {
  std::string path;
  deck::Node tree;
};

class DeckMutator {
 public:
  explicit DeckMutator(std::vector<SeedDeck> seeds);

  struct Mutant {
    std::string text;
    const SeedDeck* seed = nullptr;
  };
  Mutant make(Random& random) const;
  const std::vector<SeedDeck>& seeds() const { return seeds_; }

 private:
  deck::Node& any_node(deck::Node& root, Random& random) const;
  const deck::Node& any_part(Random& random) const;
  void change(deck::Node& root, Random& random) const;
  void change_value(deck::Node& node, Random& random) const;
  void change_number(deck::Node& root, Random& random) const;
  void change_kind(deck::Node& node, Random& random) const;
  void change_keys(deck::Node& node, Random& random) const;
  void change_items(deck::Node& node, Random& random) const;
  void splice(deck::Node& root, deck::Node& node, Random& random) const;
  void use_alias(deck::Node& root, deck::Node& node, Random& random) const;
  void use_parameter(deck::Node& root, deck::Node& node, Random& random) const;

  std::vector<SeedDeck> seeds_;
  std::vector<std::string> keys_;  ///< of all blocks of the keyword table
};

/// Every deck of these folders and files that can be read. @param most_bytes longer ones are left out
std::vector<SeedDeck> read_seeds(const std::vector<std::string>& places, std::size_t most_bytes);

/// A tree as YAML, each list and mapping in blocks or in brackets as it comes. `note` stands before a value
/// as it is (an anchor), a broken node is written as it is (an alias).
std::string write_yaml(const deck::Node& root, Random& random);

}  // namespace tautline::fuzz
