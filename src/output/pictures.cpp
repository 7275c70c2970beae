#include <dlfcn.h>
#include <fmt/format.h>

#include <tautline/core/error.hpp>
#include <tautline/core/plugin.hpp>
#include "output/render/plugin.hpp"

namespace tautline::output {

namespace {

template <typename Function>
Function load(const char* symbol) {
  return reinterpret_cast<Function>(load_plugin_symbol(render::plugin_file, symbol, render::remedy));
}

template <typename Function, typename Picture>
void draw_with(Function function, const Picture& picture, const std::string& png_path) {
  std::string error;
  if (!function(&picture, png_path.c_str(), &error))
    throw LibraryError(fmt::format("cannot draw {}: {}", png_path, error));
}

}  // namespace

void draw(const View& view, const std::string& png_path) {
  static const auto function = load<decltype(&tautline_draw_view)>("tautline_draw_view");
  draw_with(function, view, png_path);
}

void draw(const Chart& chart, const std::string& png_path) {
  static const auto function = load<decltype(&tautline_draw_chart)>("tautline_draw_chart");
  draw_with(function, chart, png_path);
}

}  // namespace tautline::output
