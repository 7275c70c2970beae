#pragma once
/// @file
/// What a net that was found is worth, in the deck's names.

#include <string>
#include <tautline/formfinding/constraints.hpp>

#include "steps/form_methods.hpp"

namespace tautline::steps {

/// What of the largest tension found is no more than its rounding [N].
double rounding_of(const Form& found);

/// Which demands a net misses most: a sentence.
std::string reason_of_misses(const Context& context, const FormNet& form,
                             const formfinding::ConstrainedResult& found);
/// The same for results.json.
Json misses_json(const Context& context, const FormNet& form, const formfinding::ConstrainedResult& found);

/// A net in which a cable would have to push is none of this structure: the cable would go slack and the net
/// move.
void refuse_pushed_cables(const model::Model& structure, const FormNet& net, Form& found);

/// A net whose members' ends have run together is none: force densities that leave a mast no length, edges
/// too slack for a film.
void refuse_collapsed(const model::Model& structure, const FormNet& net, Form& found);

}  // namespace tautline::steps
