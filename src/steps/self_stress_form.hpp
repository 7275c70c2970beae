#pragma once
/// @file
/// form_finding with `method: self_stress`: the net stays where it is drawn. Theory:
/// docs/theory/self_stress.md

#include "steps/form_methods.hpp"

namespace tautline::steps {

/// @throws ModelError if there is no state of self-stress with the right signs
Form find_self_stressed(const Context& context, const FormFindingOptions& options, const FormNet& form);

}  // namespace tautline::steps
