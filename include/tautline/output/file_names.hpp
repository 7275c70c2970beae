#pragma once
/// @file
/// Names of files that are made from names in a deck.

#include <map>
#include <set>
#include <string>

namespace tautline::output {

/// @brief File names without suffix for names of steps, cases or groups: letters, digits, - . and _ only, no
/// longer than 80 characters, never hidden, never the same for two names.
///
/// Every output file whose name holds a user's words gets them from here, so that nothing is written outside
/// the output directory.
class FileNames {
 public:
  /// The same for the same name; a number is added where another name has taken it.
  std::string of(const std::string& name);
  /// Another one with every call.
  std::string next(const std::string& name);

 private:
  std::map<std::string, std::string> given_;
  std::set<std::string> taken_;
};

}  // namespace tautline::output
