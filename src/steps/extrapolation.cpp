#include "steps/extrapolation.hpp"

#include <cmath>

namespace tautline::steps {

std::optional<Extrapolation> extrapolate_three(const std::vector<double>& size,
                                               const std::vector<double>& value) {
  const std::size_t n = size.size();
  if (n < 3) return std::nullopt;
  const double h1 = size[n - 1], h2 = size[n - 2], h3 = size[n - 3];
  const double f1 = value[n - 1], f2 = value[n - 2], f3 = value[n - 3];
  const double wanted = (f3 - f2) / (f2 - f1);
  const auto ratio = [&](double p) {
    return (std::pow(h3, p) - std::pow(h2, p)) / (std::pow(h2, p) - std::pow(h1, p));
  };
  double low = 0.05, high = 10;
  if (!std::isfinite(wanted) || wanted <= ratio(low) || wanted >= ratio(high)) return std::nullopt;
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    (ratio(middle) < wanted ? low : high) = middle;
  }
  return Extrapolation{low, f1 + (f1 - f2) / (std::pow(h2 / h1, low) - 1)};
}

}  // namespace tautline::steps
