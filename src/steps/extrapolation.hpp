#pragma once
/// @file
/// Observed order of convergence and the value at vanishing mesh size.

#include <optional>
#include <vector>

namespace tautline::steps {

struct Extrapolation {
  double order = 0;  ///< p of f(h) = f(0) + C h^p
  double limit = 0;  ///< f(0)
};

/// @brief Fits f(h) = f(0) + C h^p through the last three points (Roache 1994).
/// @param size   mesh sizes h, falling
/// @param value  f(h)
/// @return nothing for fewer than three points, or where the three do not approach a limit steadily with 0.05
/// < p < 10
std::optional<Extrapolation> extrapolate_three(const std::vector<double>& size,
                                               const std::vector<double>& value);

}  // namespace tautline::steps
