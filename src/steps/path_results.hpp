#pragma once
/// @file
/// What is told of a path: its points, its critical points, its picture.

#include <string>
#include <vector>

#include "steps/context.hpp"

namespace tautline::steps {

/// Critical points as results report them, their modes as fields and pictures. The system is moved to each of
/// them and back.
Json critical_points_json(Context& context, const analysis::PathSummary& path,
                          const std::vector<std::string>& monitors);

/// Load factor against the motion of what is watched, with the critical points.
void draw_path(Context& context, const Json& path, const Json& critical);

}  // namespace tautline::steps
