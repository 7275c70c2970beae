#pragma once
/// @file
/// The net in equilibrium whose weighted squares of what it misses are least: positions and force densities
/// are unknowns together, equilibrium is a constraint between them.

#include <formfinding/constraint.hpp>
#include <functional>

namespace tautline::formfinding {

struct CompromiseSettings {
  double tolerance = 0;  ///< of the largest scaled deviation, at which all is met
  int max_iterations = 200;
  double force = 1;        ///< by which forces are made dimensionless [N]
  std::vector<bool> held;  ///< branches that keep their force density; may be empty
  VecX lower, upper;       ///< bounds of the force densities, NaN: none; may be empty
};

struct CompromiseResult {
  bool in_balance = false;  ///< the start could be brought into equilibrium; nothing else is of use without
  bool met = false;
  bool optimum = false;  ///< no small change of shape and force densities in equilibrium lowers the squares
  NetState state;
  ConstraintRows rows;
  double squares = 0;  ///< sum of weight x scaled deviation^2
  int iterations = 0;
};

/// @brief Least weighted squares of the rows under equilibrium (Newton's method on the Lagrangian, damped as
/// by Levenberg and Marquardt; each step ends in equilibrium).
///
/// Unlike a search over the force densities alone it also knows shapes in which they leave a direction open,
/// D singular: a self-stressed net that stands on a plane edge.
/// @param[in] start  shape and force densities, which need not be in equilibrium; branches need a length
CompromiseResult find_compromise(const NetSystem& system,
                                 const std::function<ConstraintRows(const NetState&)>& make_rows,
                                 const NetState& start, const CompromiseSettings& settings);

}  // namespace tautline::formfinding
