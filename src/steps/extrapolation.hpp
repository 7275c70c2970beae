#pragma once
/// @file
/// Observed order of convergence and the value at vanishing mesh size.

#include <string>
#include <vector>

namespace tautline::steps {

struct Extrapolation {
  double order = 0;     ///< p of f(h) = f(0) + C h^p
  double limit = 0;     ///< f(0)
  std::string why_not;  ///< empty if there is a limit
  explicit operator bool() const { return why_not.empty(); }
};

/// @brief Fits f(h) = f(0) + C h^p through the last three points (Roache 1994).
///
/// There is a limit only where the values approach it: differences of one sign in the last four points (or
/// three, if there are no more), an order between 0.5 and 4.5, and that of the three points before not
/// farther from it than a third.
/// @param size   mesh sizes h, falling
/// @param value  f(h)
Extrapolation extrapolate_three(const std::vector<double>& size, const std::vector<double>& value);

}  // namespace tautline::steps
