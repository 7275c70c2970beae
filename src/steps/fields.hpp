#pragma once
/// @file
/// What a step leaves for ParaView.

#include <tautline/model/response.hpp>

#include "steps/context.hpp"

namespace tautline::steps {

/// Displacement, tension, slack flag, beam forces and axes, membrane stresses, surface deviation.
output::FieldGrid field_grid(Context& context, const model::Response& response);

}  // namespace tautline::steps
