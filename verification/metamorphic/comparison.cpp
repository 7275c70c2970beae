#include "comparison.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>

namespace tautline::metamorphic {

namespace {

const std::set<std::string> by_themselves{"Hz", "factor", "critical N", "surface m", "kg", "count"};

/// Factors are found from differences of tangents and printed to seven digits; critical points are searched
/// for to 1e-6 of the load.
double looser(const std::string& unit) {
  return unit == "factor" || unit == "critical N" ? 20 : 1;
}

std::string text(const Quantity& q) {
  return q.nature == Nature::scalar
             ? fmt::format("{:.10g}", q.value[0])
             : fmt::format("({:.10g}, {:.10g}, {:.10g})", q.value[0], q.value[1], q.value[2]);
}

}  // namespace

Scales::Scales(const Outcome& outcome) : size_(outcome.size), stiffness_(outcome.stiffness) {
  for (const auto& [key, q] : outcome.numbers) {
    auto& most = largest_[q.unit];
    most = std::max(most, q.value.norm());
  }
  auto& force = largest_["N"];
  force = std::max(force, 1e-8 * stiffness_);
  force = std::max(force, 0.1 * size_ * largest_["N/m"]);  // of a facet at its nodes, where it holds itself
  if (size_ == 0) size_ = largest_["length m"];            // of a reflector the longest cable
}

double Scales::of(const Quantity& a, const Quantity& b) const {
  const auto get = [&](const char* unit) {
    const auto found = largest_.find(unit);
    return found == largest_.end() ? 0.0 : found->second;
  };
  const double own = std::max(a.value.norm(), b.value.norm());
  if (by_themselves.count(a.unit) != 0) return own;
  if (a.unit == "m") return std::max(get("m"), 1e-3 * size_);
  if (a.unit == "length m") return size_;
  if (a.unit == "rad") return std::max(get("rad"), 1e-3);
  if (a.unit == "N m") return std::max(get("N m"), 1e-3 * size_ * get("N"));
  if (a.unit == "N m/m") return std::max(get("N m/m"), 1e-3 * get("N"));
  if (a.unit == "N/m") return std::max(get("N/m"), 1e-3 * get("N") / size_);
  return get(a.unit.c_str());
}

std::vector<Difference> compare(const Outcome& expected, const Outcome& found, double tolerance) {
  std::vector<Difference> list;
  const Scales scales(expected);
  for (const auto& [key, a] : expected.numbers) {
    const auto other = found.numbers.find(key);
    if (other == found.numbers.end()) {
      list.push_back({key + " is missing", std::numeric_limits<double>::infinity()});
      continue;
    }
    const Quantity& b = other->second;
    const double distance = (a.value - b.value).norm();
    if (distance == 0) continue;
    const double allowed = looser(a.unit) * tolerance * scales.of(a, b);
    list.push_back({fmt::format("{}: {} expected, {} found ({})", key, text(a), text(b), a.unit),
                    std::isfinite(distance) ? distance / allowed : std::numeric_limits<double>::infinity()});
  }
  for (const auto& [key, b] : found.numbers)
    if (expected.numbers.count(key) == 0)
      list.push_back({key + " is there in one alone", std::numeric_limits<double>::infinity()});
  std::stable_sort(list.begin(), list.end(),
                   [](const auto& a, const auto& b) { return a.measure > b.measure; });
  return list;
}

bool all_taut(const Outcome& outcome) {
  for (const auto& [key, q] : outcome.numbers)
    if (key.rfind("cable ", 0) == 0 && key.find(" tension") != std::string::npos && q.value[0] <= 0)
      return false;
  return true;
}

Difference difference(const std::string& what, double expected, double found, double allowed) {
  const double distance = std::abs(expected - found);
  return {fmt::format("{}: {:.10g} expected, {:.10g} found, {:.3g} allowed", what, expected, found, allowed),
          std::isfinite(distance) ? distance / allowed : std::numeric_limits<double>::infinity()};
}

}  // namespace tautline::metamorphic
