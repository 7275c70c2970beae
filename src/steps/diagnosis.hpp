#pragma once
/// @file
/// What happened to the structure in a step that failed, told before what the solver did, and one remedy.

#include <string>
#include <vector>

#include <tautline/model/response.hpp>
#include <tautline/model/state.hpp>

#include "steps/context.hpp"

namespace tautline::steps {

/// Where a step began.
struct Beginning {
  model::State state;
  model::Response response;

  static Beginning of(const assembly::System& system);
};

/// How a stage ended that did not come to its end, or not to a stable one.
struct Ending {
  double lambda = 0;          ///< load factor of the last equilibrium
  bool found = false;         ///< whether the step found any equilibrium
  bool bifurcated = false;    ///< the path has passed a bifurcation
  bool unstable = false;      ///< its end was reached and is unstable
  int worst_node = -1;        ///< where the force out of balance at the start is largest
  double out_of_balance = 0;  ///< there [N]
};

struct Diagnosis {
  std::vector<std::string> findings;  ///< the first tells most
  std::string remedy;

  std::string text() const;  ///< all of it in a row
  Json json() const;
};

/// @brief Compares the present state of the system with the beginning: prestress lost, members past their
/// Euler load, strains, the node that moved most, the load factor.
Diagnosis diagnose(Context& context, const Beginning& beginning, const Ending& ending);

}  // namespace tautline::steps
