#pragma once
/// @file
/// docs/thesis.md.

#include <map>
#include <string>
#include <vector>

#include "runner.hpp"
#include "thesis_items.hpp"

namespace verify {

/// What running it took.
struct Effort {
  double seconds = 0;  ///< from start to end of a page made from scratch; 0: not known
  int runs = 0, cores = 0;
};

/// How a row or an item stands: met, explained, shown only, cannot be identified; or not met.
std::string status(const Result& result);
std::string status(const Item& item, const std::vector<Result>& results);

/// @param results of the rows, item after item @param data of the runs
std::string thesis_page(const Thesis& thesis, const std::vector<std::vector<Result>>& results,
                        DataByRun& data, const Effort& effort);

}  // namespace verify
