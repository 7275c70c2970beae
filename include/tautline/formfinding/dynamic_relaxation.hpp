#pragma once
/// @file
/// Dynamic relaxation: equilibrium as the rest of a damped fictitious motion.
/// Source: Belov (2021), ch. 1.2.5, after Barnes (1999). Theory: docs/theory/dynamic_relaxation.md

#include <string>
#include <tautline/formfinding/dynamic_relaxation_options.hpp>
#include <tautline/formfinding/elastic_net.hpp>

namespace tautline::formfinding {

struct RelaxationResult {
  bool converged = false;
  std::string reason;         ///< one sentence with both sides of the inequality
  Points nodes;               ///< [m]
  VecX tension;               ///< of the branches [N]; slack: 0
  double out_of_balance = 0;  ///< largest force at a free node along the directions in equilibrium [N]
  Points stress;              ///< of each facet of the film, see FilmResult [N/m]
  int iterations = 0;         ///< time steps, those of the pilot run apart
  int pilot_iterations = 0;   ///< viscous: time steps of the run without damping
  double period = 0;          ///< viscous: of the slowest oscillation, as estimated last [time steps]
  int n_peaks = 0;            ///< kinetic: times the motion was stopped
};

/// @brief Rest of the net: elastic cables, constant tensions and films together; guides are respected.
///
/// At nodes of films that no cable meets the film's force counts along its normal only, see
/// find_minimal_film.
/// @throws ModelError if the net makes no sense
RelaxationResult relax(const ElasticNet& net, const DynamicRelaxationOptions& options = {});

}  // namespace tautline::formfinding
