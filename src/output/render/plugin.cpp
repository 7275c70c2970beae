#include "output/render/plugin.hpp"

#include <exception>

#include "output/render/draw.hpp"

namespace {

template <typename Picture>
bool guarded(const Picture* picture, const char* png_path, std::string* error) {
  try {
    tautline::output::render::draw(*picture, png_path);
    return true;
  } catch (const std::exception& failure) {
    *error = failure.what();
  } catch (...) {
    *error = "unknown failure in the renderer";
  }
  return false;
}

}  // namespace

extern "C" {

__attribute__((visibility("default"))) bool tautline_draw_view(const tautline::output::View* view,
                                                               const char* png_path, std::string* error) {
  return guarded(view, png_path, error);
}

__attribute__((visibility("default"))) bool tautline_draw_chart(const tautline::output::Chart* chart,
                                                                const char* png_path, std::string* error) {
  return guarded(chart, png_path, error);
}
}
