#pragma once

#include <string>

#include <tautline/output/pictures.hpp>

namespace tautline::output::render {

/// @throws std::runtime_error with the reason
void draw(const View& view, const std::string& png_path);
void draw(const Chart& chart, const std::string& png_path);

}  // namespace tautline::output::render
