#pragma once
/// @file
/// What the renderer plugin offers to the program. Both are built by the same compiler from the same headers,
/// so the structs cross as they are; exceptions do not.

#include <string>

#include <tautline/output/pictures.hpp>

extern "C" {

/// Draws and returns true; or returns false with the reason in `error`.
bool tautline_draw_view(const tautline::output::View* view, const char* png_path, std::string* error);
bool tautline_draw_chart(const tautline::output::Chart* chart, const char* png_path, std::string* error);
}

namespace tautline::output::render {

constexpr auto plugin_file = "tautline_render.so";
/// Of whatever keeps pictures from being drawn.
constexpr auto remedy =
    "Build with TAUTLINE_WITH_RENDERER=ON and install the software renderer (apt-get install libegl1 "
    "libgl1-mesa-dri), or run with --no-pictures";

}  // namespace tautline::output::render
