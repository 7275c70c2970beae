#pragma once
/// @file
/// Lists and groups of results.json as tables of text; a table nobody has figures for has no rows, and its
/// columns are those that somebody has.

#include <vector>

#include "output/detail/figures.hpp"
#include "output/detail/story.hpp"

namespace tautline::output::detail {

/// Cables, beams and membranes by group, those of them that there are.
std::vector<Table> group_tables(const nlohmann::ordered_json& groups);

Table pass_table(const nlohmann::ordered_json& passes);
Table stage_table(const nlohmann::ordered_json& stages);
Table convergence_table(const nlohmann::ordered_json& step);
/// @param mass of the structure [kg], to give effective masses as shares of it; 0: unknown
Table mode_table(const nlohmann::ordered_json& step, double mass);
Table buckling_table(const nlohmann::ordered_json& step);
/// The nodes of a bent rod with their cables.
Table rod_table(const nlohmann::ordered_json& step);
/// The same of an umbrella solved in space, the mean over its rods.
Table space_rods_table(const nlohmann::ordered_json& rods);
/// What an inverse found; empty where there are too many to be read, which are in its cables.csv.
Table unknown_table(const nlohmann::ordered_json& unknowns);
Table target_table(const nlohmann::ordered_json& targets);
Table path_table(const nlohmann::ordered_json& path);

}  // namespace tautline::output::detail
