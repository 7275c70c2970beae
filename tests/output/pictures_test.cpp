#include <tautline/output/pictures.hpp>

#include <cmath>

#include <gtest/gtest.h>

#include <tautline/core/error.hpp>
#include "output/temporary_directory.hpp"

namespace tautline::output {
namespace {

using test::contents;
using test::message_of;
using test::TemporaryDirectory;

struct PngSize {
  unsigned width = 0, height = 0;
};

/// From the header of a PNG; zero if it is none.
PngSize png_size(const std::string& bytes) {
  if (bytes.size() < 24 || bytes.compare(0, 8, "\x89PNG\r\n\x1a\n") != 0) return {};
  const auto number = [&](std::size_t at) {
    unsigned value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
  };
  return {number(16), number(20)};
}

View dish(int n) {
  ViewLayer surface;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const double x = 2.0 * i / n - 1, y = 2.0 * j / n - 1;
      surface.points.push_back({x, y, 0.3 * (x * x + y * y)});
      surface.point_scalars.push_back(std::sin(3 * x) * y);
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j, b = a + n + 1;
      surface.triangles.push_back({a, b, a + 1});
      surface.triangles.push_back({b, b + 1, a + 1});
    }
  ViewLayer net{surface.points, {}, {}, {}, {}};
  for (int i = 0; i < n; ++i) net.lines.push_back({i, i + 1});
  View view;
  view.title = "Deviation";
  view.subtitle = "RMS 1 mm";
  view.layers = {surface, net};
  view.scalar_title = "deviation [mm]";
  view.diverging = true;
  view.width = 500;
  view.height = 400;
  return view;
}

/// Draws; skips the test in a build without the renderer.
#define DRAW_OR_SKIP(picture, path)                                                       \
  do {                                                                                    \
    const auto error = message_of<LibraryError>([&] { draw(picture, path); });            \
    if (error.find("TAUTLINE_WITH_RENDERER") != std::string::npos) GTEST_SKIP() << error; \
    ASSERT_EQ(error, "");                                                                 \
  } while (false)

TEST(Pictures, ViewBecomesAPng) {
  const TemporaryDirectory directory("pictures_view");
  DRAW_OR_SKIP(dish(12), directory.file("view.png"));
  const auto bytes = contents(directory.file("view.png"));
  EXPECT_EQ(png_size(bytes).width, 500u);
  EXPECT_GE(png_size(bytes).height, 240u);
  EXPECT_LE(png_size(bytes).height, 400u);
  EXPECT_GT(bytes.size(), 15000u) << "an empty picture of this size takes less than 3 kB";
}

TEST(Pictures, SlenderDataGetANarrowPicture) {
  const TemporaryDirectory directory("pictures_slender");
  View view = dish(4);
  view.direction = Vec3(0, 0, 1);
  view.up = Vec3(0, 1, 0);
  view.width = 900;
  DRAW_OR_SKIP(view, directory.file("narrow.png"));
  const auto size = png_size(contents(directory.file("narrow.png")));
  EXPECT_EQ(size.width, 540u) << "not below six tenths of what was asked for";
  EXPECT_EQ(size.height, 400u);
}

TEST(Pictures, ChartBecomesAPng) {
  const TemporaryDirectory directory("pictures_chart");
  Chart chart;
  chart.title = "Residual";
  chart.x_label = "iteration";
  chart.y_label = "residual [N]";
  chart.log_y = true;
  chart.curves = {{"first", {0, 1, 2}, {1, 1e-3, 0}}, {"second", {0, 1, 2}, {2, NAN, 1e-7}}};
  chart.width = 400;
  chart.height = 300;
  DRAW_OR_SKIP(chart, directory.file("chart.png"));
  const auto bytes = contents(directory.file("chart.png"));
  EXPECT_EQ(png_size(bytes).width, 400u);
  EXPECT_EQ(png_size(bytes).height, 300u);
  EXPECT_GT(bytes.size(), 5000u);
}

TEST(Pictures, EmptyChartIsDrawnAndConstantFieldsToo) {
  const TemporaryDirectory directory("pictures_odd");
  DRAW_OR_SKIP(Chart{}, directory.file("empty.png"));
  View view = dish(2);
  view.layers[0].point_scalars.assign(view.layers[0].points.size(), 0.0);
  DRAW_OR_SKIP(view, directory.file("constant.png"));
}

TEST(Pictures, FailureNamesTheFileAndTheReason) {
  const TemporaryDirectory directory("pictures_fail");
  DRAW_OR_SKIP(dish(2), directory.file("view.png"));
  const auto unwritable = message_of<LibraryError>([&] { draw(dish(2), directory.file("none/view.png")); });
  EXPECT_NE(unwritable.find("none/view.png"), std::string::npos) << unwritable;
  const auto nothing = message_of<LibraryError>([&] { draw(View{}, directory.file("nothing.png")); });
  EXPECT_NE(nothing.find("nothing to draw"), std::string::npos) << nothing;
  View wrong = dish(2);
  wrong.layers[0].point_scalars.pop_back();
  EXPECT_NE(message_of<LibraryError>([&] { draw(wrong, directory.file("wrong.png")); }), "");
}

}  // namespace
}  // namespace tautline::output
