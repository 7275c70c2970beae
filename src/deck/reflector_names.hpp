#pragma once
/// @file
/// The groups and selections of the large reflectors, by name.

#include <deck/cross_checks.hpp>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace tautline::deck {

struct ReflectorNames {
  std::map<std::string, Member> groups;
  std::set<std::string> optional_groups;  ///< need no section
  std::vector<std::string> selections;
  std::string numbered;  ///< of selections numbered_0, numbered_1, ...
  int n_numbered = 0;
};

/// The names of a reflector with a rim and struts on cords or with Y-shaped spokes; nothing for others.
std::optional<ReflectorNames> names_of_reflector(const Deck& deck);

}  // namespace tautline::deck
