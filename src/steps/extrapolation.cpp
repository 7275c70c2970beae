#include "steps/extrapolation.hpp"

#include <cmath>
#include <cstddef>

#include <fmt/format.h>

namespace tautline::steps {

namespace {

constexpr double least_order = 0.5, most_order = 4.5;
constexpr double same_order = 1.0 / 3;  // by which orders of neighbouring meshes may differ
constexpr double rounding = 1e-10;      // of the values

/// Through the three points that end with the `last`.
Extrapolation fit(const std::vector<double>& size, const std::vector<double>& value, std::size_t last) {
  const double h1 = size[last], h2 = size[last - 1], h3 = size[last - 2];
  const double f1 = value[last], f2 = value[last - 1], f3 = value[last - 2];
  const auto none = [](std::string why) { return Extrapolation{0, 0, std::move(why)}; };
  if (!(h3 > h2 && h2 > h1 && h1 > 0)) return none("the meshes do not become finer from one to the next");
  if (!std::isfinite(f1 + f2 + f3)) return none("a value is missing");
  if (std::abs(f1 - f2) <= rounding * std::abs(f1))
    return none("the values no longer change beyond rounding");
  if ((f3 - f2) * (f2 - f1) <= 0) return none("the values go up and down from mesh to mesh");
  const double wanted = (f3 - f2) / (f2 - f1);
  const auto ratio = [&](double p) {
    return (std::pow(h3, p) - std::pow(h2, p)) / (std::pow(h2, p) - std::pow(h1, p));
  };
  if (wanted < ratio(least_order))
    return none(
        fmt::format("the values change too slowly for a limit: observed order below {:g}", least_order));
  if (wanted > ratio(most_order))
    return none(fmt::format("the observed order is above {:g}, which no mesh here has", most_order));
  double low = least_order, high = most_order;
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    (ratio(middle) < wanted ? low : high) = middle;
  }
  return {low, f1 + (f1 - f2) / (std::pow(h2 / h1, low) - 1), ""};
}

}  // namespace

Extrapolation extrapolate_three(const std::vector<double>& size, const std::vector<double>& value) {
  const std::size_t n = size.size();
  if (n < 3) return {0, 0, "three meshes are needed"};
  auto found = fit(size, value, n - 1);
  if (!found || n < 4) return found;
  const auto before = fit(size, value, n - 2);
  if (!before)
    found.why_not = "the three meshes before the finest: " + before.why_not;
  else if (std::abs(before.order - found.order) > same_order * found.order)
    found.why_not =
        fmt::format("the observed order still changes, from {:.2f} to {:.2f}", before.order, found.order);
  return found;
}

}  // namespace tautline::steps
