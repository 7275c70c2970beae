#pragma once
/// @file
/// Numbers of results.json by a path.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace tautline::output {

/// @brief The numbers that a path such as "/steps/tuning/surface/rms" leads to.
///
/// Entries of a list are named by index, by `first` or `last`, by their "name", or by `*` for all of them. A
/// list at the end gives all its numbers.
/// @throws std::runtime_error that says where the path ends, and what there is instead
std::vector<double> numbers_at(const nlohmann::ordered_json& results, const std::string& path);

}  // namespace tautline::output
