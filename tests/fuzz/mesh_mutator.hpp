#pragma once
/// @file
/// Damaged mesh files, overrides and results: what is given to the program beside a deck.

#include <deck/node.hpp>

#include "campaign.hpp"
#include "damage.hpp"

namespace tautline::fuzz {

/// gmsh meshes (2.2 and 4.1, text and binary) with numbers, counts, tags, sections and bytes changed.
class MeshMutator {
 public:
  /// `folder` holds meshes and, of the same name up to the first dot, the deck that reads them.
  explicit MeshMutator(const std::string& folder);
  Input make(Random& random) const;

 private:
  struct Seed {
    std::string bytes, deck;
  };
  std::vector<Seed> seeds_;
};

/// Some lines path=value, most paths those of the deck.
std::string some_overrides(const deck::Node& deck, Random& random);

/// results.json with values, keys and text changed.
std::string damaged_results(const std::string& json, Random& random);

}  // namespace tautline::fuzz
