#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tautline/core/error.hpp>
#include <tautline/formfinding/net.hpp>
#include <utility>

namespace tautline::formfinding {

namespace {

void check_grid(const std::vector<double>& grid, Eigen::Index heights, char name) {
  if (grid.size() < 2)
    throw ModelError(
        fmt::format("the table of heights has {} grid line(s) in {}, needs two", grid.size(), name));
  if (static_cast<Eigen::Index>(grid.size()) != heights)
    throw ModelError(
        fmt::format("the table has {} grid lines in {}, but heights for {}", grid.size(), name, heights));
  for (std::size_t i = 1; i < grid.size(); ++i)
    if (!(grid[i] > grid[i - 1]))
      throw ModelError(fmt::format("the grid lines of the table in {} must increase: {} m follows {} m", name,
                                   grid[i], grid[i - 1]));
}

/// Weights of the grid values in the interpolated value and in its derivative.
struct Weights {
  int first = 0;  ///< grid line of the first weight
  std::array<double, 4> value{}, slope{};
  int count = 0;
};

/// Derivative, at grid point `at`, of the parabola through the grid points first .. first + 2 (or the chord
/// if there are only two), as weights.
std::array<double, 3> slope_weights(const std::vector<double>& grid, int first, int at) {
  if (grid.size() == 2) return {-1 / (grid[1] - grid[0]), 1 / (grid[1] - grid[0]), 0};
  std::array<double, 3> weight{};
  for (int i = 0; i < 3; ++i) {
    const double xi = grid[first + i], xj = grid[first + (i + 1) % 3], xk = grid[first + (i + 2) % 3];
    weight[i] = (2 * grid[at] - xj - xk) / ((xi - xj) * (xi - xk));
  }
  return weight;
}

Weights hermite(const std::vector<double>& grid, double x, char name) {
  if (!(x >= grid.front() && x <= grid.back()))
    throw ModelError(
        fmt::format("{} = {:.6g} m is outside the table of heights, which reaches from {:.6g} to {:.6g} m",
                    name, x, grid.front(), grid.back()));
  const int n = static_cast<int>(grid.size());
  const int cell = std::clamp(
      static_cast<int>(std::upper_bound(grid.begin(), grid.end(), x) - grid.begin()) - 1, 0, n - 2);
  const double h = grid[cell + 1] - grid[cell], t = (x - grid[cell]) / h;
  Weights weights;
  weights.first = std::clamp(cell - 1, 0, std::max(0, n - 4));
  weights.count = std::min(4, n);
  const auto add = [&](int line, double value, double slope) {
    weights.value[line - weights.first] += value;
    weights.slope[line - weights.first] += slope;
  };
  add(cell, (1 + 2 * t) * (1 - t) * (1 - t), -6 * t * (1 - t) / h);
  add(cell + 1, t * t * (3 - 2 * t), 6 * t * (1 - t) / h);
  const std::array<double, 2> tangent{h * t * (1 - t) * (1 - t), h * t * t * (t - 1)};
  const std::array<double, 2> tangent_slope{(1 - t) * (1 - 3 * t), t * (3 * t - 2)};
  for (int end = 0; end < 2; ++end) {
    const int first = std::clamp(cell + end - 1, 0, std::max(0, n - 3));
    const auto weight = slope_weights(grid, first, cell + end);
    for (int i = 0; i < std::min(3, n); ++i)
      add(first + i, tangent[end] * weight[i], tangent_slope[end] * weight[i]);
  }
  return weights;
}

}  // namespace

TableSurface::TableSurface(std::vector<double> x, std::vector<double> y, MatX height)
    : x_(std::move(x)), y_(std::move(y)), height_(std::move(height)) {
  check_grid(x_, height_.rows(), 'x');
  check_grid(y_, height_.cols(), 'y');
}

Vec3 TableSurface::height_and_slope(double x, double y) const {
  const Weights along_x = hermite(x_, x, 'x'), along_y = hermite(y_, y, 'y');
  Vec3 result = Vec3::Zero();
  for (int i = 0; i < along_x.count; ++i) {
    for (int j = 0; j < along_y.count; ++j) {
      const double z = height_(along_x.first + i, along_y.first + j);
      result += z * Vec3(along_x.value[i] * along_y.value[j], along_x.slope[i] * along_y.value[j],
                         along_x.value[i] * along_y.slope[j]);
    }
  }
  return result;
}

}  // namespace tautline::formfinding
