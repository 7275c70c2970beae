#pragma once
/// @file
/// What a change of an unstressed length does to the structure, to first order.

#include <vector>

#include <tautline/assembly/system.hpp>
#include <tautline/la/direct_solver.hpp>

namespace tautline::assembly {

/// @brief Displacements of `nodes` for a unit change of the unstressed length of each of `cables`.
///
/// One factorisation of the tangent in the present state, one right-hand side -df/dL0 for each cable, solved
/// in blocks.
/// @return shape (3 nodes, cables), row 3 i + c = component c of nodes[i] [m/m]; the same on every rank.
/// Collective.
/// @throws LibraryError if the tangent is singular
MatX length_influence(System& system, analysis::Workspace& workspace, const std::vector<int>& cables,
                      const std::vector<int>& nodes);

}  // namespace tautline::assembly
