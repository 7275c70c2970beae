#pragma once
/// @file
/// What errors of the cut lengths of cables do to a net that was found.

#include "steps/form_net.hpp"

namespace tautline::steps {

/// @brief Standard deviations of tensions and the distribution of the net's rms deviation: along the normals
/// of the surface where the net has one, else along z.
///
/// All cables of the structure take part, nodes of other elements stay.
Json length_errors_json(const Context& context, const LengthErrorOptions& options, const FormNet& net);

}  // namespace tautline::steps
