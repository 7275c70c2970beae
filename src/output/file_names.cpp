#include <tautline/output/file_names.hpp>

#include <fmt/format.h>

namespace tautline::output {

namespace {

constexpr std::size_t longest = 80;  // leaves room for a suffix and a number on every file system

std::string safe(const std::string& name) {
  std::string stem;
  for (const char c : name.substr(0, longest)) {
    const bool kept =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '.';
    stem += kept ? c : '_';
  }
  if (stem.empty() || stem.front() == '.' || stem.front() == '-') stem.insert(stem.begin(), '_');
  return stem;
}

}  // namespace

std::string FileNames::next(const std::string& name) {
  const std::string stem = safe(name);
  std::string result = stem;
  for (int number = 2; !taken_.insert(result).second; ++number) result = fmt::format("{}_{}", stem, number);
  return result;
}

std::string FileNames::of(const std::string& name) {
  const auto found = given_.find(name);
  return found != given_.end() ? found->second : given_.emplace(name, next(name)).first->second;
}

}  // namespace tautline::output
