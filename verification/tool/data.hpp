#pragma once
/// @file
/// Numbers out of a directory: results.json by a pointer, tables by column.

#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "expression.hpp"

namespace verify {

/// A table with a header line.
struct Table {
  std::map<std::string, std::size_t> columns;
  std::vector<std::vector<std::string>> rows;
};

/// Files of one directory, read when first asked for.
class Data {
 public:
  explicit Data(std::string directory) : directory_(std::move(directory)) {}

  /// @brief Numbers by reference. @throws std::runtime_error that names what is missing
  ///
  /// "/steps/tuning/surface/rms": a pointer into results.json; entries of a list are named by index, by
  /// `first` or `last`, by their "name", or by `*` for all of them.
  /// "cables.csv#tension?group=front_net&within=5": a column, with conditions on others. `within`: nodes, or
  /// both ends of elements, no farther from the z axis than that, by nodes.csv. Conditions "id<=10" and
  /// "id>=10" compare numbers.
  Values find(const std::string& reference);

 private:
  Values pointer(const std::string& path);
  Values column(const std::string& reference);
  const Table& table(const std::string& file);
  std::vector<bool> within(const Table& table, double radius);

  std::string directory_;
  nlohmann::json results_;
  std::map<std::string, Table> tables_;
};

}  // namespace verify
