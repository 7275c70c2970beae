#pragma once
/// @file
/// Pictures and tables of a bent rod and of the umbrella of all rods.

#include <tautline/rod/report.hpp>
#include <tautline/rod/shape.hpp>

#include "steps/context.hpp"

namespace tautline::steps {

/// Meridians before and after, deviation and moments along the rod, all rods in space.
void draw_rod(Context& context, const rod::RodShape& shape, const rod::RodReport& report);

/// DIR/<step>_nodes.csv:
/// node,x,y,theta,reaction,strain,stiffness,moment,moment_of_links,node_error,miss_x,miss_y for nodes 0 to m,
/// and DIR/<step>_rod.csv: s,x,y,theta,moment,deviation along the rod. Rank 0.
void write_rod_tables(Context& context, const rod::RodShape& shape, const rod::RodReport& report);

}  // namespace tautline::steps
