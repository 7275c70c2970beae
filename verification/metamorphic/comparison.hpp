#pragma once
/// @file
/// Two outcomes number by number.

#include <string>
#include <vector>

#include "outcome.hpp"

namespace tautline::metamorphic {

struct Difference {
  std::string what;
  double measure = 0;  ///< difference over what is allowed: a failure above 1
};

/// What a difference is measured by, for each unit: the largest number of that unit anywhere in the
/// structure, since rounding and the end of Newton's method leave an error of the same size everywhere;
/// frequencies, factors and surface errors by themselves. Displacements at least by a thousandth of the
/// structure's size, forces at least by 1e-8 of the largest stiffness, of which 1e-14 is rounding.
class Scales {
 public:
  explicit Scales(const Outcome& outcome);
  double of(const Quantity& a, const Quantity& b) const;

 private:
  std::map<std::string, double> largest_;
  double size_, stiffness_;
};

/// @return every number's difference over `tolerance` of its scale, the largest first; a number that is only
/// on one side counts as infinitely different
std::vector<Difference> compare(const Outcome& expected, const Outcome& found, double tolerance);

/// Whether every cable of the last state is in tension.
bool all_taut(const Outcome& outcome);

/// One difference that a relation measures by itself.
Difference difference(const std::string& what, double expected, double found, double allowed);

}  // namespace tautline::metamorphic
