#pragma once
/// @file
/// Every method of form-finding on the net of a deck, with one kind of answer.

#include "steps/form_net.hpp"

namespace tautline::steps {

struct Form {
  bool converged = false;
  bool compromise =
      false;  ///< not converged, but a net in equilibrium that misses what is asked as little as can be
  std::string reason;
  std::vector<std::string> warnings;
  Points nodes;            ///< of the net [m]; empty if there is no shape to show
  VecX tension;            ///< of each branch [N]
  VecX unstressed_length;  ///< of each branch [m]; empty: from the tension
  Points reaction;         ///< force that each net node still needs [N]
  VecX cloth_pull;         ///< of the cloth along each branch [N/m]; empty without
  Points film_stress;      ///< of each facet of the film [N/m], see FilmResult; empty: as given
  std::string residual_name = "largest tension error [N]";
  std::vector<double> residual;  ///< by iteration
  Json details;                  ///< of the method, for results.json
};

/// What branches leave at each node [N].
Points net_reactions(const FormNet& form, const Points& nodes, const VecX& tension);

/// @throws ModelError where the net or what is asked of it makes no sense
Form find_form(const Context& context, const FormFindingOptions& options, const FormNet& form);

}  // namespace tautline::steps
