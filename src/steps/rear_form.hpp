#pragma once
/// @file
/// A rear net that is found by itself, under the pull of the ties.

#include "steps/form_methods.hpp"

namespace tautline::steps {

/// Whether the rear net is found by itself, and how.
RearForm rear_form(const Context& context, const FormFindingOptions& options);

/// Front net, ties and rear net in balance with each other.
struct CoupledForm {
  Form front;
  FormNet rear_net;
  Form rear;
  VecX tie_tension;  ///< of each cable of group `ties` [N]
  Json details;      ///< for results.json
};

/// @brief Finds the front net on its surface and the rear net in space, in turn, until the ties between them
/// have come to rest.
///
/// The ties' tensions follow from what the front nodes need along z; a tie whose ends are not above each
/// other also pulls its front node sideways, and its rear node along itself.
/// @throws ModelError for a tie that would be pressed, or nets that touch
CoupledForm find_coupled(const Context& context, const FormFindingOptions& options, FormNet& front);

/// Gives the rear net and the ties of the structure what was found.
void take_rear(Context& context, const CoupledForm& found);

}  // namespace tautline::steps
