#include "output/detail/figures.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tautline::output::detail {

using Json = nlohmann::ordered_json;

const Json& member(const Json& object, const char* name) {
  static const Json nothing;
  if (!object.is_object()) return nothing;
  const auto found = object.find(name);
  return found == object.end() ? nothing : *found;
}

std::optional<double> number(const Json& value) {
  if (!value.is_number()) return std::nullopt;
  return value.get<double>();
}

std::string text(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  return value.is_null() || value.is_structured() ? "" : value.dump();
}

std::string show(std::optional<double> value, const char* unit, double scale, int digits) {
  if (!value || !std::isfinite(*value)) return "-";
  const double scaled = scale * *value, size = std::abs(scaled);
  std::string figure;
  if (scaled == std::round(scaled) && size < 1e7) {
    figure = fmt::format("{:.0f}", scaled);
  } else if (size >= 1e-3 && size < 1e7) {
    const int before = static_cast<int>(std::floor(std::log10(size))) + 1;
    figure = fmt::format("{:.{}f}", scaled, std::max(0, digits - before));
  } else {
    figure = fmt::format("{:.{}e}", scaled, digits - 2);
  }
  return *unit == '\0' ? figure : figure + " " + unit;
}

std::string show(const Json& value, const char* unit, double scale, int digits) {
  return show(number(value), unit, scale, digits);
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
