#pragma once
/// Tables of reference data for the tests of this folder, and elements of a model to compare with them.

#include <array>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tautline/model/model.hpp>
#include <vector>

namespace tautline::reflector {

/// Numbers of a comma-separated table without its header and without columns that are not numbers.
inline std::vector<std::vector<double>> read_table(const std::string& name) {
  std::ifstream file(std::string(TAUTLINE_SOURCE_DIR) + "/tests/reflector/data/" + name);
  if (!file) throw std::runtime_error("cannot read " + name);
  std::vector<std::vector<double>> rows;
  std::string line, cell;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    rows.emplace_back();
    while (std::getline(cells, cell, ',')) rows.back().push_back(std::stod(cell));
  }
  return rows;
}

/// Elements without regard to the order of their nodes.
template <class Container>
std::multiset<std::set<int>> as_sets(const Container& elements) {
  std::multiset<std::set<int>> sets;
  for (const auto& nodes : elements) sets.insert(std::set<int>(nodes.begin(), nodes.end()));
  return sets;
}

/// The elements of a table whose nodes count from 1.
inline std::multiset<std::set<int>> table(const std::string& name) {
  std::multiset<std::set<int>> sets;
  for (const auto& row : read_table(name)) {
    std::set<int> nodes;
    for (const double number : row) nodes.insert(static_cast<int>(number) - 1);
    sets.insert(nodes);
  }
  return sets;
}

inline std::vector<std::array<int, 2>> cables_of(const model::Model& model, const std::string& group) {
  std::vector<std::array<int, 2>> found;
  for (const auto& cable : model.cables)
    if (model.groups[cable.group].name == group) found.push_back(cable.nodes);
  return found;
}

inline std::vector<std::array<int, 2>> beams_of(const model::Model& model, const std::string& group) {
  std::vector<std::array<int, 2>> found;
  for (const auto& beam : model.beams)
    if (model.groups[beam.group].name == group) found.push_back(beam.nodes);
  return found;
}

}  // namespace tautline::reflector
