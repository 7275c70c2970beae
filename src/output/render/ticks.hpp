#pragma once
/// @file
/// Round numbers for axes and colour bars.

#include <string>
#include <vector>

namespace tautline::output::render {

struct Ticks {
  std::vector<double> values;
  std::vector<std::string> labels;
};

/// About `wanted` round values (1, 2, 5 times a power of ten) within [low, high]; whole numbers if asked.
Ticks linear_ticks(double low, double high, int wanted, bool whole = false);

/// Powers of ten within [low, high], with 2 and 5 between them where decades are few. 0 < low < high.
Ticks logarithmic_ticks(double low, double high);

}  // namespace tautline::output::render
