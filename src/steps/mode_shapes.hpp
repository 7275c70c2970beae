#pragma once
/// @file
/// Modes of vibration and of buckling as fields and pictures.

#include <string>

#include "steps/context.hpp"

namespace tautline::steps {

/// The mode's displacements, the largest of length 1, its largest component positive.
Points display_shape(const assembly::System& system, const la::Vector& mode);

/// A shape as a point field.
output::Field mode_field(const std::string& name, const Points& shape);

/// The structure moved along a mode by a twentieth of its size; light grey: as it is.
void draw_mode(Context& context, const Points& shape, const std::string& name, const std::string& title,
               const std::string& caption);

}  // namespace tautline::steps
