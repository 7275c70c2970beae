#include <tautline/output/results.hpp>

#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <tautline/core/error.hpp>
#include "output/detail/files.hpp"

namespace tautline::output {

namespace {

using Json = nlohmann::ordered_json;

bool is_flat(const Json& array) {
  for (const auto& entry : array)
    if (entry.is_structured()) return false;
  return true;
}

std::string scalar_text(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// As Json::dump, but lists of numbers stay on one line, so that a person can read the file.
void append(std::string& text, const Json& value, int depth) {
  if (value.is_number_float()) {
    text += std::isfinite(value.get<double>()) ? value.dump() : "null";
    return;
  }
  if (!value.is_structured() || value.empty()) {
    text += scalar_text(value);
    return;
  }
  const bool one_line = value.is_array() && is_flat(value);
  const auto break_line = [&](int level) {
    if (!one_line) text.append(1, '\n').append(2 * static_cast<std::size_t>(level), ' ');
  };
  text += value.is_array() ? '[' : '{';
  bool first = true;
  for (const auto& item : value.items()) {
    if (!first) text += one_line ? ", " : ",";
    first = false;
    break_line(depth + 1);
    if (value.is_object()) text.append(scalar_text(Json(item.key()))).append(": ");
    append(text, item.value(), depth + 1);
  }
  break_line(depth);
  text += value.is_array() ? ']' : '}';
}

}  // namespace

void write_results(const std::string& path, const Json& results) {
  std::string text;
  append(text, results, 0);
  detail::write_file(path, text + "\n");
}

Json read_results(const std::string& path) {
  const std::string text = detail::read_file(path);
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    throw LibraryError(fmt::format("cannot read {}: not valid JSON at byte {}", path, error.byte));
  }
}

void write_text(const std::string& path, const std::string& text) {
  detail::write_file(path, text);
}

void write_durably(const std::string& path, std::string_view bytes) {
  detail::write_file(path, bytes, true);
}

void prepare_directory(const std::string& directory) {
  std::error_code error;
  if (std::filesystem::exists(directory, error) && !std::filesystem::is_directory(directory, error))
    throw LibraryError(fmt::format("cannot write results to {}: it is a file, not a directory", directory));
  error.clear();
  std::filesystem::create_directories(directory, error);
  if (error)
    throw LibraryError(fmt::format("cannot create the directory {}: {}", directory, error.message()));
  const std::string probe = fmt::format("{}/.tautline_probe_{}", directory, getpid());
  try {
    detail::write_file(probe, std::string(4096, ' '));
  } catch (const LibraryError& failure) {
    throw LibraryError(
        fmt::format("cannot write results to the directory {}\n  {}", directory, failure.what()));
  }
  std::filesystem::remove(probe, error);
}

}  // namespace tautline::output
