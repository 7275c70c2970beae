#pragma once
/// @file
/// What a change of cables does to the structure, to first order.

#include <vector>

#include <tautline/assembly/system.hpp>
#include <tautline/la/direct_solver.hpp>

namespace tautline::assembly {

enum class CableQuantity {
  unstressed_length,  ///< [m]
  axial_stiffness     ///< E A [N]
};

/// One parameter and what it changes.
struct CableParameter {
  struct Part {
    int cable = 0;
    double rate = 1;  ///< d quantity / d parameter
  };
  CableQuantity quantity = CableQuantity::unstressed_length;
  std::vector<Part> parts;
};

/// @brief Displacements of `nodes` for a unit change of each parameter.
///
/// One factorisation of the tangent in the present state, one right-hand side -df/dp for each parameter,
/// solved in blocks. Cables, bars and catenaries.
/// @return shape (3 nodes, parameters), row 3 i + c = component c of nodes[i]; the same on every rank.
/// Collective.
/// @throws LibraryError if the tangent is singular
MatX influence(System& system, analysis::Workspace& workspace, const std::vector<CableParameter>& parameters,
               const std::vector<int>& nodes);

/// Of the unstressed length of each of `cables` [m/m].
MatX length_influence(System& system, analysis::Workspace& workspace, const std::vector<int>& cables,
                      const std::vector<int>& nodes);

}  // namespace tautline::assembly
