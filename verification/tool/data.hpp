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
  /// "/steps/tuning/surface/rms": a path into results.json (tautline/output/pointer.hpp).
  /// "cables.csv#tension?group=front_net&within=5": a column, with conditions on others. `within`: nodes, or
  /// both ends of elements, no farther from the z axis than that, by nodes.csv. Conditions "id<=10" and
  /// "id>=10" compare numbers.
  Values find(const std::string& reference);
  /// The rows of a table, read when first asked for.
  const Table& table(const std::string& file);
  const std::string& directory() const { return directory_; }

 private:
  Values pointer(const std::string& path);
  Values column(const std::string& reference);
  std::vector<bool> within(const Table& table, double radius);

  std::string directory_;
  nlohmann::ordered_json results_;
  std::map<std::string, Table> tables_;
};

}  // namespace verify
