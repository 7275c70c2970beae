#pragma once
/// @file
/// What follows from a shape: reactions, what is out of balance, and warnings.

#include <formfinding/net_system.hpp>
#include <string>
#include <vector>

namespace tautline::formfinding {

struct Balance {
  Points reaction;            ///< force that each node still needs [N]
  double out_of_balance = 0;  ///< largest force at a free node along the directions in equilibrium [N]
};

Balance balance(const NetSystem& system, const NetState& state);

/// Compression members and unstable directions, one sentence each. @pre factorised at the state
std::vector<std::string> stability_warnings(const NetSystem& system, const NetState& state);

}  // namespace tautline::formfinding
