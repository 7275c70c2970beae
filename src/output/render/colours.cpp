#include "output/render/colours.hpp"

#include <algorithm>
#include <vector>

namespace tautline::output::render {

namespace {

using Rgb = std::array<double, 3>;

Rgb rgb(unsigned code) {
  return {((code >> 16) & 255) / 255.0, ((code >> 8) & 255) / 255.0, (code & 255) / 255.0};
}

/// After viridis; the yellow end is darkened so that thin lines stay visible on white.
const std::vector<unsigned> sequential{0x440154, 0x482878, 0x3e4989, 0x31688e, 0x26828e,
                                       0x1f9e89, 0x35b779, 0x6ece58, 0xb0d62f, 0xf2d31f};
/// After ColorBrewer's RdBu, reversed.
const std::vector<unsigned> blue_white_red{0x053061, 0x2166ac, 0x4393c3, 0x92c5de, 0xd1e5f0, 0xf7f7f7,
                                           0xfddbc7, 0xf4a582, 0xd6604d, 0xb2182b, 0x67001f};

Rgb interpolate(const std::vector<unsigned>& codes, double t) {
  const double position = t * static_cast<double>(codes.size() - 1);
  const auto left = std::min(static_cast<std::size_t>(position), codes.size() - 2);
  const double weight = position - static_cast<double>(left);
  const Rgb a = rgb(codes[left]), b = rgb(codes[left + 1]);
  Rgb result;
  for (std::size_t i = 0; i < 3; ++i) result[i] = (1 - weight) * a[i] + weight * b[i];
  return result;
}

}  // namespace

vtkSmartPointer<vtkLookupTable> colour_table(bool diverging, const std::array<double, 2>& range) {
  constexpr int n = 256;
  auto table = vtkSmartPointer<vtkLookupTable>::New();
  table->SetNumberOfTableValues(n);
  table->SetTableRange(range[0], range[1]);
  table->SetNanColor(0.8, 0.8, 0.8, 1.0);
  for (int i = 0; i < n; ++i) {
    const Rgb colour = interpolate(diverging ? blue_white_red : sequential, i / (n - 1.0));
    table->SetTableValue(i, colour[0], colour[1], colour[2], 1.0);
  }
  return table;
}

std::array<unsigned char, 3> curve_colour(std::size_t index) {
  static constexpr std::array<std::array<unsigned char, 3>, 7> colours{{{0, 90, 160},
                                                                        {213, 94, 0},
                                                                        {0, 140, 105},
                                                                        {170, 60, 130},
                                                                        {200, 140, 0},
                                                                        {70, 160, 220},
                                                                        {60, 60, 60}}};
  return colours[index % colours.size()];
}

}  // namespace tautline::output::render
