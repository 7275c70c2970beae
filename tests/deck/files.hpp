#pragma once
/// @file
/// Files the tests compare with, and how they are renewed.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace tautline::deck::test {

inline const std::filesystem::path source_dir = TAUTLINE_SOURCE_DIR;

/// TAUTLINE_UPDATE=1 in the environment: expected texts are written instead of compared.
inline bool updating() {
  return std::getenv("TAUTLINE_UPDATE") != nullptr;
}

inline std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline void write_file(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// Files of a folder with this extension, sorted.
inline std::vector<std::filesystem::path> files(const std::filesystem::path& folder,
                                                const std::string& extension) {
  std::vector<std::filesystem::path> result;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == extension) result.push_back(entry.path());
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace tautline::deck::test
