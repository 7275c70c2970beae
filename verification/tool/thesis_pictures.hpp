#pragma once
/// @file
/// Pictures of docs/thesis/: charts of numbers, and the structure coloured by what its tables say.

#include <string>

#include "data.hpp"
#include "thesis_items.hpp"

namespace verify {

/// @throws std::runtime_error if a number is not there or the picture cannot be drawn
void draw_chart(const ChartItem& chart, const Lookup& lookup, const std::string& png_path);
void draw_view(const ViewItem& view, Data& data, const std::string& png_path);

}  // namespace verify
