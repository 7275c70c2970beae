#pragma once
/// @file
/// What is told of a path: its points, its critical points, its picture.

#include <string>
#include <vector>

#include "steps/context.hpp"

namespace tautline::steps {

/// A critical point as results report it. The system is moved there and back.
Json critical_point_json(assembly::System& system, const analysis::CriticalPoint& point,
                         const std::vector<std::string>& monitors);

/// Modes of the critical points that were met, as fields and pictures; the first is number `first` of the
/// step. The system is moved to each of them and back.
void draw_critical_points(Context& context, const analysis::PathSummary& path, std::size_t first = 1);

/// Load factor against the motion of what is watched, with the critical points.
void draw_path(Context& context, const Json& path, const Json& critical);

}  // namespace tautline::steps
