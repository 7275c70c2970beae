#include "output/render/ticks.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace tautline::output::render {

namespace {

/// The smallest of 1, 2, 5 times a power of ten that is not below `step`.
double round_up(double step) {
  const double power = std::pow(10.0, std::floor(std::log10(step)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= step * (1 - 1e-9)) return factor * power;
  return 10 * power;
}

/// 1e-05 as 1e-5.
std::string short_power(std::string text) {
  const auto e = text.find('e');
  if (e == std::string::npos) return text;
  auto digits = e + 1;
  if (text[digits] == '+') text.erase(digits, 1);
  if (text[digits] == '-') ++digits;
  while (digits + 1 < text.size() && text[digits] == '0') text.erase(digits, 1);
  return text;
}

}  // namespace

Ticks linear_ticks(double low, double high, int wanted, bool whole) {
  double step = round_up((high - low) / std::max(wanted, 1));
  if (whole) step = std::max(1.0, step);
  const double largest = std::max(std::abs(low), std::abs(high));
  const bool power = largest >= 1e5 || largest < 1e-3;
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  const int digits = std::max(0, static_cast<int>(std::floor(std::log10(largest / step) + 1e-9)));
  Ticks ticks;
  for (double k = std::ceil(low / step - 1e-6); k * step <= high + 1e-6 * step; ++k) {
    const double value = k == 0 ? 0.0 : k * step;
    ticks.values.push_back(value);
    ticks.labels.push_back(value == 0 ? "0"
                           : power    ? short_power(fmt::format("{:.{}e}", value, digits))
                                      : fmt::format("{:.{}f}", value, decimals));
  }
  return ticks;
}

Ticks logarithmic_ticks(double low, double high) {
  Ticks ticks;
  const int first = static_cast<int>(std::floor(std::log10(low))),
            last = static_cast<int>(std::ceil(std::log10(high)));
  const int decades = last - first, stride = std::max(1, (decades + 7) / 8);
  const bool powers = low < 1e-3 || high > 1e6;  // all of them alike, but for those about one
  for (int exponent = first - (first % stride + stride) % stride; exponent <= last; exponent += stride) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double value = factor * std::pow(10.0, exponent);
      if ((factor > 1 && decades > 3) || value < low * (1 - 1e-9) || value > high * (1 + 1e-9)) continue;
      ticks.values.push_back(value);
      const bool plain = !powers || (value > 0.09 && value < 101);
      ticks.labels.push_back(plain ? fmt::format("{:.6g}", value)
                                   : short_power(fmt::format("{:.0e}", value)));
    }
  }
  return ticks;
}

}  // namespace tautline::output::render
