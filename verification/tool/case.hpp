#pragma once
/// @file
/// A verification case: expected.yaml as read, and what came of it.

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace YAML {
class Node;
}

namespace verify {

/// One run of the program.
struct Run {
  std::string name;
  std::string deck;                    ///< relative to the case, else to the repository
  std::vector<std::string> overrides;  ///< path.to.key=value
  int ranks = 1;
  int exit_code = 0;                    ///< the program is meant to end with
  bool pictures = false;                ///< drawn by the program itself
  std::vector<std::string> study = {};  ///< arguments of `tautline study`, which is called then
};

enum class Check { equal, at_most, at_least, report_only };
enum class Origin { analytic, invariant, published, other_code, regression, requirement };

/// A number with its reference.
struct Quantity {
  std::string name, value, unit;  ///< value: an expression
  std::string reference;          ///< an expression, most often just a number
  Check check = Check::equal;
  std::optional<double> relative, absolute;  ///< tolerance
  Origin origin = Origin::regression;
  std::string source, note;
};

struct Case {
  std::string name, directory;
  std::vector<Run> runs;
  std::vector<Quantity> quantities;
};

/// A quantity as found.
struct Result {
  Quantity quantity;
  double ours = 0, reference = 0;
  bool passed = false;
  std::string problem;  ///< why it did not pass, if the numbers do not say so
};

/// @throws std::runtime_error that names the line and what is wrong with it
Run read_run(const YAML::Node& node);
Quantity read_quantity(const YAML::Node& node);
/// A text of a YAML mapping, or "" if the key is not there and is not `required`.
std::string read_text(const YAML::Node& node, const char* key, bool required = false);
/// Refuses keys that mean nothing.
void know_keys(const YAML::Node& node, const std::set<std::string>& known);

/// @throws std::runtime_error that names the case and what is wrong in its expected.yaml
Case read_case(const std::string& directory);

std::string to_string(Origin origin);

}  // namespace verify
