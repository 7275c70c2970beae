#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <deck/scalars.hpp>
#include <string_view>

namespace tautline::deck {

namespace {

struct Unit {
  std::string_view name, base;
  double factor;
};

constexpr std::array<Unit, 22> units{{
    {"mm", "m", 1e-3},       {"cm", "m", 1e-2},         {"m", "m", 1},         {"km", "m", 1e3},
    {"mm^2", "m^2", 1e-6},   {"mm2", "m^2", 1e-6},      {"cm^2", "m^2", 1e-4}, {"m^2", "m^2", 1},
    {"N", "N", 1},           {"kN", "N", 1e3},          {"MN", "N", 1e6},      {"Pa", "Pa", 1},
    {"kPa", "Pa", 1e3},      {"MPa", "Pa", 1e6},        {"GPa", "Pa", 1e9},    {"Hz", "Hz", 1},
    {"kHz", "Hz", 1e3},      {"MHz", "Hz", 1e6},        {"GHz", "Hz", 1e9},    {"kN/m", "N/m", 1e3},
    {"kg/m^3", "kg/m^3", 1}, {"g/m^2", "kg/m^2", 1e-3},
}};

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())) != 0) text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.remove_suffix(1);
  return text;
}

/// The number at the beginning of `text`, and what follows it.
std::optional<double> leading_number(std::string_view text, std::string_view& rest) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const bool digit =
      !text.empty() && std::string_view("-.0123456789").find(text.front()) != std::string_view::npos;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (!digit || error != std::errc() || !std::isfinite(value)) return {};
  rest = text.substr(static_cast<std::size_t>(end - text.data()));
  return value;
}

std::string without_unit(double value, std::string_view suffix, const std::string& wanted) {
  for (const auto& unit : units)
    if (unit.name == suffix && unit.base == wanted) return "write " + format_number(value * unit.factor);
  return wanted == "-" ? std::string() : fmt::format("write the plain number in {}", wanted);
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (auto& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

bool is_not_finite(const std::string& text) {
  std::string word = lower(text);
  word.erase(0, word.find_first_not_of("+-."));
  return word == "nan" || word == "inf" || word == "infinity";
}

}  // namespace

std::string format_number(double value) {
  return fmt::format("{:.12g}", value);
}

Parsed<double> parse_number(const std::string& text, const std::string& unit) {
  if (is_not_finite(text)) return {{}, "is not a finite number", {}};
  std::string_view rest;
  const auto value = leading_number(trimmed(text), rest);
  if (!value) return {{}, "is not a number", {}};
  if (rest.empty()) return {value, {}, {}};
  if (rest.front() == ',' && rest.find_first_not_of("0123456789", 1) == std::string_view::npos) {
    std::string repaired(trimmed(text));
    std::replace(repaired.begin(), repaired.end(), ',', '.');
    return {{}, "has a decimal comma", fmt::format("write {}", repaired)};
  }
  rest = trimmed(rest);
  if (std::isalpha(static_cast<unsigned char>(rest.front())) != 0 && rest.find(' ') == std::string_view::npos)
    return {{},
            fmt::format("carries a unit (\"{}\"); deck values are plain SI numbers", rest),
            without_unit(*value, rest, unit)};
  return {{}, "is not a number", {}};
}

Parsed<int> parse_integer(const std::string& text) {
  std::string_view digits = trimmed(text);
  if (!digits.empty() && digits.front() == '+') digits.remove_prefix(1);
  int value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool complete = end == digits.data() + digits.size() && !digits.empty();
  if (complete && error == std::errc::result_out_of_range) return {{}, "is too large", {}};
  const auto number = parse_number(text, "-");
  if (error != std::errc() || !complete) {
    if (!number.value)
      return {{}, number.fault == "is not a number" ? "is not a whole number" : number.fault, number.remedy};
    return {{}, "is not a whole number", {}};
  }
  const std::size_t sign = digits.front() == '-' ? 1 : 0;
  if (digits.size() > sign + 1 && digits[sign] == '0')
    return {{}, "begins with a zero, which other programs read as octal", fmt::format("write {}", value)};
  return {value, {}, {}};
}

Parsed<bool> parse_boolean(const std::string& text) {
  if (text == "true") return {true, {}, {}};
  if (text == "false") return {false, {}, {}};
  const std::string word = lower(text);
  for (const char* yes : {"true", "yes", "on", "y", "1"})
    if (word == yes) return {{}, "is neither true nor false", "write true"};
  for (const char* no : {"false", "no", "off", "n", "0"})
    if (word == no) return {{}, "is neither true nor false", "write false"};
  return {{}, "is neither true nor false", {}};
}

}  // namespace tautline::deck
