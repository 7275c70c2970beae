#include <tautline/rod/meridian.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/core/expression.hpp>

namespace tautline::rod {

namespace {

/// Gauss-Legendre rule of five points on [a, b].
template <class F>
double gauss(const F& f, double a, double b) {
  static constexpr double x[] = {0.538469310105683091, 0.906179845938663993},
                          w[] = {0.568888888888888889, 0.478628670499366468, 0.236926885056189088};
  const double middle = (a + b) / 2, half = (b - a) / 2;
  double sum = w[0] * f(middle);
  for (int i = 0; i < 2; ++i) sum += w[i + 1] * (f(middle - half * x[i]) + f(middle + half * x[i]));
  return half * sum;
}

/// Halves [a, b] until the rule agrees with itself to 1e-13 of its value.
template <class F>
double integrate(const F& f, double a, double b, int depth = 0) {
  const double middle = (a + b) / 2, whole = gauss(f, a, b),
               halves = gauss(f, a, middle) + gauss(f, middle, b);
  if (!(std::abs(whole - halves) > 1e-13 * std::abs(halves)) || depth == 20) return halves;
  return integrate(f, a, middle, depth + 1) + integrate(f, middle, b, depth + 1);
}

double sign(double value) {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

/// Slope at point i of the polynomial through the five points nearest to it, by barycentric weights (Berrut &
/// Trefethen 2004).
double slope_of_neighbours(const std::vector<double>& x, const std::vector<double>& y, int i) {
  const int n = static_cast<int>(x.size()), count = std::min(n, 5);
  const int first = std::clamp(i - 2, 0, n - count), end = first + count;
  const auto product = [&](int j) {
    double differences = 1;
    for (int k = first; k < end; ++k)
      if (k != j) differences *= x[j] - x[k];
    return differences;
  };
  double slope = 0;
  for (int j = first; j < end; ++j)
    if (j != i) slope += product(i) / product(j) * (y[j] - y[i]) / (x[i] - x[j]);
  return slope;
}

/// Slopes at the points, of fourth order where the data allow, limited to three times the lesser neighbouring
/// secant and to zero at extrema, so that the cubics are monotone between points (Hyman 1983).
std::vector<double> monotone_slopes(const std::vector<double>& x, const std::vector<double>& y) {
  const int n = static_cast<int>(x.size());
  const auto secant = [&](int i) { return (y[i + 1] - y[i]) / (x[i + 1] - x[i]); };
  std::vector<double> slopes(n);
  for (int i = 0; i < n; ++i) {
    const double left = secant(std::max(i - 1, 0)), right = secant(std::min(i, n - 2));
    const double slope = slope_of_neighbours(x, y, i);
    const bool is_extreme = sign(left) != sign(right) || sign(slope) != sign(left);
    const double most = 3 * std::min(std::abs(left), std::abs(right));
    slopes[i] = is_extreme ? 0 : std::clamp(slope, -most, most);
  }
  return slopes;
}

/// Cubic Hermite pieces, straight lines outside.
struct Table {
  std::vector<double> x, y, slope;

  Jet at(double at) const {
    if (at < x.front()) return {y.front() + slope.front() * (at - x.front()), slope.front(), 0};
    if (at > x.back()) return {y.back() + slope.back() * (at - x.back()), slope.back(), 0};
    const auto above = std::upper_bound(x.begin() + 1, x.end() - 1, at);
    const std::size_t i = above - x.begin() - 1;
    const double h = x[i + 1] - x[i], t = at - x[i], secant = (y[i + 1] - y[i]) / h;
    const double c2 = (3 * secant - 2 * slope[i] - slope[i + 1]) / h;
    const double c3 = (slope[i] + slope[i + 1] - 2 * secant) / (h * h);
    return {y[i] + t * (slope[i] + t * (c2 + t * c3)), slope[i] + t * (2 * c2 + t * 3 * c3),
            2 * c2 + 6 * c3 * t};
  }
};

}  // namespace

Meridian::Meridian(Function f, std::vector<double> breaks) : f_(std::move(f)), breaks_(std::move(breaks)) {}

Meridian Meridian::parabola(double coefficient) {
  return Meridian([coefficient](double x) {
    return Jet{coefficient * x * x, 2 * coefficient * x, 2 * coefficient};
  });
}

Meridian Meridian::expression(const std::string& text) {
  try {
    return Meridian([f = Expression(text)](double x) {
      const Jet2 y = f(x);
      return Jet{y.value, y.first, y.second};
    });
  } catch (const std::invalid_argument& error) {
    throw ModelError(fmt::format("the meridian \"{}\" is no formula: {}", text, error.what()));
  }
}

Meridian Meridian::table(std::vector<double> x, std::vector<double> y) {
  if (x.size() < 2 || x.size() != y.size())
    throw ModelError(fmt::format("the meridian's table has {} x and {} y; it needs two or more points",
                                 x.size(), y.size()));
  for (std::size_t i = 0; i + 1 < x.size(); ++i)
    if (!(x[i] < x[i + 1]))
      throw ModelError(
          fmt::format("the meridian's table must rise in x, but {} is followed by {}", x[i], x[i + 1]));
  auto slopes = monotone_slopes(x, y);
  Table pieces{x, std::move(y), std::move(slopes)};
  return Meridian([pieces = std::move(pieces)](double at) { return pieces.at(at); }, std::move(x));
}

Meridian Meridian::make(const MeridianOptions& options) {
  if (options.kind == MeridianKind::table) return table(options.x, options.y);
  if (options.kind == MeridianKind::expression) return expression(options.expression);
  return parabola(options.coefficient);
}

double Meridian::angle(double x) const {
  return std::atan(at(x).slope);
}

double Meridian::arc_length(double x1, double x2) const {
  if (x2 < x1) return -arc_length(x2, x1);
  const auto speed = [&](double x) { return std::hypot(1.0, at(x).slope); };
  double length = 0, from = x1;
  for (const double corner : breaks_) {
    if (corner <= from || corner >= x2) continue;
    length += integrate(speed, from, corner);
    from = corner;
  }
  return length + integrate(speed, from, x2);
}

double Meridian::advance(double x1, double length) const {
  double x = x1 + length / std::hypot(1.0, at(x1).slope);
  for (int i = 0; i < 50; ++i) {
    const double step = (length - arc_length(x1, x)) / std::hypot(1.0, at(x).slope);
    x += step;
    if (std::abs(step) <= 1e-14 * (std::abs(x) + std::abs(length))) break;
  }
  return x;
}

double Meridian::foot(double x, double y) const {
  double foot = x;
  for (int i = 0; i < 50; ++i) {
    const Jet f = at(foot);
    const double along = (x - foot) + (y - f.value) * f.slope;
    const double slope = 1 + f.slope * f.slope - (y - f.value) * f.curvature;
    const double step = along / std::max(slope, 0.5);
    foot += step;
    if (std::abs(step) <= 1e-14 * (1 + std::abs(foot))) break;
  }
  return foot;
}

double Meridian::distance(double x, double y) const {
  const double at_foot = foot(x, y);
  const Jet f = at(at_foot);
  return std::copysign(std::hypot(x - at_foot, y - f.value), y - at(x).value);
}

}  // namespace tautline::rod
