#pragma once
/// @file
/// Colour maps.

#include <array>

#include <vtkLookupTable.h>
#include <vtkSmartPointer.h>

namespace tautline::output::render {

/// 256 colours over `range`: dark blue to yellow, evenly perceived; or blue, white, red. NaN is light grey.
vtkSmartPointer<vtkLookupTable> colour_table(bool diverging, const std::array<double, 2>& range);

/// Colours of the curves of a chart, distinct for the colour-blind too (Okabe and Ito).
std::array<unsigned char, 3> curve_colour(std::size_t index);

}  // namespace tautline::output::render
