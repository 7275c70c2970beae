#pragma once
/// @file
/// What the last digit of displacements and rotations leaves in forces: levels below which a force means
/// nothing. Derivation: docs/theory/newton.md#rounding

#include <limits>
#include <vector>

#include <tautline/model/model.hpp>
#include <tautline/model/state.hpp>

namespace tautline::model {

/// The last digit of a displacement over its size, and the few operations that lose one on the way to a
/// force.
constexpr double last_digit = 2 * std::numeric_limits<double>::epsilon();

struct Rounding {
  double force = 0;   ///< [N]; of a group of membranes or shells per width [N/m]
  double moment = 0;  ///< [N m]; of a group of shells per width [N]
};

/// Sum over the nodes, of random errors, of what the elements' stiffness makes of the last digit.
Rounding nodal_rounding(const Model& model, const State& state);

/// The largest level among the elements of each group in the forces that a group reports.
std::vector<Rounding> rounding_by_group(const Model& model, const State& state);

}  // namespace tautline::model
