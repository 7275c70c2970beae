#pragma once
/// @file
/// A net and the frame that yields under it, found together.

#include <functional>
#include <string>
#include <vector>

#include "steps/form_methods.hpp"

namespace tautline::steps {

/// Gives a shape of the net to the structure.
using HandOver = std::function<void(const Form&)>;

/// @brief Net and frame in equilibrium: the net between the places where the frame went, the frame under the
/// pull of that net, as a fixed point of these places, accelerated by Anderson's method.
///
/// A round that fails leaves the net of the last one that did not, status and reason apart.
/// @param[in] settled  groups whose state follows from form-finding
/// @param[in,out] net  its fixed nodes follow the frame
Form find_with_frame(Context& context, const FormFindingOptions& options,
                     const std::vector<std::string>& settled, FormNet& net, const HandOver& hand_over,
                     Json& entry);

}  // namespace tautline::steps
