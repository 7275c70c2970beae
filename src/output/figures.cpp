#include "output/detail/figures.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tautline::output::detail {

using Json = nlohmann::ordered_json;

namespace {

/// Below and above, figures are written with powers of ten.
constexpr double least_plain = 1e-3, most_plain = 1e7;

bool whole(double value) {
  return value == std::round(value) && std::abs(value) < most_plain;
}

/// Decimals that give `size` its significant digits, counted after rounding (9.9996 is 10.00).
int decimals(double size, int digits) {
  if (size == 0 || !std::isfinite(size)) return 0;
  const std::string rounded = fmt::format("{:.{}e}", size, digits - 1);
  return std::max(0, digits - 1 - std::stoi(rounded.substr(rounded.find('e') + 1)));
}

}  // namespace

const Json& member(const Json& object, const char* name) {
  static const Json nothing;
  if (!object.is_object()) return nothing;
  const auto found = object.find(name);
  return found == object.end() ? nothing : *found;
}

const Json& entry(const Json& list, std::size_t index) {
  static const Json nothing;
  return list.is_array() && index < list.size() ? list[index] : nothing;
}

Figure number(const Json& value) {
  if (!value.is_number()) return std::nullopt;
  return value.get<double>();
}

std::string text(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  return value.is_null() || value.is_structured() ? "" : value.dump();
}

std::string warning_text(const Json& warning) {
  return fmt::format("{}: {}", text(member(warning, "where")), text(member(warning, "message")));
}

std::string show(Figure value, const char* unit, double scale, int digits) {
  if (!value || !std::isfinite(*value)) return "-";
  const double scaled = scale * *value, size = std::abs(scaled);
  std::string figure;
  if (whole(scaled))
    figure = fmt::format("{:.0f}", scaled);
  else if (size >= least_plain && size < most_plain)
    figure = fmt::format("{:.{}f}", scaled, decimals(size, digits));
  else
    figure = fmt::format("{:.{}e}", scaled, digits - 2);
  return *unit == '\0' ? figure : figure + " " + unit;
}

std::string show(const Json& value, const char* unit, double scale, int digits) {
  return show(number(value), unit, scale, digits);
}

std::vector<std::string> show_column(const std::vector<Figure>& values, double scale, int digits) {
  double smallest = std::numeric_limits<double>::infinity(), largest = 0;
  bool all_whole = true;
  for (const auto& value : values) {
    if (!value || !std::isfinite(*value)) continue;
    const double size = std::abs(scale * *value);
    all_whole = all_whole && whole(scale * *value);
    largest = std::max(largest, size);
    if (size > 0) smallest = std::min(smallest, size);
  }
  const bool powers = largest < least_plain || largest >= most_plain || smallest < 1e-6 * largest;
  const int places = decimals(largest, digits);
  const int all_places = std::min(places + 1, std::max(places, decimals(smallest, digits)));
  std::vector<std::string> figures;
  for (const auto& value : values) {
    if (!value || !std::isfinite(*value) || *value == 0 || all_whole)
      figures.push_back(show(value, "", scale));
    else if (powers)
      figures.push_back(fmt::format("{:.{}e}", scale * *value, digits - 1));
    else
      figures.push_back(fmt::format("{:.{}f}", scale * *value, all_places));
  }
  return figures;
}

std::string counted(const Json& count, const std::string& one, const std::string& many) {
  return fmt::format("{} {}", show(count), number(count) == 1.0 ? one : many);
}

std::string words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::string capitalised(std::string name) {
  if (!name.empty()) name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  return name;
}

}  // namespace tautline::output::detail
